"""Ratios of times from rounds that ran two programs each: medians with 95 % intervals.

Of one scene the interval is that of order statistics: two of the sorted ratios, between which the
true median lies in 95 % of cases or more, whatever their distribution. Over all scenes it is the
geometric mean of the scenes' medians, and its interval comes from drawing the rounds of each scene
anew (bootstrap): so a scene that is disturbed in some rounds counts no more than another.
"""

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

CONFIDENCE = 0.95
LEAST_ROUNDS = 6  # of fewer, not even the smallest and the largest ratio make such an interval
TOLERATED = 1.03  # times as long: less than this is no loss worth a look
REDRAWN = 4000  # times that rounds are drawn anew

Verdict = Literal["no slower", "slower", "not decided: more rounds"]


class Ratio(NamedTuple):
    """How many times as long, with a 95 % interval."""

    value: float
    low: float
    high: float

    @property
    def verdict(self) -> Verdict:
        """What the interval decides."""
        if self.high < TOLERATED:
            return "no slower"
        return "slower" if self.low > 1 else "not decided: more rounds"

    def __str__(self) -> str:
        return f"{self.value:.3f} ({self.low:.3f}-{self.high:.3f})"


def ratio_of(these: Sequence[float], others: Sequence[float]) -> Ratio:
    """Of the times of one scene, one of each program a round."""
    ratios = np.sort(np.divide(these, others))
    rank = rank_of(len(ratios))
    return Ratio(float(np.median(ratios)), float(ratios[rank - 1]), float(ratios[-rank]))


def rank_of(rounds: int) -> int:
    """The k of which the k-th smallest and k-th largest of so many values hold the median.

    The number of values below the median is binomial with chance 1/2: the two fail to hold it
    where fewer than k of the values lie on one side.
    """
    chances = np.cumsum([math.comb(rounds, k) / 2**rounds for k in range(rounds)])
    rank = int(np.searchsorted(chances, (1 - CONFIDENCE) / 2, side="right"))
    if rank < 1:
        raise ValueError(f"{rounds} rounds are too few for an interval: {LEAST_ROUNDS} or more")
    return rank


def ratio_over(scenes: Sequence[tuple[Sequence[float], Sequence[float]]]) -> Ratio:
    """Of all scenes, from the times of both programs in each."""
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
