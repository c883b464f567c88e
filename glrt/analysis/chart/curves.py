"""Statistics of measured rounds: curves with 95 % intervals, slopes, bias, the Pareto front."""

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from glrt.analysis.chart.measure import Look, Round, Run, of_variant
from glrt.analysis.variants import LIVE

LEVELS = (0.1, 0.03, 0.01)  # relative errors at which methods are compared
# 97.5 % quantiles of Student's t for 1, 2, ... degrees of freedom.
_STUDENT = (12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179)
_LEAST_POINTS = 4  # of a fitted slope
_NOISE_OVER_BIAS = 3.0  # a slope is fitted where the error is more than this many times the bias


class Interval(NamedTuple):
    """An estimate with its 95 % confidence interval."""

    value: float
    low: float
    high: float


class Point(NamedTuple):
    """One point of a curve: median time with quartiles, error with its 95 % interval."""

    samples: int  # per pixel
    milliseconds: Interval  # median and quartiles, not a 95 % interval
    error: Interval  # relative RMS
    flip: float | None = None  # mean over the rounds in which it was computed


@dataclass(frozen=True)
class Curve:
    """Error against time of one variant, with slope and bias."""

    name: str
    points: tuple[Point, ...]
    slope: Interval | None  # of log error over log samples, where noise exceeds the bias
    bias: Interval  # relative RMS

    @property
    def is_rival(self) -> bool:
        """Whether its times are all that its pictures take: not so for live probes."""
        return self.name != LIVE

    @property
    def seen_bias(self) -> float:
        """The bias; 0 if its interval includes 0."""
        return self.bias.value if self.bias.low > 0 else 0.0

    @property
    def is_biased(self) -> bool:
        """Whether the bias is more than half of the error at the last point."""
        return self.seen_bias > 0.5 * self.points[-1].error.value

    def milliseconds_to(self, error: float) -> tuple[float, bool] | None:
        """Time to reach an error, and whether it was measured; None if the bias prevents it.

        Interpolated linearly in logarithms between two points. Beyond the last point the time is
        extrapolated: there the squared error without bias is taken to fall as 1 / time.
        """
        before = None
        for point in self.points:
            if point.error.value <= error:
                return _between(before, point, error), True
            before = point
        last = self.points[-1]
        noise = last.error.value**2 - self.seen_bias**2
        room = error**2 - self.seen_bias**2
        if room <= 0:
            return None
        return last.milliseconds.value * max(noise, 0.0) / room, False


def curves_of(rounds: Sequence[Round], least_bias: float = 0.0) -> list[Curve]:
    """A curve for each variant, in the order of the first round."""
    names = [run.variant for run in rounds[0]]
    return [curve_of(name, of_variant(rounds, name), least_bias) for name in names]


def curve_of(name: str, runs: Sequence[Run], least_bias: float = 0.0) -> Curve:
    """The curve of one variant over the numbers of samples that all its runs reached.

    The interval of a bias below `least_bias` is extended to 0, since such a bias may come from the
    noise of the reference.
    """
    shared = min(len(run.looks) for run in runs)
    bias = squared_interval([run.squared_bias for run in runs])
    if bias.value < least_bias:
        bias = Interval(bias.value, 0.0, max(bias.high, least_bias))
    columns = zip(*(run.looks[:shared] for run in runs), strict=True)
    points = [_point(looks) for looks in columns]
    seen = tuple(point for point in points if point.error.value > 0)
    return Curve(name, seen, _slope(runs, points, bias), bias)


def front(points: Sequence[tuple[float, float]]) -> list[int]:
    """Indices of the points (time, error) on the Pareto front, in the order of time."""
    best = math.inf
    places = []
    for place in sorted(range(len(points)), key=lambda i: points[i]):
        if points[place][1] < best:
            best = points[place][1]
            places.append(place)
    return places


def mean_interval(values: Sequence[float]) -> Interval:
    """Mean of independent values with Student's 95 % interval, infinite for a single value."""
    mean = statistics.fmean(values)
    if len(values) < 2:
        return Interval(mean, -math.inf, math.inf)
    freedom = len(values) - 1
    t = _STUDENT[freedom - 1] if freedom <= len(_STUDENT) else 2.0
    half = t * statistics.stdev(values) / math.sqrt(len(values))
    return Interval(mean, mean - half, mean + half)


def squared_interval(squares: Sequence[float]) -> Interval:
    """Root of the mean of unbiased estimates of a square, with its interval; 0 below 0."""
    return Interval(*(math.sqrt(max(value, 0.0)) for value in mean_interval(squares)))


def _point(looks: Sequence[Look]) -> Point:
    times = [1e3 * look.seconds for look in looks]
    quartiles = (
        statistics.quantiles(times, n=4, method="inclusive") if len(times) > 1 else 3 * times
    )
    time = Interval(statistics.median(times), quartiles[0], quartiles[2])
    error = squared_interval([look.squared_error for look in looks])
    flips = [look.flip for look in looks if look.flip is not None]
    return Point(looks[0].samples, time, error, statistics.fmean(flips) if flips else None)


def _slope(runs: Sequence[Run], points: Sequence[Point], bias: Interval) -> Interval | None:
    """Slope of log error over log samples by least squares; None with fewer than _LEAST_POINTS.

    Its interval is Student's over jackknife pseudovalues, leaving out one run at a time. The mean
    of fits to single runs would be too flat, as they take logarithms of rare large errors.
    """
    floor = bias.value if bias.low > 0 else 0.0
    places = [i for i, p in enumerate(points) if p.error.value > max(_NOISE_OVER_BIAS * floor, 0.0)]
    if len(places) < _LEAST_POINTS:
        return None
    samples = np.log([points[place].samples for place in places])
    squares = np.array([[run.looks[place].squared_error for place in places] for run in runs])
    count = len(runs)
    means = [squares.mean(axis=0)]
    if count > 1:
        means += [np.delete(squares, left_out, axis=0).mean(axis=0) for left_out in range(count)]
    if np.min(means) <= 0:
        return None
    whole, *others = (float(np.polyfit(samples, 0.5 * np.log(mean), 1)[0]) for mean in means)
    return mean_interval([count * whole - (count - 1) * other for other in others] or [whole])


def _between(before: Point | None, after: Point, error: float) -> float:
    """Milliseconds to an error between two points, interpolated linearly in logarithms."""
    if before is None:
        return after.milliseconds.value
    (t0, e0), (t1, e1) = (
        (math.log(point.milliseconds.value), math.log(point.error.value))
        for point in (before, after)
    )
    share = (e0 - math.log(error)) / (e0 - e1)
    return math.exp(t0 + share * (t1 - t0))
