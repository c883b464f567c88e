"""Whether an estimated error can be trusted: whether parts of a render agree with it.

A pixel that no rare bright sample has met does not know of them, and the error of one that has
been met is divided by its own brightness. So the estimate is too small under fireflies. But two
parts of the samples disagree where a firefly met only one of them, and the other one tells how
bright the pixel is without.
"""

import math

import numpy as np
from numpy.typing import NDArray

from glrt.error.estimate import DARK

Pixels = NDArray[np.float32]

DOUBTFUL = 2.0  # times the estimate: docs/results/stress.md
# Pixels without a vote, those that differ most: one at the rim of a lamp may see it in one part
# alone, which says nothing of the rest.
MUTE_SHARE, MUTE_LEAST = 1e-3, 3


def error_ratio(
    part: Pixels, part_samples: int, whole: Pixels, samples: int, estimate: float | None
) -> float | None:
    """The error that two parts of a render show, in that which it estimates.

    `part`: radiance, (H, W, 3), after the first `part_samples` of the `samples` of `whole`; the
    other part is the rest. The error is relative to the darker of the two in each pixel. About 1 if
    the noise is normal. None where there is no rest or no estimate.
    """
    if not estimate or not 0 < part_samples < samples:
        return None
    share = part_samples / samples
    all_, first = whole.astype(np.float64), part.astype(np.float64)
    rest = (all_ - share * first) / (1 - share)
    variance = share * (1 - share) * np.square(first - rest)  # of the whole, in expectation
    scale = np.square(np.minimum(first, rest)) + DARK * all_.mean() ** 2
    terms = (variance / scale).mean(axis=-1).ravel()
    mute = min(max(MUTE_LEAST, math.ceil(MUTE_SHARE * terms.size)), terms.size - 1)
    heard = np.partition(terms, terms.size - 1 - mute)[: terms.size - mute]
    return math.sqrt(heard.sum() / terms.size) / estimate


def doubt(error_ratio: float | None, wanted: float | None) -> str:
    """A paragraph where an error that was wanted is judged reached, but may not be; else ""."""
    if wanted is None or error_ratio is None or error_ratio < DOUBTFUL:
        return ""
    return (
        f"--error {wanted:g} may not be reached: parts of the samples differ {error_ratio:.2g} "
        "times as much as the estimated error says. A few samples carry much of the light "
        "(fireflies), and the estimate ignores the pixels that they missed. Use more --samples."
    )
