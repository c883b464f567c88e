"""Nets that keep growing: even at each power of two, and independent between scrambles and draws.

Statistical bounds lie at 5 standard deviations, as in test_sobol.
"""

from itertools import combinations

import numpy as np
import pytest

from glrt.samplers import NET
from tests.conftest import CallGlsl
from tests.shaders.test_sobol import is_net
from tests.support.alarms import assert_fits, assert_near
from tests.support.numerics import Array

DRAWS = 4  # pairs of numbers; two in turn share a point
FULL = 1 << 16  # points of a net


def draws(call_glsl: CallGlsl, pixel: Array, sample: Array, pair: int = 0) -> Array:
    """The pair of numbers number `pair` that samples of pixels draw, (n, 2) float64."""
    setup = """Sampler rng = sampler_at(ivec2(x % 64, x / 64), index, 7u);
        for (int k = 0; k < skipped; ++k) next_2d(rng);"""
    args = {"x": pixel, "index": sample, "skipped": np.full(len(pixel), pair)}
    constants = {"BLOCK": NET, "HAS_NET": True}
    return call_glsl("next_2d(rng)", "vec2", setup=setup, constants=constants, **args).astype(float)


def nets(call_glsl: CallGlsl, count: int, points: int, pair: int = 0, first: int = 0) -> Array:
    """Points from number `first` on of the scramble 3 of `count` pixels, (count, points, 2)."""
    pixel = np.repeat(np.arange(count), points)
    sample = NET * (first + np.tile(np.arange(points), count)) + 3
    return draws(call_glsl, pixel, sample, pair).reshape(count, points, 2)


@pytest.mark.parametrize("points", [2, 16, 64, 256])
@pytest.mark.parametrize("pair", [0, 1, 2])
def test_first_points_and_those_that_follow_fill_the_square_evenly(
    call_glsl: CallGlsl, pair: int, points: int
) -> None:
    for first in (0, points):
        assert all(is_net(net) for net in nets(call_glsl, 20, points, pair, first))


def test_64_points_fill_four_dimensions_evenly(call_glsl: CallGlsl) -> None:
    """Eight in each box of volume 1 / 8: t = 3. Pairs that share no point do not."""
    together = np.concatenate([nets(call_glsl, 20, 64, pair) for pair in (0, 1)], axis=-1)
    assert all(is_net(net, each=8) for net in together)
    apart = np.concatenate([nets(call_glsl, 20, 64, pair) for pair in (1, 2)], axis=-1)
    assert not any(is_net(net, each=8) for net in apart)


def test_samples_in_turn_are_of_different_scrambles(call_glsl: CallGlsl) -> None:
    """A net of 16 points is dealt out over 128 samples; 16 in turn are none."""
    sample = np.tile(np.arange(16), 50)
    in_turn = draws(call_glsl, np.repeat(np.arange(50), 16), sample).reshape(50, 16, 2)
    assert sum(is_net(points) for points in in_turn) < 5


def test_a_full_net_is_followed_by_another(call_glsl: CallGlsl) -> None:
    same = nets(call_glsl, 20, 16), nets(call_glsl, 20, 16, first=FULL)
    assert all(is_net(net) for net in same[1])
    assert (same[0] != same[1]).mean() > 0.99


@pytest.mark.parametrize("place", [0, 5, 1000])
def test_each_point_is_uniform_over_pixels_and_scrambles(call_glsl: CallGlsl, place: int) -> None:
    n = 2**18
    pixel, sample = np.arange(n) % (n // NET), NET * place + np.arange(n) // (n // NET)
    for pair in (0, 3):
        found = draws(call_glsl, pixel, sample, pair)
        cells = np.floor(found * 16).astype(int)
        counts = np.bincount(16 * cells[:, 0] + cells[:, 1], minlength=256)
        assert_fits(counts, np.full(256, n / 256))
        assert found.max() < 1


def test_draws_of_one_sample_are_independent(call_glsl: CallGlsl) -> None:
    n = 2**17
    pixel, sample = np.arange(n) % (n // NET), 40 + np.arange(n) // (n // NET)
    numbers = np.concatenate([draws(call_glsl, pixel, sample, k) for k in range(DRAWS)], axis=1)
    pairs = list(combinations(range(2 * DRAWS), 2))
    for a, b in pairs:
        cells = np.floor(numbers[:, [a, b]] * 16).astype(int)
        counts = np.bincount(16 * cells[:, 0] + cells[:, 1], minlength=256)
        assert_fits(counts, np.full(256, n / 256), among=len(pairs))


@pytest.mark.parametrize("step", ["neighbour", "scramble"])
def test_scrambles_are_independent(call_glsl: CallGlsl, step: str) -> None:
    """The errors of 64 points in the integral of x y, of neighbouring pixels and of scrambles."""
    count, points = 2048, 64
    errors = []
    for k in range(2):
        pixel = np.repeat(np.arange(count), points) + (k if step == "neighbour" else 0)
        sample = NET * np.tile(np.arange(points), count) + (k if step == "scramble" else 0)
        xy = draws(call_glsl, pixel, sample).prod(axis=1)
        errors.append(xy.reshape(count, points).mean(axis=1) - 0.25)
    a, b = errors
    if step == "neighbour":
        a, b = a[::2], b[::2]
    assert_near(np.corrcoef(a, b)[0, 1], 0, 1 / np.sqrt(len(a)))
    assert_near(a.mean(), 0, a.std() / np.sqrt(len(a)))
    assert a.std() < 0.2 * np.sqrt(7 / 144 / points)  # of independent numbers


def test_the_error_of_a_smooth_integral_falls_faster_than_the_root(call_glsl: CallGlsl) -> None:
    """From 16 to 256 points: by 4 if points were independent, by about 64 here."""
    few, many = (
        (nets(call_glsl, 256, points).prod(axis=-1).mean(axis=1) - 0.25).std()
        for points in (16, 256)
    )
    assert few > 16 * many
