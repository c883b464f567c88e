"""The plain picture wins where a filter errs by more than the noise."""

import numpy as np
import pytest

from glrt.denoise.blend import blended, trust
from glrt.denoise.filters import Filtered
from tests.denoise.noisy_halves import drawn

NO_WEIGHT = np.zeros((32, 32), np.float32)
TRUTH = np.full((32, 32, 3), 0.5)


def test_a_filter_that_is_right_is_believed() -> None:
    half = drawn(np.random.default_rng(0), TRUTH, (16, 16)).halves[0]
    found = Filtered(TRUTH.astype(np.float32), NO_WEIGHT)
    alpha = trust(half, found)
    assert alpha.shape == (32, 32)
    assert alpha.mean() > 0.9
    error = np.square(blended(half, found) - TRUTH).mean()
    assert error < np.square(half.radiance - TRUTH).mean() / 20


def test_a_filter_that_is_wrong_is_not_where_it_is_wrong() -> None:
    half = drawn(np.random.default_rng(1), TRUTH, (16, 16)).halves[0]
    bad = TRUTH.astype(np.float32).copy()
    bad[:, 20:] += 1.0  # the variance is 1/128
    found = Filtered(bad, NO_WEIGHT)
    alpha = trust(half, found)
    assert alpha[:, :16].mean() > 0.9
    assert alpha[:, 24:].max() < 0.03
    right = np.square(blended(half, found) - TRUTH)[:, 24:].mean()
    assert right < 1.5 * np.square(half.radiance - TRUTH)[:, 24:].mean()


def test_a_filter_that_changes_nothing_changes_nothing() -> None:
    half = drawn(np.random.default_rng(2), TRUTH).halves[0]
    found = Filtered(half.radiance, np.ones((32, 32), np.float32))
    np.testing.assert_array_equal(blended(half, found), half.radiance)


def test_without_noise_the_plain_picture_is_shown() -> None:
    half = drawn(np.random.default_rng(3), TRUTH).halves[0]
    half = half._replace(variance=np.zeros_like(half.variance))
    found = Filtered(half.radiance + 1, NO_WEIGHT)
    np.testing.assert_array_equal(blended(half, found), half.radiance)


def test_own_weight_is_counted() -> None:
    """A mean of 4 pixels lies as near to each as a wrong one may: its own part is in it."""
    half = drawn(np.random.default_rng(4), np.full((64, 64, 3), 0.5), (16, 16)).halves[0]
    blocks = half.radiance.reshape(32, 2, 32, 2, 3).mean(axis=(1, 3))
    mean = blocks.repeat(2, axis=0).repeat(2, axis=1)
    alpha = trust(half, Filtered(mean, np.full((64, 64), 0.25, np.float32)))
    assert alpha.mean() > 0.9


@pytest.mark.parametrize(("lamp", "guide"), [(4.0, 0.5), (0.5, 1.0)], ids=["light", "guide"])
def test_light_without_noise_is_not_judged_by_the_noisy_wall_next_to_it(
    lamp: float, guide: float
) -> None:
    """A filter makes a lamp darker, and is right on the wall; the two look different by either."""
    is_lamp = np.zeros((32, 32, 1), bool)
    is_lamp[:, :16] = True
    truth, looks = np.where(is_lamp, lamp, TRUTH), np.where(is_lamp, guide, TRUTH)
    half = drawn(np.random.default_rng(5), truth, (16, 16), guide=looks).halves[0]
    half = half._replace(
        radiance=np.where(is_lamp, truth, half.radiance).astype(np.float32),
        variance=np.where(is_lamp, 0, half.variance),
    )
    wrong = np.where(is_lamp, 0.95 * truth, truth).astype(np.float32)
    alpha = trust(half, Filtered(wrong, NO_WEIGHT))
    assert alpha[:, :16].max() < 0.05
    assert alpha[:, 16:].mean() > 0.9


def test_an_edge_is_judged_by_its_own_pixels() -> None:
    """A filter blurs a line of one pixel; the noise of its surroundings does not cover that."""
    truth = TRUTH.copy()
    truth[:, 16] = 1.0
    half = drawn(np.random.default_rng(6), truth, (16, 16), guide=truth).halves[0]
    blurred = truth.astype(np.float32)
    blurred[:, 16] = 0.7
    alpha = trust(half, Filtered(blurred, NO_WEIGHT))
    assert alpha[:, 16].mean() < 0.35
    assert alpha[:, :16].mean() > 0.9


def test_alike_is_reported_by_ratios() -> None:
    """The same bits in another unit of radiance."""
    half = drawn(np.random.default_rng(7), TRUTH).halves[0]
    found = Filtered(half.radiance[::-1].copy(), NO_WEIGHT)
    unit = np.float32(2**20)
    other = half._replace(radiance=half.radiance * unit, variance=half.variance * unit**2)
    scaled = trust(other, found._replace(radiance=found.radiance * unit))
    np.testing.assert_allclose(scaled, trust(half, found), rtol=1e-4)


def test_what_few_look_like_is_trusted_half() -> None:
    """One pixel unlike all others is judged by its own noise alone."""
    truth = TRUTH.copy()
    truth[16, 16] = 4.0
    half = drawn(np.random.default_rng(8), truth, (16, 16), guide=truth).halves[0]
    alpha = trust(half, Filtered(truth.astype(np.float32), NO_WEIGHT))
    assert 0.3 < alpha[16, 16] <= 0.5
    assert alpha[:, :12].mean() > 0.9


def test_no_filter_is_better_than_a_percent() -> None:
    """Noise of a tenth of that shows the plain picture, however right the filter looks."""
    half = drawn(np.random.default_rng(9), TRUTH).halves[0]
    noise = 1e-3 * (half.radiance - TRUTH)
    half = half._replace(radiance=(TRUTH + noise).astype(np.float32), variance=1e-6 * half.variance)
    alpha = trust(half, Filtered(TRUTH.astype(np.float32), NO_WEIGHT))
    assert alpha.max() < 0.02
