"""Halves of a known picture: observations with noise of a known variance."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.denoise.half import Guide, Half

Floats = NDArray[np.float64]


class Drawn(NamedTuple):
    """Two halves, and what they are halves of."""

    halves: tuple[Half, Half]
    truth: Floats
    variances: tuple[Floats, Floats]  # of the means, as they really are


def truth_with_an_edge(size: int = 24) -> Floats:
    """Bright on the left, dark on the right, a slope down; (size, size, 3)."""
    down, right = np.mgrid[:size, :size] / size
    gray = np.where(right < 0.5, 1.0, 0.3) + 0.2 * down
    return np.stack([gray, 0.5 * gray, 0.8 * gray], axis=-1)


def drawn(
    rng: np.random.Generator,
    truth: Floats,
    counts: tuple[int, int] = (4, 4),
    guide: Floats | None = None,
) -> Drawn:
    """Observations have a gamma distribution of shape 2: skewed, as light is. None is negative.

    `counts`: observations in each half. `guide` is free of noise; without it there is none.
    """
    flat = Guide(*np.zeros((2, *truth.shape), np.float32))
    known = flat if guide is None else Guide(guide.astype(np.float32), flat.variance)
    found, variances = [], []
    for count in counts:
        seen = rng.gamma(2.0, truth / 2, size=(count, *truth.shape))
        mean = seen.mean(axis=0, dtype=np.float64).astype(np.float32)
        variance = (seen.var(axis=0, ddof=1) / count).astype(np.float32)
        found.append(Half(mean, variance, count / sum(counts), known, known))
        variances.append(truth**2 / 2 / count)
    return Drawn((found[0], found[1]), truth, (variances[0], variances[1]))
