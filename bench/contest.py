"""Efficiency of one renderer against another, from interleaved renders.

Time to an error = relative variance of one sample x seconds per sample / error^2; variance and
speed are reported separately, too. Ratios are of two renders of the same round, and intervals are
from the bootstrap over rounds; over several scenes, over the scenes and the rounds of each.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.error.estimate import DARK

Array = NDArray[np.float64]

REDRAWN = 2000  # bootstrap resamples
TAILS = (2.5, 97.5)  # percentiles at the ends of a 95 % interval
WIDE_TAILS = (0.5, 99.5)  # of a 99 % interval, by which a slope is judged
SLOPE = -0.5  # of the logarithm of the error over that of the samples: error ~ t^-1/2


@dataclass(frozen=True, eq=False)
class Runs:
    """The renders of one renderer and scene, one per round, each with its own seed."""

    renderer: str
    samples: int  # per pixel, of each render
    seconds: Array  # (rounds,)
    pictures: NDArray[np.float32]  # (rounds, H, W, 3)

    @property
    def mean(self) -> Array:
        """The mean of all pictures, (H, W, 3)."""
        mean: Array = self.pictures.mean(axis=0, dtype=np.float64)
        return mean

    @property
    def rates(self) -> Array:
        """Pixel samples per second in each round, (rounds,)."""
        height, width = self.pictures.shape[1:3]
        return np.asarray(width * height * self.samples / self.seconds)

    def variances(self, level: Array) -> Array:
        """Relative variance of one sample from each round, (rounds,); the mean is unbiased.

        `level`, (H, W, 3), is a picture with little noise, to which the variance is relative as in
        `relative_error`. It must be independent of these renders: sharing their bright samples, it
        would reduce the result. The variance itself is taken about their own mean.
        """
        scale = np.square(level) + DARK * level.mean() ** 2
        rounds, mean = len(self.seconds), self.mean
        squares = [np.mean(np.square(picture - mean) / scale) for picture in self.pictures]
        return np.array(squares) * self.samples * rounds / (rounds - 1)


class Factor(NamedTuple):
    """An improvement as a factor, with a 95 % interval."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.2f} ({self.low:.2f}-{self.high:.2f})"


class Lead(NamedTuple):
    """Factors by which one renderer is better than another; above 1, it is."""

    time: Factor  # to the same error: rate x variance
    rate: Factor  # samples per second, its own over the other's
    variance: Factor  # of one sample, the other's over its own


def seconds_to(error: float, runs: Runs, level: Array) -> float:
    """Seconds that a picture takes to reach a relative RMS error."""
    height, width = level.shape[:2]
    variance = runs.variances(level).mean()
    return float(variance / error**2 * width * height / np.median(runs.rates))


class Redrawn(NamedTuple):
    """The factor of time to the same error, and what the bootstrap makes of it."""

    value: float
    values: Array  # (REDRAWN,)

    @property
    def factor(self) -> Factor:
        """With its interval."""
        return _factor(self.value, self.values)


def lead_of(ours: Runs, theirs: Runs, level: Array) -> Lead:
    """The factors by which `ours` is better; both were rendered in the same rounds."""
    rate, variance = _redrawn(ours, theirs, level)
    return Lead(
        time=_factor(rate.value * variance.value, rate.values * variance.values),
        rate=rate.factor,
        variance=variance.factor,
    )


def time_lead_of(ours: Runs, theirs: Runs, level: Array) -> Redrawn:
    """The factor of time of `lead_of`."""
    rate, variance = _redrawn(ours, theirs, level)
    return Redrawn(rate.value * variance.value, rate.values * variance.values)


def _redrawn(ours: Runs, theirs: Runs, level: Array) -> tuple[Redrawn, Redrawn]:
    """The factors of rate and of variance, from the same rounds in each resample."""
    ratios = ours.rates / theirs.rates
    a, b = ours.variances(level), theirs.variances(level)
    draws = np.random.default_rng(0).integers(len(ratios), size=(REDRAWN, len(ratios)))
    rates = np.median(ratios[draws], axis=1)
    variances = b[draws].mean(axis=1) / a[draws].mean(axis=1)
    return (
        Redrawn(float(np.median(ratios)), rates),
        Redrawn(float(b.mean() / a.mean()), variances),
    )


def over_scenes(leads: Sequence[Redrawn]) -> Factor:
    """The geometric mean over scenes, which are drawn again in each resample, as rounds are."""
    rng = np.random.default_rng(0)
    logs = np.log([lead.values for lead in leads])
    scenes = rng.integers(len(leads), size=(REDRAWN, len(leads)))
    means = logs[scenes, rng.integers(REDRAWN, size=scenes.shape)].mean(axis=1)
    value = math.exp(np.mean(np.log([lead.value for lead in leads])))
    return _factor(value, np.exp(means))


class Slope(NamedTuple):
    """How the logarithm of the error changes with that of the samples, with a 99 % interval."""

    value: float
    low: float
    high: float

    @property
    def is_half(self) -> bool:
        """Whether the error may fall as t^-1/2."""
        return self.low <= SLOPE <= self.high

    def __str__(self) -> str:
        return f"{self.value:.2f} ({self.low:.2f} to {self.high:.2f})"


def slope_of(few: Runs, many: Runs, level: Array) -> Slope:
    """The slope between renders of few and of many samples, all of them independent."""
    rng = np.random.default_rng(0)
    errors = []  # of a render; first as measured, then redrawn
    for runs in (few, many):
        squares = runs.variances(level) / runs.samples
        draws = rng.integers(len(squares), size=(REDRAWN, len(squares)))
        errors.append(np.sqrt([squares.mean(), *squares[draws].mean(axis=1)]))
    value, *values = np.log(errors[1] / errors[0]) / math.log(many.samples / few.samples)
    low, high = np.percentile(values, WIDE_TAILS)
    return Slope(float(value), float(low), float(high))


def distance(a: Runs, b: Runs, level: Array) -> float:
    """The relative RMS difference of what two renderers converge to, less their noise."""
    scale = np.square(level) + DARK * level.mean() ** 2
    noise = sum(each.variances(level).mean() / each.samples / len(each.seconds) for each in (a, b))
    return math.sqrt(max(float(np.mean(np.square(a.mean - b.mean) / scale)) - noise, 0.0))


def _factor(value: Any, redrawn: Array) -> Factor:
    low, high = np.percentile(redrawn, TAILS)
    return Factor(float(value), float(low), float(high))
