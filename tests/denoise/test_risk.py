"""The estimate of the mean squared error is right on average, whatever the filter does."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from glrt.denoise import denoising
from glrt.denoise.blend import blended
from glrt.denoise.filters import FILTERS, Filtered
from glrt.denoise.half import Half
from glrt.denoise.risk import error_map, relative_error, squared_error, summed
from glrt.denoise.windows import window_mean
from tests.denoise.noisy_halves import Floats, drawn, truth_with_an_edge

SIGMAS = 4.9  # a false alarm in a million for each mean that is compared
DRAWS = 200
ONE = np.ones(1, np.float32)
Filter = Callable[[Half], Floats]


def box(half: Half) -> Floats:
    return window_mean(half.radiance.astype(np.float64), 1)


def plain(half: Half) -> Floats:
    return half.radiance.astype(np.float64)


def constant(half: Half) -> Floats:
    return np.full(half.radiance.shape, 0.7)


def differences(
    filtered: Filter, expected: Callable[[Floats, Floats, Floats], Floats], counts: tuple[int, int]
) -> Floats:
    """Estimates of the mean over the picture less what is expected, of independent draws."""
    rng, truth = np.random.default_rng(7), truth_with_an_edge()
    found = []
    for _ in range(DRAWS):
        halves, _, variances = drawn(rng, truth, counts)
        estimate = squared_error(halves, (filtered(halves[0]), filtered(halves[1])))
        found.append(estimate.mean() - expected(truth, *variances).mean())
    return np.array(found)


def assert_zero_on_average(values: Floats) -> None:
    stderr = values.std(ddof=1) / np.sqrt(len(values))
    assert abs(values.mean()) < SIGMAS * stderr
    assert stderr > 0


@pytest.mark.parametrize("counts", [(4, 4), (3, 9)])
def test_without_a_filter_it_is_the_variance_of_the_plain_picture(counts: tuple[int, int]) -> None:
    a, b = (count / sum(counts) for count in counts)
    assert_zero_on_average(differences(plain, lambda _, u, v: a**2 * u + b**2 * v, counts))


def test_the_noise_that_is_left_is_the_variance_of_what_is_shown(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The filter is a mean over 3 x 3 pixels; its halves have one bias, and are not blended."""
    filters = {"box": lambda half: Filtered(np.asarray(box(half), np.float32), ONE)}
    monkeypatch.setattr(denoising, "FILTERS", filters)
    monkeypatch.setattr(denoising, "blended", lambda half, found: found.radiance)
    rng, truth = np.random.default_rng(8), truth_with_an_edge()
    shown, told = [], []
    for _ in range(DRAWS):
        halves, *_ = drawn(rng, truth, (4, 4))
        found = denoising.denoise(halves, "box")
        assert found.noise is not None
        shown.append(found.radiance)
        told.append(np.square(found.noise, dtype=np.float64).mean())
    expected = np.var(shown, axis=0, ddof=1, dtype=np.float64).mean()
    assert np.mean(told) == pytest.approx(expected, rel=0.05)


@pytest.mark.parametrize("counts", [(4, 4), (3, 9)])
def test_of_a_constant_it_is_the_squared_bias(counts: tuple[int, int]) -> None:
    assert_zero_on_average(differences(constant, lambda truth, *_: (0.7 - truth) ** 2, counts))


@pytest.mark.parametrize("counts", [(4, 4), (3, 9)])
def test_of_a_blur_it_is_bias_and_variance_in_closed_form(counts: tuple[int, int]) -> None:
    a, b = (count / sum(counts) for count in counts)

    def expected(truth: Floats, u: Floats, v: Floats) -> Floats:
        """A mean of n independent pixels has the mean of their variances over n."""
        neighbours = 9 * window_mean(np.pad(np.ones(truth.shape), [(1, 1), (1, 1), (0, 0)]), 1)
        count = neighbours[1:-1, 1:-1]
        variance = window_mean(a**2 * u + b**2 * v, 1) / count
        return np.asarray((window_mean(truth, 1) - truth) ** 2 + variance)

    assert_zero_on_average(differences(box, expected, counts))


@pytest.mark.slow
def test_of_the_filter_and_its_blend_it_is_the_true_error() -> None:
    """The test compares with the truth of each draw: the error has no closed form."""
    rng, truth = np.random.default_rng(3), truth_with_an_edge(16)
    found = []
    for _ in range(60):
        halves = drawn(rng, truth).halves
        first, second = (blended(half, FILTERS["nlm"](half)) for half in halves)
        true = (summed(halves, (first, second)) - truth) ** 2
        found.append(squared_error(halves, (first, second)).mean() - true.mean())
    assert_zero_on_average(np.array(found))


def test_a_half_that_knows_the_other_is_believed_too_much() -> None:
    """Why halves are filtered apart: what is fitted to both has less error by the estimate."""
    rng, truth = np.random.default_rng(5), truth_with_an_edge()
    found = []
    for _ in range(DRAWS):
        halves, _, (u, v) = drawn(rng, truth)
        both = plain(halves[0]) / 2 + plain(halves[1]) / 2
        found.append(squared_error(halves, (both, both)).mean() - (u + v).mean() / 4)
    values = np.array(found)
    assert values.mean() < -SIGMAS * values.std(ddof=1) / np.sqrt(DRAWS)


def test_the_sum_of_the_halves_weighs_them_by_their_samples() -> None:
    halves, _, _ = drawn(np.random.default_rng(1), truth_with_an_edge(4), (2, 6))
    whole = summed(halves, (halves[0].radiance, halves[1].radiance))
    expected = (plain(halves[0]) + 3 * plain(halves[1])) / 4
    np.testing.assert_allclose(whole, expected, rtol=1e-6)


def test_the_relative_error_is_that_of_plain_pictures() -> None:
    """It has each pixel's squared error, and a hundredth of the mean in the denominator."""
    radiance = np.full((2, 2, 3), 2.0, np.float32)
    assert relative_error(np.full((2, 2, 3), 0.0404), radiance) == pytest.approx((0.1, 0.1))
    assert relative_error(np.full((2, 2, 3), -1.0), radiance) == (0, 0)
    assert relative_error(np.zeros((2, 2, 3)), np.zeros((2, 2, 3), np.float32)) == (0, 0)


def test_what_is_much_too_bright_does_not_divide_its_own_error() -> None:
    """One pixel of 100 times the rest, wrong by as much: relative to what is about it."""
    radiance, squares = np.ones((9, 9, 3), np.float32), np.zeros((9, 9, 3))
    radiance[4, 4], squares[4, 4] = 100, 99**2
    usual, dark = (108 / 9) ** 2, 0.01 * (180 / 81) ** 2
    expected = np.sqrt(99**2 / (usual + dark) / 81)
    assert relative_error(squares, radiance).error == pytest.approx(expected)


def test_the_upper_end_is_above_the_truth_in_95_of_100_cases() -> None:
    """The squares vary by chance: 1,000 pictures of 400 pixels, each channel alike."""
    rng, radiance = np.random.default_rng(11), np.ones((20, 20, 3), np.float32)
    squares = rng.normal(0.101, 0.5, size=(1000, 20, 20, 1)) * np.ones(3)
    bands = [relative_error(s, radiance) for s in squares]
    above = sum(band.high >= np.sqrt(0.1) for band in bands)
    assert 915 <= above <= 980
    assert all(band.error <= band.high for band in bands)


def test_the_map_is_a_root_about_each_pixel() -> None:
    squares = np.zeros((40, 40, 3))
    squares[20, 20] = 289.0
    found = error_map(squares)
    assert found[20, 20, 0] == pytest.approx(1)
    assert found[12, 28, 1] == pytest.approx(1)
    assert found[11, 20, 2] == 0
    assert (error_map(-squares) == 0).all()


def test_draws_are_of_the_variance_that_is_reported() -> None:
    """The halves that these tests are made of."""
    rng, truth = np.random.default_rng(2), truth_with_an_edge(8)
    means = [drawn(rng, truth).halves[0].radiance for _ in range(2000)]
    expected = drawn(rng, truth).variances[0].mean()
    assert np.var(means, axis=0).mean() == pytest.approx(expected, rel=0.02)
    changes = [np.abs(b - a).max() for a, b in pairwise(means)]
    assert min(changes) > 0
