"""Whether an estimated error can be believed: not if it depends on pixels that few samples lit.

A pixel that one bright sample has met has a standard error as large as its radiance, whatever that
sample brought. Next to a pixel as bright, its relative error is estimated as 1 (`squared_levels`).
If so bright a sample is much rarer than one in the samples that were taken, the true radiance is
far below, and the true error far above.

So each pixel was lit by h = (radiance / stderr)^2 equal samples, or is as noisy as if it were. The
number l expected of them has the density l^(h - 1) exp(-l) if a neighbour is certainly half as
bright, as at the rim of a lamp. Else the density is divided by sqrt(l), since light that is far
brighter than all around it is rare. A pixel f times as bright as it should be has l = h / f.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt.error.brightest_neighbour import brightest_around
from glrt.error.estimate import BAND, DARK, estimated_error, squared_levels
from glrt.error.seen_lamps import Seen

Pixels = NDArray[np.float32]
Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

LEAST_OBSERVATIONS = 4  # fewer do not determine a standard error
TIMES = 3.0  # the true error over the estimate, where luck decides
KNOWN_TIMES = 2.0  # the same, where the truth of its pixels is known
DOUBTFUL = 0.05  # chance of that, from which on the error is doubted: docs/results/stress.md
TOGETHER = (1, 4, 16, 64, 256)  # numbers of pixels that may cause it together
SURE = 100  # hits: with more a pixel is known


def is_doubtful(
    radiance: ArrayLike, stderr: ArrayLike, observations: int, seen: Seen | None = None
) -> bool | None:
    """Whether the estimated error of a picture, (H, W, 3) each, is doubtful.

    It is if for some k there is a chance of DOUBTFUL that k pixels are too bright, by so much that
    together they make the error TIMES as large. It also is if the pixels in `seen`, whose truth is
    known, make it KNOWN_TIMES as large by themselves. None if that cannot be judged: below four
    observations, without an estimate, or without noise or light.
    """
    error = estimated_error(radiance, stderr) if observations >= LEAST_OBSERVATIONS else None
    if not error or not math.isfinite(error):
        return None
    values, errors = np.asarray(radiance, np.float32), np.asarray(stderr, np.float32)
    total = values[..., 0].size * error**2
    room = (TIMES**2 - 1) * total
    if seen is not None and seen.rows.size:
        excess = _excess(values, errors, seen)
        if excess >= (KNOWN_TIMES**2 - 1) * total:
            return True
        room -= excess
        errors = errors.copy()
        errors[seen.rows, seen.columns] = 0  # no chance is left there
    found = _unsure(values, errors)
    return any(_chance(found, room, k) >= DOUBTFUL for k in TOGETHER)


def _excess(values: Pixels, errors: Pixels, seen: Seen) -> float:
    """Sum over `seen` pixels of true less estimated squared errors, averaged over channels."""
    value = values[seen.rows, seen.columns].astype(np.float64)
    apart, variance = value - seen.radiance, np.square(errors[seen.rows, seen.columns], dtype=float)
    mean = values.mean(dtype=np.float64)
    true_mean = max(mean - apart.sum() / values.size, 0.0)
    true = np.square(apart) / (np.square(seen.radiance) + DARK * true_mean**2)
    places = zip(seen.rows, seen.columns, strict=True)
    levels = np.array([_squared_level(values, errors, *place) for place in places])
    estimated = variance / (levels + DARK * mean**2)
    excess: float = (true - estimated).sum() / values.shape[2]
    return excess


def _squared_level(values: Pixels, errors: Pixels, row: int, column: int) -> Array:
    """`squared_levels` of one pixel, (channels,)."""
    top, left = max(row - 1, 0), max(column - 1, 0)
    about = slice(top, row + 2), slice(left, column + 2)
    return np.asarray(squared_levels(values[about], errors[about])[row - top, column - left])


class Unsure(NamedTuple):
    """The values of a picture that few samples lit, (n,) each, of all `channels`."""

    most: Array  # squared relative error if the truth is as dark as the darkest neighbour
    share: Array  # squared relative error, as estimated
    hits: Array
    shape: Array  # of the gamma distribution of the number expected
    log_gamma: Array  # of shape + 1
    channels: int


def _chance(found: Unsure, room: float, together: int) -> float:
    """The chance that `together` pixels add `room` to the sum of squared relative errors.

    A pixel adds its part of `room` if its squared relative error exceeds the estimate by that much.
    For this a neighbour must be dark enough.
    """
    bound = room / together + found.share
    places = found.most > bound
    hits, shape, log_gamma = (part[places] for part in found[2:5])
    limit = hits / (1 + np.sqrt(bound[places]))
    expected = float(_below(limit, shape, log_gamma).sum()) / found.channels
    if expected == 0 or expected >= together:
        return float(expected > 0)
    # A Poisson number is at least k as often as a gamma number of shape k is below its mean.
    one = (np.array([x]) for x in (expected, float(together), math.lgamma(together + 1)))
    return float(_below(*one)[0])


def _below(limit: Array, shape: Array, log_gamma: Array) -> Array:
    """The chance that a gamma-distributed number of such a shape is below `limit` < shape.

    An upper bound: the first terms of its series, and a geometric series above the rest.
    """
    series = 1 + limit / (shape + 1) / (1 - limit / (shape + 2))
    first = np.exp(shape * np.log(limit) - limit - log_gamma)
    return np.asarray(np.minimum(first * series, 1.0))


def _unsure(values: Pixels, errors: Pixels) -> Unsure:
    """Collect the values that few samples lit, some rows at a time."""
    height, width, channels = values.shape
    rows = max(1, BAND // (width * channels))
    parts = [_of_rows(values, errors, top, top + rows) for top in range(0, height, rows)]
    squares, levels, hits, darkest, is_rim = (
        np.concatenate(part) for part in zip(*parts, strict=True)
    )
    shape = np.maximum(np.where(is_rim, hits, hits - 0.5), 0.5)
    log_gamma = np.array([math.lgamma(value + 1) for value in shape])
    mean = float(values.mean(dtype=np.float64))
    dark = DARK * mean**2
    share, most = squares / hits / (levels + dark), squares / (np.square(darkest) + dark)
    return Unsure(most, share, hits, shape, log_gamma, channels)


def _of_rows(
    values: Pixels, errors: Pixels, top: int, end: int
) -> tuple[Array, Array, Array, Array, Mask]:
    """Values in rows that few samples lit: squares, levels, hits, darkest neighbours, is rim."""
    value, error = (part[top:end].astype(np.float64) for part in (values, errors))
    places = (error > 0) & (value > 0) & (value**2 < SURE * error**2)
    about = slice(max(top - 1, 0), end + 1)
    certain, darkest = (
        brightest_around(part)[min(top, 1) :][: len(value)]
        for part in (values[about] - errors[about], -values[about])
    )
    squares = np.square(value[places])
    levels = squared_levels(values, errors, slice(top, end))[places]
    hits = squares / np.square(error[places])
    darkest = np.clip(np.where(np.isinf(darkest), 0.0, -darkest)[places], 0.0, value[places])
    return squares, levels, hits, darkest, certain[places] > 0.5 * value[places]
