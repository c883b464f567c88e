"""Counts of adaptive pictures: from the noise of the other half, whole units, never less later."""

import numpy as np
import pytest

from glrt.image.allotment import (
    FLOOR,
    GROUP,
    LEAST,
    MOST,
    counts_of,
    floor_of,
    halves,
    shares_of,
    unit_of,
)
from glrt.settings import Sampler, Settings

SHAPE = (23, 41)
RANDOM = np.random.default_rng(7)
MEAN = RANDOM.uniform(0.5, 2, (*SHAPE, 3)).astype(np.float32)
VARIANCE = (RANDOM.exponential(size=(*SHAPE, 3)) ** 3).astype(np.float32)
VARIANCE[:, 20:] *= np.float32(50)
PLAIN = Settings()


def test_shares_of_a_half_follow_from_the_other_half_alone() -> None:
    """A pixel's own luck, that of its group and of all pixels that its count is scaled by."""
    shares = shares_of(MEAN, VARIANCE)
    for half in halves(SHAPE):
        mean, variance = MEAN.copy(), VARIANCE.copy()
        mean[half], variance[half] = 9.0, 1e6
        after = shares_of(mean, variance)
        assert np.array_equal(after[half], shares[half])
        assert not np.array_equal(after[~half], shares[~half])
        assert np.array_equal(
            counts_of(after, 300, PLAIN)[half], counts_of(shares, 300, PLAIN)[half]
        )


def test_a_half_holds_whole_groups_in_turn() -> None:
    first, second = halves(SHAPE)
    assert (first ^ second).all()
    for y in range(SHAPE[0]):
        for x in range(0, SHAPE[1], GROUP):
            assert (first[y, x : x + GROUP] == ((y + x // GROUP) % 2 == 0)).all()


@pytest.mark.parametrize("samples", [301, 5000])
def test_pixels_of_a_group_have_one_count(samples: int) -> None:
    """Lanes of the driver stay together."""
    shares = shares_of(MEAN, VARIANCE)
    counts = counts_of(shares, samples, PLAIN)
    for x in range(0, SHAPE[1], GROUP):
        for found in (shares, counts):
            assert (found[:, x : x + GROUP] == found[:, x, None]).all()
    assert len(np.unique(counts)) > 9


def test_shares_are_in_proportion_to_the_noise_of_neighbours_relative_to_their_radiance() -> None:
    variance = np.ones((40, 64, 3), np.float32)
    variance[:, 32:] = 4
    mean = np.ones_like(variance)
    shares = shares_of(mean, variance)
    np.testing.assert_allclose(shares[:, 40:] / shares[:1, :1], 2, rtol=1e-5)
    brighter = mean.copy()
    brighter[:, 32:] = 100
    found = shares_of(brighter, variance)
    assert (found[:, 40:] < found[:1, :1]).all()


def test_shares_have_the_mean_1_and_keep_to_their_range() -> None:
    shares = shares_of(MEAN, VARIANCE)
    for half in halves(SHAPE):
        assert abs(shares[half].mean() - 1) < 1e-6
    assert shares.min() >= LEAST - 1e-6
    assert shares.max() <= MOST + 1e-6
    spot = np.zeros_like(VARIANCE)
    spot[0, 0] = 1
    found = shares_of(MEAN, spot)
    assert found.max() > 0.9 * MOST
    assert found.min() > LEAST
    assert abs(found.mean() - 1) < 1e-3


@pytest.mark.parametrize("size", [SHAPE, (1, 8), (1, 1), (5, 3)])
def test_pictures_without_noise_or_without_neighbours_have_equal_counts(
    size: tuple[int, int],
) -> None:
    noise = 0.0 if size == SHAPE else 1.0
    variance = np.full((*size, 3), noise, np.float32)
    shares = shares_of(np.zeros_like(variance), variance)
    assert (shares == 1).all()
    assert (counts_of(shares, 160, PLAIN) == 160).all()


@pytest.mark.parametrize("sampler", ["sobol", "sobol64", "independent"])
def test_counts_are_whole_units_that_grow(sampler: Sampler) -> None:
    settings = Settings(sampler=sampler)
    floor, unit = floor_of(settings), unit_of(settings)
    shares = shares_of(MEAN, VARIANCE)
    assert (counts_of(shares, 40, settings) == 40).all()
    before = np.full(SHAPE, floor)
    for samples in (floor, floor + 1, floor + 7, 2 * floor + 3, 777, 5000):
        counts = counts_of(shares, samples, settings)
        assert (counts % unit == 0).all()
        assert (counts >= before).all()
        for half in halves(SHAPE):
            assert 0 <= samples * half.sum() - counts[half].sum() < unit * GROUP
        before = counts
    assert np.corrcoef(counts.ravel(), shares.ravel())[0, 1] > 0.999


def test_the_floor_holds_four_observations() -> None:
    assert floor_of(PLAIN) == FLOOR == 4 * PLAIN.block
    assert floor_of(Settings(sampler="sobol64")) == 256
    assert floor_of(Settings(sampler="independent")) == FLOOR
