"""Means over neighbours, against loops."""

import numpy as np
import pytest

from glrt.denoise.windows import window_mean


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
