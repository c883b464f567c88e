"""z-tests: whether means differ from their truths by more than their standard errors explain."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt.error.estimate import sidak_threshold


def p_value(z: float) -> float:
    """Two-sided: how often a standard normal number lies at least |z| from 0, erfc(|z| / sqrt(2)).

    By `erfc` in float64: 1 - cdf would lose every digit where many tests put the threshold.
    """
    return math.erfc(abs(z) / math.sqrt(2))


@dataclass(frozen=True)
class ZTest:
    """The verdict of `z_test`; `str` of it explains a failed assertion."""

    z: float  # of the worst value, with its sign
    p: float  # two-sided, of the worst value alone
    threshold: float  # Sidak-corrected: p below it fails
    tests: int

    @property
    def passed(self) -> bool:
        """Whether chance alone explains the worst value."""
        return self.p >= self.threshold

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        return (
            f"worst z {self.z:.2f} of {self.tests}: p {self.p:.3g}, threshold {self.threshold:.3g}"
        )


def z_scores(
    mean: ArrayLike, stderr: ArrayLike, truth: ArrayLike, floor: float = 0.0
) -> NDArray[np.float64]:
    """(mean - truth) / max(stderr, floor), broadcast; where that is 0/0, the score is 0.

    `floor` covers what `stderr` does not know, such as float32 rounding. A noisy truth adds its
    own: pass `np.hypot(stderr, stderr_of_truth)`. Raises ValueError for NaN and infinities: a
    comparison with NaN, or an infinite `stderr`, would pass in silence.
    """
    difference = np.asarray(mean, np.float64) - np.asarray(truth, np.float64)
    spread = np.maximum(np.asarray(stderr, np.float64), floor)
    difference, spread = np.broadcast_arrays(difference, spread)
    if not (np.isfinite(difference).all() and np.isfinite(spread).all()):
        raise ValueError("NaN or infinity in a z-test: too few observations, or a broken mean")
    scores = np.where(difference == 0, 0.0, np.copysign(np.inf, difference))
    return np.divide(difference, spread, out=scores, where=spread > 0)


def z_test(
    mean: ArrayLike, stderr: ArrayLike, truth: ArrayLike, alpha: float = 1e-3, floor: float = 0.0
) -> ZTest:
    """Test every value against its truth; all together fail by chance with probability `alpha`.

    The arguments are those of `z_scores`. True in a condition if the test passed.
    """
    scores = z_scores(mean, stderr, truth, floor).ravel()
    worst = float(scores[np.abs(scores).argmax()])
    return ZTest(worst, p_value(worst), sidak_threshold(alpha, scores.size), scores.size)
