"""The directional albedo of facets: as the kernel steps, and against finer quadratures."""

from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.glsl import expanded
from glrt.gpu.structs import read_constants
from glrt.scene.materials import facets
from glrt.scene.materials.gloss import ROUGHNESS_STEPS, facet_shares, shares_by_step


def test_host_and_kernel_step_alike() -> None:
    assert read_constants(expanded("bsdfs/albedos.glsl"))["ALBEDO_STEPS"] == facets.STEPS


@pytest.mark.slow
@pytest.mark.slow_cases("0.01-1.5", "1.0-1.5", "0.36-2.4")
@pytest.mark.parametrize(("alpha", "ior"), [(0.01, 1.5), (0.09, 1.1), (0.36, 2.4), (1.0, 1.5)])
def test_albedos_are_those_of_a_finer_quadrature(
    monkeypatch: pytest.MonkeyPatch, alpha: float, ior: float
) -> None:
    """This holds at the steps and between them, where the kernel takes albedos to be linear."""
    found = facets.facet_loss(alpha, ior)
    assert found
    monkeypatch.setattr(facets, "STEPS", 2 * facets.STEPS)
    finer = partial(facets.visible_normals, lattice=(28657, 17711))
    monkeypatch.setattr(facets, "visible_normals", finer)
    for albedo, eta in zip(found.albedos, (1 / ior, ior), strict=True):
        fine = facets._albedo(alpha, eta)
        assert np.abs(fine[::2] - albedo).max() < 2e-3
        assert np.abs(fine[1::2] - (albedo[1:] + albedo[:-1]) / 2).max() < 3e-3


def test_smooth_glass_loses_nothing_worth_restoring() -> None:
    assert facets.facet_loss(1e-6, 1.5) is None


@pytest.mark.slow
def test_facets_between_tabled_roughnesses_are_near_their_integrals() -> None:
    """Textured roughness, where the table is off most: 0.00082 at step 76, of all 256."""
    table = shares_by_step()
    for step in (34, 38, 62, 76, 84, 250):
        exact = facet_shares((step / ROUGHNESS_STEPS) ** 2)
        assert_allclose(table["head_on"][step], exact.head_on, atol=1e-3)
        assert_allclose(table["grazing"][step], exact.grazing, atol=1e-3)


@pytest.mark.parametrize("ior", [1.2, 1.5, 2.4])
def test_light_that_a_rough_pane_loses_divides_as_even_light_does(ior: float) -> None:
    """The share of even light that a smooth pane lets through, by Gauss and Legendre."""
    nodes, weights = np.polynomial.legendre.leggauss(64)
    cosine = (nodes + 1) / 2
    bent = np.sqrt(1 - (1 - cosine**2) / ior**2)
    across = ((cosine - ior * bent) / (cosine + ior * bent)) ** 2
    along = ((bent - ior * cosine) / (bent + ior * cosine)) ** 2
    face = (across + along) / 2
    through = weights @ (cosine * (1 - 2 * face / (1 + face)))
    loss = facets.pane_loss(0.5, ior)
    assert loss is not None
    assert loss.crossing == pytest.approx((through, through), abs=1e-5)
    assert loss.albedos[0] is loss.albedos[1]
