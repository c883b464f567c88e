"""Layers under weights: mean and variance from two halves of the observations."""

import numpy as np

from glrt.image.layer_sums import Floats, LayerSums

PICTURES, SIZE = 4000, (3, 2)


def sums_of(seen: Floats) -> LayerSums:
    """The sums of observations (N, H, W, 3) of four samples each, by turns in either half."""
    halves = seen[::2], seen[1::2]
    counts = [np.full((*SIZE, 1), 4.0 * len(half)) for half in halves]
    return LayerSums(np.array([half.mean(axis=0) for half in halves]), np.array(counts))


def observations(rng: np.random.Generator, count: int) -> Floats:
    """Exponential, of mean and standard deviation 1."""
    return rng.exponential(size=(count, *SIZE, 3))


def test_the_rest_is_what_its_own_observations_make() -> None:
    seen = observations(np.random.default_rng(0), 10)
    rest, alone = sums_of(seen).without(sums_of(seen[:4])), sums_of(seen[4:])
    np.testing.assert_allclose(rest.means, alone.means, rtol=1e-12)
    np.testing.assert_array_equal(rest.counts, alone.counts)
    np.testing.assert_allclose(sums_of(seen).mean, seen.mean(axis=0), rtol=1e-6)


def test_the_variance_is_right_on_average_for_halves_of_any_size() -> None:
    """It is a third for 3 observations, two of them in one half; 5 standard errors, 6e-7."""
    rng = np.random.default_rng(1)
    for count in (2, 3, 6):
        found = np.array([sums_of(observations(rng, count)).variance for _ in range(PICTURES)])
        pictures = found.mean(axis=(1, 2, 3))
        stderr = pictures.std(ddof=1) / np.sqrt(PICTURES)
        assert abs(pictures.mean() - 1 / count) < 5 * stderr, count


def test_of_one_observation_there_is_no_variance() -> None:
    one = observations(np.random.default_rng(2), 1)
    counts = np.array([np.full((*SIZE, 1), 4.0), np.zeros((*SIZE, 1))])
    sums = LayerSums(np.array([one[0], np.zeros_like(one[0])]), counts)
    assert (sums.variance == 0).all()
    np.testing.assert_allclose(sums.mean, one[0], rtol=1e-6)
