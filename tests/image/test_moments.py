"""Merged moments of disjoint samples are the moments that numpy finds of all samples at once."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glrt.image.moments import Moments, combined, merged
from tests.support.raw_samples import BLOCK, Array, moments_of, noise

COUNTS = [1, 2, 3, 4, 5, 7, 8, 16, 17]


def cut(samples: Array, cuts: Sequence[int]) -> list[Array]:
    """Parts that end with these observations, the last one with the samples."""
    places = [0, *(BLOCK * place for place in cuts), len(samples)]
    return [samples[a:b] for a, b in pairwise(places)]


def equal_parts(samples: Array, count: int) -> list[Array]:
    observations = -(-len(samples) // BLOCK)
    return cut(samples, [k * observations // count for k in range(1, count)])


def together(parts: Sequence[Array]) -> Moments:
    films = [{"film": moments_of(part)} for part in parts]
    return merged([lambda film=film: film for film in films])["film"]  # type: ignore[misc]


def assert_same(found: Moments, truth: Moments, relative: float = 1e-12) -> None:
    """Counts are exact; means and variances have the digits of float64."""
    for name in Moments._fields:
        a, b = getattr(found, name), getattr(truth, name)
        assert a.shape == b.shape, name
        if name in ("samples", "observations", "begun"):
            assert np.array_equal(a, b), name
        else:
            np.testing.assert_allclose(a, b, rtol=relative, atol=1e-300, err_msg=name)


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("rest", [0, 1, 15])
def test_parts_together_have_the_moments_of_all_samples(count: int, rest: int) -> None:
    """The last may end inside an observation, which it then holds alone."""
    samples = noise(40 * BLOCK + rest)
    assert_same(together(equal_parts(samples, count)), moments_of(samples))


def test_one_set_is_taken_as_it_is() -> None:
    alone = moments_of(noise(50))
    assert merged([lambda: {"film": alone}])["film"] is alone


@settings(max_examples=60, deadline=None, derandomize=True, database=None)
@given(
    st.lists(st.integers(0, 30), max_size=12).map(sorted),
    st.integers(0, BLOCK - 1),
    st.integers(0, 99),
)
def test_wherever_samples_are_cut_nothing_is_lost(cuts: list[int], rest: int, seed: int) -> None:
    """Some parts hold nothing."""
    samples = noise(30 * BLOCK + rest, seed)
    assert_same(together(cut(samples, cuts)), moments_of(samples))


@settings(max_examples=40, deadline=None, derandomize=True, database=None)
@given(st.integers(2, 17), st.integers(0, 99))
def test_pixels_that_met_nothing_for_whole_observations_have_fewer(count: int, seed: int) -> None:
    """Depth at an edge is such a case: some observations, and some pixels, have no sample."""
    samples = noise(20 * BLOCK, seed)
    is_empty = np.random.default_rng(seed).random((20, *samples.shape[1:3])) < 0.4
    samples[np.repeat(is_empty, BLOCK, axis=0)] = np.nan
    samples[:, 0, 0] = np.nan
    samples[: 5 * BLOCK, 0, 1] = np.nan
    truth = moments_of(samples)
    assert truth.samples[0, 0, 0] == truth.observations[0, 0, 0] == 0
    found = together(equal_parts(samples, count))
    assert_same(found, truth)
    assert (found.mean[0, 0] == 0).all()
    assert (found.variance[0, 0] == 0).all()


@pytest.mark.parametrize("count", [2, 3, 5])
def test_dropped_samples_weigh_nothing(count: int) -> None:
    """Means and counts are exact. In the variance of a part, observations weigh alike, and in its
    mean by their samples: a difference in the second digit.
    """
    samples = noise(40 * BLOCK + 5)
    samples[np.random.default_rng(3).random(samples.shape[:3]) < 0.3] = np.nan
    found, truth = together(equal_parts(samples, count)), moments_of(samples)
    assert_same(found._replace(variance=truth.variance), truth)
    np.testing.assert_allclose(found.variance, truth.variance, rtol=0.06)


@pytest.mark.parametrize("count", [2, 7, 17])
def test_a_small_spread_about_a_large_mean_keeps_its_digits(count: int) -> None:
    """Sums of squares would lose 12 of 16 digits here."""
    samples = 1e6 + np.random.default_rng(5).normal(size=(34 * BLOCK, 3, 4, 3))
    found, truth = together(equal_parts(samples, count)), moments_of(samples)
    np.testing.assert_allclose(found.variance, truth.variance, rtol=1e-8)
    np.testing.assert_allclose(found.mean, truth.mean, rtol=1e-14)


@pytest.mark.parametrize("count", [2, 7, 17])
def test_a_small_spread_outlives_the_rounding_of_files(count: int) -> None:
    """Means in float32 are 1/16 apart at 1e6, where observations spread by 1/4."""
    samples = 1e6 + np.random.default_rng(5).normal(size=(34 * BLOCK, 3, 4, 3))
    rounded = [
        {"film": Moments(*(x.astype(np.float32).astype(float) for x in moments_of(part)))}
        for part in equal_parts(samples, count)
    ]
    found = merged([lambda film=film: film for film in rounded])["film"]  # type: ignore[misc]
    truth = moments_of(samples)
    np.testing.assert_allclose(found.variance, truth.variance, rtol=0.15)
    np.testing.assert_allclose(found.mean, truth.mean, rtol=5e-8)


def test_equal_samples_have_no_variance() -> None:
    samples = np.full((10 * BLOCK, 3, 4, 3), 0.375)
    found = together(equal_parts(samples, 5))
    assert (found.variance == 0).all()
    assert (found.mean == moments_of(samples[:BLOCK]).mean).all()


def test_two_means_and_their_distance_make_the_variance() -> None:
    """Two observations at 0 and two at 1: the mean squared deviation is 1/4."""
    zeros, ones = (np.full((2 * BLOCK, 1, 1, 1), value) for value in (0.0, 1.0))
    found = combined(moments_of(zeros), moments_of(ones))
    assert [x.item() for x in (found.mean, found.variance, found.observations)] == [0.5, 0.25, 4]
    assert found.whole_mean == 0.5


def test_a_begun_observation_moves_the_mean_and_not_the_variance() -> None:
    """Two observations at 0, two at 1, and eight samples at 7 that make none."""
    zeros = np.zeros((2 * BLOCK, 1, 1, 1))
    rest = np.concatenate([np.ones((2 * BLOCK, 1, 1, 1)), np.full((8, 1, 1, 1), 7.0)])
    found = combined(moments_of(zeros), moments_of(rest))
    assert found.variance == 0.25
    assert found.mean == pytest.approx((32 + 56) / 72, rel=1e-15)
    assert [x.item() for x in (found.begun, found.part, found.samples)] == [8, 7, 72]
    assert found.whole_mean == pytest.approx(0.5, rel=1e-14)


def test_films_are_merged_by_their_names() -> None:
    films = [{name: moments_of(noise(32, seed)) for name in "ab"} for seed in (1, 2)]
    found = merged([lambda film=film: film for film in films])  # type: ignore[misc]
    assert [*found] == ["a", "b"]
    for name in "ab":
        assert_same(found[name], combined(films[0][name], films[1][name]), 0)


def test_few_films_are_held_at_a_time() -> None:
    """Each is loaded once, in order; of 64 never more than seven wait to be merged."""
    held, most, order = 0, 0, []
    alone = moments_of(noise(16))

    class Held(dict[str, Moments]):
        def __init__(self, number: int) -> None:
            nonlocal held, most
            super().__init__(film=alone)
            held, most = held + 1, max(most, held + 1)
            order.append(number)

        def __del__(self) -> None:
            nonlocal held
            held -= 1

    merged([lambda number=number: Held(number) for number in range(64)])  # type: ignore[misc]
    assert order == [*range(64)]
    assert most <= 7
