"""What a second of rendering buys: one renderer against another, from many short renders.

Time to an error = relative variance of a sample x seconds a sample / error^2. Its two factors are
told apart. Renders of both take turns, so a ratio is that of two renders of one round; intervals
come from drawing rounds anew (bootstrap).
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.error.estimate import DARK

Array = NDArray[np.float64]

REDRAWN = 2000  # times that rounds are drawn anew
TAILS = (2.5, 97.5)  # of a 95 % interval, in percent


@dataclass(frozen=True, eq=False)
class Runs:
    """The renders of one renderer and scene, one a round, each with its own random numbers."""

    renderer: str
    samples: int  # a pixel, of each render
    seconds: Array  # (rounds,)
    pictures: NDArray[np.float32]  # (rounds, H, W, 3)

    @property
    def mean(self) -> Array:
        """Of all pictures, (H, W, 3)."""
        mean: Array = self.pictures.mean(axis=0, dtype=np.float64)
        return mean

    @property
    def rates(self) -> Array:
        """Pixel samples a second, of each round."""
        height, width = self.pictures.shape[1:3]
        return np.asarray(width * height * self.samples / self.seconds)

    def variances(self, level: Array) -> Array:
        """Relative variance of one sample, of each round; its mean is without bias.

        `level`, (H, W, 3), is the picture with hardly any noise, by which variance becomes
        relative, as in `relative_error`. It must be another render than these: a level
        that shares their hits makes them look small. But the variance is about their own mean.
        """
        scale = np.square(level) + DARK * level.mean() ** 2
        rounds, mean = len(self.seconds), self.mean
        squares = [np.mean(np.square(picture - mean) / scale) for picture in self.pictures]
        return np.array(squares) * self.samples * rounds / (rounds - 1)


class Factor(NamedTuple):
    """How many times better, with a 95 % interval."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.2f} ({self.low:.2f}-{self.high:.2f})"


class Lead(NamedTuple):
    """How far one renderer is ahead of another; above 1 it is."""

    time: Factor  # to the same error: rate x variance
    rate: Factor  # samples a second
    variance: Factor  # of one sample, the other's over its own


def seconds_to(error: float, runs: Runs, level: Array) -> float:
    """How long the picture takes to a relative RMS error."""
    height, width = level.shape[:2]
    variance = runs.variances(level).mean()
    return float(variance / error**2 * width * height / np.median(runs.rates))


def lead_of(ours: Runs, theirs: Runs, level: Array) -> Lead:
    """How far `ours` is ahead; both were rendered in the same rounds."""
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
