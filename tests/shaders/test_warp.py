"""From the unit square to disks, hemispheres and cones, and frames to stand them in.

Moments are taken over a fine grid of the unit square, so no test here depends on chance: the
midpoint rule is exact to 1e-6 for these smooth functions, single precision to a few 1e-7.
"""

import numpy as np
import pytest

from glrt.gpu.context import Context
from tests.conftest import CallGlsl
from tests.support.numerics import ULP, corners, directions, length, unit_square


def most_off(context: Context) -> float:
    """Largest error of a length by sine and cosine: NVIDIA's are off by up to 12 x 2^-24."""
    return (2 if context.is_software else 4) * ULP


def test_a_normalized_vector_has_length_one_at_every_scale(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(2)
    v = random.normal(size=(20_000, 3)) * 10.0 ** random.uniform(-15, 15, (20_000, 1))
    unit = call_glsl("normalized(v)", "vec3", v=v)
    assert np.abs(length(unit) - 1).max() < 2 * ULP
    exact = v / np.linalg.norm(v, axis=1, keepdims=True)
    assert np.abs(unit - exact).max() < 2 * ULP


def test_the_disk_is_filled_evenly(call_glsl: CallGlsl) -> None:
    x, y = call_glsl("sample_disk(u)", "vec2", u=unit_square()).astype(np.float64).T
    assert abs(x.mean()) < 1e-6
    assert abs(y.mean()) < 1e-6
    assert (x**2).mean() == pytest.approx(1 / 4, abs=2e-6)
    assert (y**2).mean() == pytest.approx(1 / 4, abs=2e-6)
    assert (x * y).mean() == pytest.approx(0, abs=2e-6)
    assert ((x**2 + y**2) ** 2).mean() == pytest.approx(1 / 3, abs=2e-6)
    assert length(call_glsl("sample_disk(u)", "vec2", u=corners())).max() <= 1 + ULP


def test_the_hemisphere_is_filled_by_the_cosine(call_glsl: CallGlsl, context: Context) -> None:
    wi = call_glsl("sample_cosine_hemisphere(u)", "vec3", u=unit_square()).astype(np.float64)
    x, y, z = wi.T
    assert z.mean() == pytest.approx(2 / 3, abs=1e-5)  # G33; the root at the rim costs digits
    assert (z**2).mean() == pytest.approx(1 / 2, abs=2e-6)
    assert (z**4).mean() == pytest.approx(1 / 3, abs=2e-6)
    assert np.abs([x.mean(), y.mean(), (x * y).mean()]).max() < 2e-6
    assert (x**2).mean() == pytest.approx(1 / 4, abs=2e-6)
    assert np.abs(length(wi) - 1).max() < most_off(context)


def test_no_direction_of_the_hemisphere_lies_in_the_surface(call_glsl: CallGlsl) -> None:
    wi = call_glsl("sample_cosine_hemisphere(u)", "vec3", u=corners())
    assert wi[:, 2].min() == 2.0**-12
    assert np.abs(length(wi) - 1).max() < 2 * ULP


@pytest.mark.parametrize("one_minus_cos", [1e-12, 1e-6, 1e-3, 0.1, 1.0])
def test_a_cone_is_filled_evenly_by_solid_angle(
    call_glsl: CallGlsl, context: Context, one_minus_cos: float
) -> None:
    w = call_glsl(
        "sample_cone(omc, u)", "vec3", u=unit_square(), omc=np.array([one_minus_cos])
    ).astype(np.float64)
    sin2 = (w[:, :2] ** 2).sum(axis=1)
    drop = sin2 / (1 + np.sqrt(np.maximum(1 - sin2, 0)))  # 1 - cos, with the digits of x and y
    assert drop.mean() == pytest.approx(
        one_minus_cos / 2, rel=1e-4 if one_minus_cos > 0.5 else 2e-6
    )
    assert drop.max() <= one_minus_cos * (1 + 1e-5)
    assert (w[:, 0] * w[:, 1]).mean() == pytest.approx(0, abs=2e-6 * one_minus_cos)
    assert np.abs(w[:, :2].mean(axis=0)).max() < 2e-6 * np.sqrt(one_minus_cos)
    assert np.abs(length(w) - 1).max() < most_off(context)


def test_a_cone_keeps_its_digits_however_narrow(call_glsl: CallGlsl) -> None:
    omc = 10.0 ** np.linspace(-14, 0, 1000)
    u = np.random.default_rng(3).uniform(size=(1000, 2)).astype(np.float32)
    w = call_glsl("sample_cone(omc, u)", "vec3", omc=omc, u=u)
    drop = u[:, 0].astype(np.float64) * omc
    sine = np.sqrt(drop * (2 - drop))
    assert length(w[:, :2]) == pytest.approx(sine, rel=4 * ULP)


def test_frames_are_orthonormal_and_right_handed_around_every_normal(call_glsl: CallGlsl) -> None:
    n = directions(20_000)
    x, y, z = (
        call_glsl(f"frame_around(n)[{column}]", "vec3", n=n).astype(np.float64)
        for column in range(3)
    )
    assert np.array_equal(z, n)
    for axis in (x, y, z):
        assert np.abs(length(axis) - 1).max() < 4 * ULP
    for a, b in ((x, y), (y, z), (z, x)):
        assert np.abs((a * b).sum(axis=1)).max() < 4 * ULP
    assert np.abs(np.cross(x, y) - z).max() < 4 * ULP


def test_a_local_vector_comes_back_from_the_world(call_glsl: CallGlsl) -> None:
    n, v = directions(1000), directions(1000, seed=4)
    back = call_glsl("to_local(frame_around(n), frame_around(n) * v)", "vec3", n=n, v=v)
    assert np.abs(back - v).max() < 8 * ULP
    up = np.tile(np.array([[0.0, 0.0, 1.0]]), (len(n), 1))
    assert np.array_equal(call_glsl("frame_around(n) * up", "vec3", n=n, up=up), n)


def test_products_are_summed_in_one_order(call_glsl: CallGlsl, context: Context) -> None:
    """Every driver must use that order: the `dot` and `length` of Mesa 22 and Mesa 25 differ."""
    rng = np.random.default_rng(11)
    a, b = rng.normal(size=(2, 20_000, 3)).astype(np.float32)
    products = a * b
    expected = products[:, 0] + (products[:, 1] + products[:, 2])
    other = (products[:, 0] + products[:, 1]) + products[:, 2]
    assert (expected != other).mean() > 0.1
    assert (call_glsl("dot(a, b)", a=a, b=b) == expected).all()
    squares = a * a
    sums = squares[:, 0] + (squares[:, 1] + squares[:, 2])
    found = call_glsl("length(a)", a=a)
    assert (found == call_glsl("sqrt(a)", a=sums)).all()
    assert (found == np.sqrt(sums)).all() or not context.is_software
