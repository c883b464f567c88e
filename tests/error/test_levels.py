"""A picture's error is relative to its true radiance: rare bright samples do not divide their own.

Synthetic pictures whose true error is known in closed form; seeds are fixed.
"""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.error.estimate import estimated_error, relative_error, squared_levels

Array = NDArray[np.float64]

SIZE = 32
EVEN, NOISE = 1.0, 0.3  # radiance around the rare samples, and deviation of one sample there
FLASH = 20.0  # times EVEN: what one rare sample adds to the mean of all


def even() -> tuple[Array, Array]:
    """Radiance 1 with a standard error of 1 %."""
    return np.ones((SIZE, SIZE, 3)), np.full((SIZE, SIZE, 3), 0.01)


def flashing(observations: int, hits: float, seed: int) -> tuple[Array, Array]:
    """A picture where each pixel expects so many rare samples; channels are alike."""
    draw = np.random.default_rng(seed)
    found = draw.binomial(observations, hits / observations, (SIZE, SIZE, 1)) * np.ones(3)
    usual = NOISE * draw.normal(size=found.shape) / math.sqrt(observations)
    share, degrees = found / observations, observations - 1
    variance = (FLASH * observations) ** 2 * share * (1 - share) * observations / degrees
    variance += NOISE**2 * draw.chisquare(degrees, found.shape) / degrees
    return EVEN + FLASH * found + usual, np.sqrt(variance / observations)


def true_error(observations: int, hits: float) -> float:
    level, chance = EVEN + FLASH * hits, hits / observations
    variance = (FLASH * observations) ** 2 * chance * (1 - chance) + NOISE**2
    return math.sqrt(variance / observations / (1.01 * level**2))


@pytest.mark.parametrize("hits", [0.003, 0.03, 0.3])
@pytest.mark.parametrize("observations", [8, 16, 64, 256])
def test_rare_bright_samples_count_by_what_is_around_them(observations: int, hits: float) -> None:
    """The error is right within a factor of two; by each pixel's own radiance, a third at most."""
    pictures = [flashing(observations, hits, seed) for seed in range(16)]
    truth = true_error(observations, hits)
    squares = [(estimated_error(*picture) or 0) ** 2 for picture in pictures]
    by_own = [(relative_error(*picture) or 0) ** 2 for picture in pictures]
    assert 0.7 < math.sqrt(np.mean(squares)) / truth < 2
    assert math.sqrt(np.mean(by_own)) / truth < 1 / 3


@pytest.mark.parametrize("observations", [8, 9, 16, 64, 1024])
def test_even_noise_is_estimated_as_before(observations: int) -> None:
    picture = flashing(observations, 0.0, 1)
    assert estimated_error(*picture) == pytest.approx(relative_error(*picture), rel=0.005)
    assert estimated_error(*picture) == pytest.approx(true_error(observations, 0), rel=0.05)


def test_a_lone_lucky_sample_is_thirty_two_times_too_bright_at_most() -> None:
    radiance, stderr = even()
    radiance[5, 5] = stderr[5, 5] = 1e4
    mean = radiance.mean()
    ratio = 1e8 / ((1e4 / 32) ** 2 + 0.01 * mean**2)
    usual = 1e-4 / (1 + 0.01 * mean**2)
    expected = math.sqrt((ratio + (SIZE**2 - 1) * usual) / SIZE**2)
    assert estimated_error(radiance, stderr) == pytest.approx(expected)


@pytest.mark.parametrize("place", [(0, 0), (0, 9), (13, 13), (SIZE - 1, 4)])
def test_a_dark_pixel_next_to_a_lamp_counts_by_its_own(place: tuple[int, int]) -> None:
    radiance, stderr = even()
    radiance[place] = stderr[place] = 0.5
    y, x = place
    radiance[y, x + 1] = 1000.0
    stderr[y, x + 1] = 10.0
    assert squared_levels(radiance, stderr)[place] == pytest.approx(0.25)
    assert estimated_error(radiance, stderr) == pytest.approx(
        relative_error(radiance, stderr), rel=1e-3
    )


def test_the_rim_of_a_lamp_counts_by_its_own() -> None:
    radiance, stderr = even()
    radiance[10:15, 10:15] = 1000.0
    stderr[10:15, 10:15] = 1.0
    radiance[10:15, 9] = stderr[10:15, 9] = 300.0
    assert squared_levels(radiance, stderr)[10:15, 9] == pytest.approx(9e4)


@pytest.mark.parametrize(("hits", "within"), [(16, 0.16), (64, 0.04), (400, 0.006), (1e6, 1e-5)])
def test_a_highlight_of_one_pixel_that_many_samples_met_counts_by_its_own(
    hits: float, within: float
) -> None:
    """The squared level is less by 4 / h for h hits."""
    radiance, stderr = even()
    radiance[7, 20] = 1000.0
    stderr[7, 20] = 1000.0 / math.sqrt(hits)
    assert squared_levels(radiance, stderr)[7, 20] == pytest.approx(1e6 * (1 - 4 / hits))
    assert estimated_error(radiance, stderr) == pytest.approx(
        relative_error(radiance, stderr), rel=within
    )


def test_only_what_is_in_the_picture_is_next_to_a_pixel() -> None:
    """A crop, whose film has no more, is estimated by itself."""
    radiance, stderr = even()
    radiance[:, 8] = 500.0
    radiance[3, 7] = stderr[3, 7] = 400.0
    whole, part = (squared_levels(radiance[:, :n], stderr[:, :n]) for n in (SIZE, 8))
    assert whole[3, 7] == pytest.approx(400.0**2)
    assert part[3, 7] == pytest.approx((400 / 32) ** 2)
    single = radiance[3:4, 7:8], stderr[3:4, 7:8]
    assert estimated_error(*single) == pytest.approx(1 / math.sqrt(1.01)), "it has no neighbours"


def test_without_two_observations_there_is_no_estimate() -> None:
    radiance, stderr = even()
    assert estimated_error(radiance, np.full_like(stderr, np.nan)) is None
    stderr[0, 0, 0] = np.nan
    assert estimated_error(radiance, stderr) is None


def test_black_pictures_and_channels() -> None:
    radiance, stderr = flashing(64, 0.03, 2)
    nothing = np.zeros_like(radiance)
    assert estimated_error(nothing, nothing) == 0.0
    assert estimated_error(nothing, stderr) == math.inf
    gray, red = radiance.copy(), np.array([1.0, 0.0, 0.0])
    gray[:], noise = radiance[..., :1], stderr[..., :1] * np.ones(3)
    one, other = estimated_error(gray[..., :1], noise[..., :1]), estimated_error(gray, noise)
    assert one == pytest.approx(other), "channels that are alike count as one"
    assert 0 < (estimated_error(radiance * red, stderr * red) or 0) < 5


@pytest.mark.parametrize("power", [-40, -3, 17, 50])
def test_the_unit_of_radiance_changes_no_bit(power: int) -> None:
    radiance, stderr = (part.astype(np.float32) for part in flashing(16, 0.1, 3))
    factor = np.float32(2.0**power)
    scaled = estimated_error(factor * radiance, factor * stderr)
    assert scaled == estimated_error(radiance, stderr)


def test_a_mirrored_picture_has_the_same_error() -> None:
    radiance, stderr = flashing(16, 0.1, 4)
    wanted = estimated_error(radiance, stderr)
    for turn in (np.flipud, np.fliplr, np.rot90):
        assert estimated_error(turn(radiance), turn(stderr)) == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("rows", [1, 3, SIZE])
def test_rows_in_work_together_change_no_level(monkeypatch: pytest.MonkeyPatch, rows: int) -> None:
    radiance, stderr = flashing(16, 0.1, 5)
    wanted = estimated_error(radiance, stderr)
    monkeypatch.setattr("glrt.error.estimate.BAND", rows * radiance[0].size)
    assert estimated_error(radiance, stderr) == pytest.approx(wanted, rel=1e-12)
