"""Ratios of times from interleaved rounds of two programs: medians with 95 % intervals.

For one scene the interval is between two order statistics of the ratios, which contain the true
median with a probability of at least 95 % for any distribution. Over several scenes the ratio is
the geometric mean of their medians, with an interval from the bootstrap over the rounds of each
scene, so that disturbed rounds of a scene do not give it more weight.
"""

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

CONFIDENCE = 0.95
LEAST_ROUNDS = 6  # with fewer, not even smallest and largest ratio give a 95 % interval
TOLERATED = 1.03  # ratio below which a program does not count as slower
REDRAWN = 4000  # bootstrap resamples

Verdict = Literal["no slower", "slower", "not decided: more rounds"]


class Ratio(NamedTuple):
    """A ratio of times with its 95 % interval."""

    value: float
    low: float
    high: float

    @property
    def verdict(self) -> Verdict:
        """The conclusion from the interval."""
        if self.high < TOLERATED:
            return "no slower"
        return "slower" if self.low > 1 else "not decided: more rounds"

    def __str__(self) -> str:
        return f"{self.value:.3f} ({self.low:.3f}-{self.high:.3f})"


def ratio_of(these: Sequence[float], others: Sequence[float]) -> Ratio:
    """Median ratio of the times of two programs in one scene; both hold one time per round."""
    ratios = np.sort(np.divide(these, others))
    rank = rank_of(len(ratios))
    return Ratio(float(np.median(ratios)), float(ratios[rank - 1]), float(ratios[-rank]))


def rank_of(rounds: int) -> int:
    """The largest k for which the k-th smallest and k-th largest value contain the true median.

    They do with a probability of at least CONFIDENCE: the number of `rounds` values below the
    median is binomial with probability 1/2, and they fail if fewer than k values are on one side.
    Raises ValueError with fewer than LEAST_ROUNDS.
    """
    chances = np.cumsum([math.comb(rounds, k) / 2**rounds for k in range(rounds)])
    rank = int(np.searchsorted(chances, (1 - CONFIDENCE) / 2, side="right"))
    if rank < 1:
        raise ValueError(f"{rounds} rounds are too few for an interval: {LEAST_ROUNDS} or more")
    return rank


def ratio_over(scenes: Sequence[tuple[Sequence[float], Sequence[float]]]) -> Ratio:
    """Geometric mean of the ratios of several scenes, from the times of both programs in each."""
    rng = np.random.default_rng(0)
    medians, redrawn = [], []
    for these, others in scenes:
        logs = np.log(np.divide(these, others))
        draws = rng.integers(len(logs), size=(REDRAWN, len(logs)))
        medians.append(np.median(logs))
        redrawn.append(np.median(logs[draws], axis=1))
    tail = 50 * (1 - CONFIDENCE)  # percent
    low, high = np.exp(np.percentile(np.mean(redrawn, axis=0), (tail, 100 - tail)))
    return Ratio(float(np.exp(np.mean(medians))), float(low), float(high))
