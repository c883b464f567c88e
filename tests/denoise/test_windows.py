"""Means over neighbours, against loops."""

import numpy as np
import pytest

from glrt.denoise.windows import pairs, window_mean


@pytest.mark.parametrize("reach", [0, 1, 3, 9])
@pytest.mark.parametrize("shape", [(5, 7), (1, 4, 3), (6, 1), (8, 5, 2)])
def test_a_mean_is_over_the_pixels_that_are_there(reach: int, shape: tuple[int, ...]) -> None:
    image = np.random.default_rng(0).normal(size=shape)
    found = window_mean(image, reach)
    for y, x in np.ndindex(shape[:2]):
        near = image[max(0, y - reach) : y + reach + 1, max(0, x - reach) : x + reach + 1]
        np.testing.assert_allclose(found[y, x], near.mean(axis=(0, 1)), rtol=1e-12, atol=1e-14)


def test_the_type_stays_and_sums_do_not_lose_digits() -> None:
    image = np.full((400, 400), 1e-3, np.float32)
    image[0, 0] = 1e4
    found = window_mean(image, 2)
    assert found.dtype == np.float32
    np.testing.assert_allclose(found[10:, 10:], 1e-3, rtol=1e-6)


@pytest.mark.parametrize("reach", [1, 3])
@pytest.mark.parametrize("size", [(5, 7), (1, 4), (3, 2)])
def test_each_pair_of_neighbours_comes_once(size: tuple[int, int], reach: int) -> None:
    number = np.arange(size[0] * size[1]).reshape(size)
    found = [
        frozenset(pair)
        for here, there in pairs(size, reach)
        for pair in zip(number[here].flat, number[there].flat, strict=True)
    ]
    near = [
        frozenset((number[a], number[b]))
        for a in np.ndindex(size)
        for b in np.ndindex(size)
        if a != b and max(abs(a[0] - b[0]), abs(a[1] - b[1])) <= reach
    ]
    assert len(found) == len(set(found))
    assert set(found) == set(near)
