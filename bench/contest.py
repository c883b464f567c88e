"""Efficiency of one renderer against another, from many short interleaved renders.

Time to an error = relative variance of one sample x seconds per sample / error^2; variance and
speed are reported separately, too. Ratios are of two renders of the same round, and intervals are
from the bootstrap over rounds.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.error.estimate import DARK

Array = NDArray[np.float64]

REDRAWN = 2000  # bootstrap resamples
TAILS = (2.5, 97.5)  # percentiles at the ends of a 95 % interval


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


def lead_of(ours: Runs, theirs: Runs, level: Array) -> Lead:
    """The factors by which `ours` is better; both were rendered in the same rounds."""
    ratios = ours.rates / theirs.rates
    a, b = ours.variances(level), theirs.variances(level)
    draws = np.random.default_rng(0).integers(len(ratios), size=(REDRAWN, len(ratios)))
    rate, rates = np.median(ratios), np.median(ratios[draws], axis=1)
    variance, variances = b.mean() / a.mean(), b[draws].mean(axis=1) / a[draws].mean(axis=1)
    return Lead(
        time=_factor(rate * variance, rates * variances),
        rate=_factor(rate, rates),
        variance=_factor(variance, variances),
    )


def _factor(value: Any, redrawn: Array) -> Factor:
    low, high = np.percentile(redrawn, TAILS)
    return Factor(float(value), float(low), float(high))
