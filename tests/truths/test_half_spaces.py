"""Half spaces that scatter the light of a sun, against Chandrasekhar's H-functions."""

import math

import numpy as np
import pytest

from glrt.gpu.context import Context
from tests.support.builders import plane
from tests.support.media import FAR, filled, medium, with_fog
from tests.support.numerics import Array
from tests.support.renders import assert_mean, rendered, whole


def h_function(albedo: float, cosines: Array) -> Array:
    """Solve 1 / H(x) = sqrt(1 - w) + w / 2 times the integral of y H(y) / (x + y) by iteration.

    For isotropic scattering of the albedo w (Chandrasekhar, Radiative Transfer, 1950, section 38).
    """
    nodes, weights = np.polynomial.legendre.leggauss(64)
    y, dy = (nodes + 1) / 2, weights / 2
    h = np.ones_like(y)

    def step(x: Array) -> Array:
        below = math.sqrt(1 - albedo) + albedo / 2 * (dy * y * h / (x[:, None] + y)).sum(axis=1)
        found: Array = 1 / below
        return found

    for _ in range(200):
        h = step(y)
    return step(cosines)


def test_the_h_function_is_that_of_the_tables() -> None:
    found = 1 - h_function(0.9, np.array([1.0, 0.5, 0.1])) * math.sqrt(0.1)
    np.testing.assert_allclose(found, [0.41495, 0.50794, 0.62934], atol=2e-5)


@pytest.mark.slow_cases("0.5-*", "*-0.3")
@pytest.mark.parametrize("turn", [0.8, 0.3], ids=str)
@pytest.mark.parametrize("albedo", [0.9, 0.5], ids=str)
def test_a_half_space_under_a_sun_reflects_what_chandrasekhar_says(
    context: Context, albedo: float, turn: float
) -> None:
    """w E / (4 pi) times y H(x) H(y) / (x + y), by the cosines x of the view and y of the sun."""
    view = 0.6
    sun = {
        "direction": [0, math.sqrt(1 - turn**2), turn],
        "angle": 0.01,
        "irradiance": [1.0, 2.0, 0.5],
    }
    eye = {**FAR, "position": [5 * math.sqrt(1 - view**2), 0, 5 * view]}
    half = filled(plane([0, 0, 0], [0, 0, 1], ""))
    fog = medium(scattering=albedo, absorption=1 - albedo)
    image = rendered(
        with_fog([half], fog, eye, sun=sun), context, 1024, bounces=256, sampler="sobol"
    )
    seen, lit = h_function(albedo, np.array([view, turn]))
    truth = albedo / (4 * math.pi) * turn * seen * lit / (view + turn) * np.array([1, 2, 0.5])
    assert_mean(whole(image), truth, 0.02)
