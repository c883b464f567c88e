"""Blocks of 64, 256 and 1024 points: even as a whole and as they grow, independent of each other.

Statistical bounds lie at 5 standard deviations, as in test_sobol.
"""

from itertools import combinations

import numpy as np
import pytest

from tests.conftest import CallGlsl
from tests.shaders.test_sobol import blocks, draws, is_net
from tests.support.alarms import assert_fits, assert_near
from tests.support.numerics import BELOW_ONE

LONG = (256, 1024)  # blocks of 64 are those of test_sobol, too


@pytest.mark.parametrize("block", LONG)
@pytest.mark.parametrize("skipped", [0, 1, 2])
def test_a_block_and_its_beginning_fill_the_square_evenly(
    call_glsl: CallGlsl, skipped: int, block: int
) -> None:
    for points in blocks(call_glsl, block, 10, skipped):
        assert is_net(points)
        for count in (2, 16, block // 4, block // 2):
            assert is_net(points[:count])
            assert is_net(points[-count:])


@pytest.mark.parametrize(("block", "each"), [(64, 2), (256, 4), (1024, 4)])
def test_points_fill_four_dimensions_evenly(call_glsl: CallGlsl, block: int, each: int) -> None:
    """Boxes of volume `each` / `block`. Pairs of draws that share no point do not fill them."""
    first, second, third = (blocks(call_glsl, block, 10, 2 + k) for k in range(3))
    for points in np.concatenate([first, second], axis=-1):
        assert is_net(points, each)
    apart = np.concatenate([second, third], axis=-1)
    assert sum(is_net(points, each) for points in apart) < 3  # of 10, by chance


@pytest.mark.parametrize(("block", "digits"), [(64, 6), (256, 8), (1024, 10)])
def test_numbers_are_below_one_down_to_the_last_bit(
    call_glsl: CallGlsl, block: int, digits: int
) -> None:
    """A place has the digits of its point and 16 more; floats below 1 end at 1 - 2^-24."""
    bits = np.array([0, 0xFFFFFFFF], np.uint32)
    place = "net_place(uvec2(bits), bits)"
    found = call_glsl(place, "vec2", constants={"BLOCK": block}, bits=bits)
    assert found.tolist() == [[0, 0], [min(1 - 2.0 ** -(digits + 16), BELOW_ONE)] * 2]


@pytest.mark.parametrize("block", LONG)
@pytest.mark.parametrize("place", [0, 5, 255])
def test_each_point_is_uniform_over_pixels_and_blocks(
    call_glsl: CallGlsl, place: int, block: int
) -> None:
    """Down to the last digit of a block in either dimension, and in pairs of 16 x 16 cells."""
    n = 2**18
    pixel, sample = np.arange(n) % 4096, block * (np.arange(n) // 4096) + place
    for skipped in (0, 3):
        found = draws(call_glsl, block, pixel, sample, skipped)
        cells = np.floor(found * 16).astype(int)
        counts = np.bincount(16 * cells[:, 0] + cells[:, 1], minlength=256)
        assert_fits(counts, np.full(256, n / 256))
        for axis in np.floor(found * block).astype(int).T:
            assert_fits(np.bincount(axis, minlength=block), np.full(block, n / block))


@pytest.mark.parametrize("block", LONG)
def test_draws_of_one_sample_are_independent(call_glsl: CallGlsl, block: int) -> None:
    """The last digits of all draws, too, which are scrambled by other bits than the first."""
    n = 2**17
    pixel, sample = np.arange(n) % 4096, block * (np.arange(n) // 4096) + 37
    numbers = np.concatenate([draws(call_glsl, block, pixel, sample, k) for k in range(4)], axis=1)
    pairs = list(combinations(range(8), 2))
    for scale in (16, block):  # the first four digits, and the last four
        digits = np.floor(numbers * scale).astype(int) % 16
        for a, b in pairs:
            counts = np.bincount(16 * digits[:, a] + digits[:, b], minlength=256)
            assert_fits(counts, np.full(256, n / 256), among=2 * len(pairs))


@pytest.mark.parametrize("block", LONG)
@pytest.mark.parametrize("step", ["neighbour", "block"])
def test_blocks_are_independent_of_their_neighbours(
    call_glsl: CallGlsl, step: str, block: int
) -> None:
    """The error of a block in the integral of x y, of neighbouring pixels and of blocks in turn."""
    count = 1024
    errors = []
    for k in range(2):
        pixel = np.repeat(np.arange(count), block) + (k if step == "neighbour" else 0)
        index = np.tile(np.arange(block), count) + (block * k if step == "block" else 0)
        xy = draws(call_glsl, block, pixel, index, 1).prod(axis=1)
        errors.append(xy.reshape(count, block).mean(axis=1) - 0.25)
    a, b = errors
    if step == "neighbour":
        a, b = a[::2], b[::2]
    assert_near(np.corrcoef(a, b)[0, 1], 0, 1 / np.sqrt(len(a)))
    assert_near(a.mean(), 0, a.std() / np.sqrt(len(a)))


def test_the_error_of_a_smooth_integral_falls_faster_than_the_root(call_glsl: CallGlsl) -> None:
    """From 64 to 1024 points: by 4 if points were independent, by about 64 here."""
    few, many = (
        (blocks(call_glsl, block, 256, 0).prod(axis=-1).mean(axis=1) - 0.25).std()
        for block in (64, 1024)
    )
    assert few > 16 * many
