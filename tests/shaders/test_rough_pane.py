"""Rough panes: against float64, quadratures, and themselves."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.plan.plan import prepare
from glrt.settings import Settings
from tests.conftest import CallGlsl
from tests.shaders.test_dielectric import fresnel64
from tests.shaders.test_material import ggx_d64, ggx_lambda
from tests.shaders.test_rough_dielectric import (
    BOTH_WAYS,
    SETUP,
    assert_weights,
    directions,
    rough,
)
from tests.shaders.test_sampling import GRIDS
from tests.support.chi_square import assert_density
from tests.support.numerics import float32, lattice, wo_at

PANES = [(0.3, 1.5), (0.8, 1.5), (1.0, 2.4)]  # roughness, ior
COSINES = (0.95, 0.4)
CASES = [(*one, cosine) for one in [(0.5, 1.5), *PANES[1:]] for cosine in COSINES]
ABOVE = {"outside": np.array([1])}


def pane(roughness: float, ior: float) -> dict[str, Any]:
    """A scene of one bubble that is a rough pane, as inputs of call_glsl."""
    return {**ABOVE, **rough(roughness, ior, thin=True)}


@pytest.mark.parametrize(("roughness", "ior"), PANES)
def test_facets_are_panes_and_mirror_what_they_let_through(
    call_glsl: CallGlsl, roughness: float, ior: float
) -> None:
    """D G2 / (4 cos) times 2 F / (1 + F) above, and times the rest below, in float64."""
    wo, wi = directions(20_000, 1), directions(20_000, 2)
    wo[:, 2] = np.abs(wo[:, 2])
    setup = SETUP + "Lobe lobe = facet_lobe(vertex, glass_half(vertex, wi), wi);"
    found = call_glsl("lobe.value", setup=setup, wo=wo, wi=wi, **pane(roughness, ior))
    o, i = float32(wo), float32(wi)
    crosses = i[:, 2] < 0
    i[:, 2] = np.abs(i[:, 2])
    h = (o + i) / np.linalg.norm(o + i, axis=1, keepdims=True)
    face = fresnel64(np.sum(o * h, axis=1), 1 / ior)
    reflected = 2 * face / (1 + face)
    alpha = np.array(roughness**2)
    masked = ggx_d64(alpha, h) / (1 + ggx_lambda(alpha, o) + ggx_lambda(alpha, i))
    exact = np.where(crosses, 1 - reflected, reflected) * masked / (4 * o[:, 2])
    assert_allclose(found, exact, rtol=2e-3, atol=3e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("roughness", "ior"), PANES)
def test_light_goes_both_ways_through_a_rough_pane(
    call_glsl: CallGlsl, roughness: float, ior: float
) -> None:
    """f(wo, wi) cos wi cos wo is alike when both change places, whichever sides they are on."""
    wo, wi = directions(20_000, 3), directions(20_000, 4)
    given = rough(roughness, ior, thin=True)
    a, b = call_glsl("vec2(a, b)", "vec2", setup=BOTH_WAYS, wo=wo, wi=wi, **given).T
    assert np.count_nonzero(a) > 15_000
    assert_allclose(a, b, rtol=2e-3, atol=1e-7)


@pytest.mark.parametrize(("roughness", "ior"), PANES)
def test_a_rough_pane_neither_loses_nor_gains_light(
    call_glsl: CallGlsl, roughness: float, ior: float
) -> None:
    """The furnace: the mean weight of samples is 1 to half a percent, at every angle."""
    u = lattice()
    setup = SETUP + "Scattering next = sample_rough_dielectric(vertex, u.x, u.yz);"
    for cosine in (1.0, 0.8, 0.5, 0.3, 0.1, 0.02):
        wo = np.repeat(wo_at(cosine), len(u), axis=0)
        weight = call_glsl("next.weight.x", setup=setup, u=u, wo=wo, **pane(roughness, ior))
        assert weight.astype(np.float64).mean() == pytest.approx(1, abs=0.005)


@pytest.mark.slow
@pytest.mark.parametrize(("roughness", "ior"), PANES)
def test_the_weight_of_a_sample_of_a_pane_is_its_value_over_its_density(
    call_glsl: CallGlsl, roughness: float, ior: float
) -> None:
    assert_weights(call_glsl, **pane(roughness, ior))


@pytest.mark.slow
@pytest.mark.parametrize("grid", GRIDS, ids=str)
@pytest.mark.parametrize(("roughness", "ior", "cosine"), CASES)
def test_samples_of_a_pane_follow_their_density(
    call_glsl: CallGlsl, roughness: float, ior: float, cosine: float, grid: tuple[int, int]
) -> None:
    """Chi-square over the whole sphere, and how many samples are absorbed."""
    fine = 128 if grid[1] > 1 else 256
    assert_density(call_glsl, SETUP, pane(roughness, ior), cosine, grid, fine, -1.0)


def test_smooth_panes_keep_the_kernel_that_they_had() -> None:
    """Whitted's method shows rough panes as smooth, too."""
    kinds = [(0.0, "mis"), (0.4, "mis"), (0.4, "whitted")]
    needs = [
        prepare(rough(roughness, 1.5, thin=True)["scene"], Settings(method=method)).needs
        for roughness, method in kinds
    ]
    assert [(it.has_pane, it.has_rough_pane, it.has_rough_glass) for it in needs] == [
        (True, False, False),
        (True, True, False),
        (True, False, False),
    ]
