"""A chart's figures from its points: slopes, biases, times to an error, the Pareto front."""

import math
from typing import Any

import numpy as np
import pytest

from glrt.analysis.chart.curves import curve_of, front, mean_interval, squared_interval
from glrt.analysis.chart.measure import Look, Run

SAMPLES = [2**k for k in range(14)]


def runs(noise: float, bias: float, scatter: float = 0.02, count: int = 5) -> list[Run]:
    """Rounds of a method with a millisecond a sample, of relative `noise` in one sample."""
    draw = np.random.default_rng(5)

    def shaken(value: float) -> float:
        return value * (1 + scatter * draw.normal())

    return [
        Run(
            "method",
            [Look(n, 1e-3 * n, shaken(noise**2 / n) + shaken(bias**2)) for n in SAMPLES],
            shaken(bias**2) + 1e-6 * draw.normal(),
        )
        for _ in range(count)
    ]


def near(milliseconds: float, measured: bool) -> Any:
    """A time within 2 %."""
    return (pytest.approx(milliseconds, rel=0.02), measured)


def test_noise_alone_falls_with_the_square_root() -> None:
    curve = curve_of("method", runs(1.0, 0.0))
    assert curve.slope is not None
    assert curve.slope.low < -0.5 < curve.slope.high
    assert curve.slope.high - curve.slope.low < 0.01
    assert not curve.is_biased
    assert curve.seen_bias == 0


def test_intervals_of_slopes_hold_the_truth_where_errors_are_skewed() -> None:
    """500 fits to 5 runs with rare large errors: 95 % +- 1 % hold -0.5.

    The test allows 4 standard deviations.
    """
    draw = np.random.default_rng(1)

    def look(samples: int) -> Look:
        spread = 0.8 / samples**0.25
        skewed = math.exp(draw.normal(0, spread) - 0.5 * spread**2)  # its mean is 1
        return Look(samples, 1e-3 * samples, skewed / samples)

    slopes = []
    for _ in range(500):
        five = [Run("m", [look(n) for n in SAMPLES], 0.0) for _ in range(5)]
        slope = curve_of("m", five, least_bias=1.0).slope
        assert slope is not None
        slopes.append(slope)
    assert np.mean([s.low <= -0.5 <= s.high for s in slopes]) == pytest.approx(0.95, abs=0.04)
    assert np.mean([s.value for s in slopes]) == pytest.approx(-0.5, abs=0.004)


def test_a_bias_is_a_flat_tail_that_is_distinguished_from_the_slope() -> None:
    curve = curve_of("method", runs(1.0, 0.02))
    assert curve.is_biased
    assert curve.bias.low < 0.02 < curve.bias.high
    assert curve.points[-1].error.value == pytest.approx(math.hypot(0.02, 1 / 90.5), rel=0.02)
    assert curve.slope is not None
    assert curve.slope.value == pytest.approx(-0.5, abs=0.05), "where noise rules"


def test_a_curve_that_is_all_bias_has_no_slope() -> None:
    assert curve_of("method", runs(0.1, 0.3)).slope is None


def test_time_to_an_error_is_read_off_the_curve() -> None:
    curve = curve_of("method", runs(1.0, 0.0, scatter=1e-6))
    assert curve.milliseconds_to(0.1) == near(100, measured=True)
    assert curve.milliseconds_to(0.001) == near(1e6, measured=False)
    assert curve.milliseconds_to(2.0) == near(1, measured=True)


def test_a_biased_method_never_reaches_less_than_its_bias() -> None:
    curve = curve_of("method", runs(1.0, 0.05, scatter=1e-6))
    assert curve.milliseconds_to(0.04) is None
    assert curve.milliseconds_to(0.1) == near(1 / (0.1**2 - 0.05**2), measured=True)


def test_a_bias_that_the_reference_may_have_made_is_not_seen() -> None:
    assert curve_of("method", runs(1.0, 0.05), least_bias=0.04).seen_bias > 0.045
    doubtful = curve_of("method", runs(1.0, 0.05), least_bias=0.06)
    assert doubtful.seen_bias == 0
    assert doubtful.bias.high == 0.06


def test_points_are_medians_with_quartiles() -> None:
    looks = [Run("m", [Look(1, seconds, 0.01)], 0.0) for seconds in (1.0, 2.0, 3.0, 4.0, 50.0)]
    [point] = curve_of("m", looks).points
    assert point.milliseconds == (3000, 2000, 4000)


def test_flip_is_the_mean_of_the_rounds_that_asked() -> None:
    looks = [Run("m", [Look(1, 1.0, 0.01, flip)], 0.0) for flip in (0.2, None, 0.3)]
    assert curve_of("m", looks).points[0].flip == pytest.approx(0.25)
    assert curve_of("m", [looks[1]]).points[0].flip is None


def test_the_front_is_what_nothing_beats() -> None:
    draw = np.random.default_rng(2)
    points = [tuple(pair) for pair in np.round(draw.random((200, 2)), 2).tolist()]
    beaten = [any(q != p and q[0] <= p[0] and q[1] <= p[1] for q in points) for p in points]
    found = front(points)
    assert {points[i] for i in found} == {p for p, b in zip(points, beaten, strict=True) if not b}
    assert [points[i] for i in found] == sorted({points[i] for i in found})


def test_intervals_hold_the_truth_nineteen_times_of_twenty() -> None:
    """2000 intervals of 5 normal numbers: 95 % +- 0.5 % hold the mean.

    The test allows 4 standard deviations.
    """
    draw = np.random.default_rng(7)
    held = [
        interval.low <= 3.0 <= interval.high
        for interval in (mean_interval(draw.normal(3.0, 2.0, 5).tolist()) for _ in range(2000))
    ]
    assert np.mean(held) == pytest.approx(0.95, abs=0.02)


def test_one_round_knows_no_interval() -> None:
    assert mean_interval([1.0]) == (1.0, -math.inf, math.inf)
    assert squared_interval([-1e-6, 1e-6]).low == 0
