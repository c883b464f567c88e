"""The state of a film in addition to its mean: a render continues from it to the same bits.

An EXR file holds mean and standard error. From these alone the variance follows to a few units in
the last place. Channels of their own hold these units. Dropped samples and an incomplete
observation are rarer, and have channels only where they occur.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.image import group_channels
from glrt.image.allotment import NO_COUNTS, NO_SHARES, Counts
from glrt.image.group_channels import NO_GROUPS

Array = NDArray[np.float32]
Channels = dict[str, NDArray[Any]]

VARIANCE, PART = "film.variance", "film.part"
DROPPED, MISSING, BEGUN = "film.dropped", "film.missing", "film.begun"
COUNTS, SHARES = "counts", "film.shares"  # of pixels with counts of their own


class FilmState(NamedTuple):
    """The state of each pixel of a film; arrays (H, W) float32, or as noted."""

    variance: Array  # (H, W, 3): variance of one observation
    dropped: Array  # samples that were not finite
    observations: Array  # complete ones
    part: Array  # (H, W, 3): mean of the finite samples of the incomplete observation
    begun: Array  # number of those samples
    groups: Array = NO_GROUPS  # (groups, H, W, 4): mean and finite samples, of shared numbers
    counts: Counts = NO_COUNTS  # samples taken, where pixels have counts of their own, int32
    shares: Array = NO_SHARES  # of pixels in further samples, then


def empty_state(height: int, width: int, groups: int = 0) -> FilmState:
    """A state of zeros, which takes no memory until it is written."""
    pixels, colors = (height, width), (height, width, 3)
    shapes = colors, pixels, pixels, colors, pixels
    empty = np.zeros((groups, height, width, 4), np.float32) if groups else NO_GROUPS
    variance, dropped, observations, part, begun = (np.zeros(it, np.float32) for it in shapes)
    return FilmState(variance, dropped, observations, part, begun, empty)


def keep(film: FilmState, rows: slice, part: FilmState) -> None:
    """Copy `part` to some rows; arrays of zeros are skipped, so that rare values take no memory."""
    for array, band in zip(film[:5], part[:5], strict=True):
        if band.any():
            array[rows] = band
    if len(film.groups):
        film.groups[:, rows] = part.groups


def error_of_mean(
    mean: Array, variance: Array, observations: Array, part: Array, share: Array
) -> Array:
    """Standard error of each pixel's mean, (H, W, 3) float32; NaN below two observations.

    The mean M of k complete observations has the variance V = v / (k - 1), where v is their
    variance about M. An incomplete observation P, a share a of the samples, has another variance,
    since Sobol's points are worth more together: (P - M)^2 - V is an unbiased estimate of it. So
    the mean (1 - a) M + a P has the variance (1 - a)^2 V + a^2 ((P - M)^2 - V).
    """
    count, a = observations[..., None], share[..., None]
    with np.errstate(divide="ignore", invalid="ignore"):
        squares = variance / (count - 1)
        if share.any():
            apart = (part - mean) / (1 - a)
            squares = np.maximum(1 - 2 * a, 0) * squares + np.square(a * apart)
        error = np.sqrt(squares)
    return np.where(count >= 2, error, np.float32(np.nan)).astype(np.float32)


def to_channels(film: FilmState, stderr: Array, samples: int, block: int) -> Channels:
    """The state as channels for `from_channels`; `block` is the number of samples per observation.

    Arrays are (H, W, 3) and (H, W), in float32 and uint32.
    """
    is_shared = len(film.groups) > 0
    is_whole = is_shared or film.counts.size > 0 or samples % block == 0
    counted = film.counts if film.counts.size else samples
    observations = 0 if is_shared else counted // block
    folded = np.empty(stderr.shape, np.int32)
    for row, kept in enumerate(folded):
        near = _variance(stderr[row], film.observations[row], is_whole)
        units = film.variance[row].view(np.int32) - near.view(np.int32)
        kept[:] = (units << 1) ^ (units >> 31)  # 0, -1, 1, -2 as 0, 1, 2, 3: most bits are 0
    channels: Channels = {VARIANCE: folded.view(np.uint32)}
    counts = {DROPPED: film.dropped, MISSING: observations - film.observations}
    channels |= {name: c.astype(np.uint32) for name, c in counts.items() if c.any()}
    channels |= group_channels.to_channels(film.groups, samples, block)
    if film.counts.size:
        channels |= {COUNTS: film.counts.astype(np.uint32), SHARES: film.shares}
    return channels if is_whole else channels | {PART: film.part, BEGUN: film.begun}


def from_channels(
    channels: Mapping[str, NDArray[Any]],
    stderr: Array,
    samples: int,
    block: int,
    groups: int = 0,
) -> FilmState | None:
    """Read what `to_channels` has written; None if a channel is missing or has another size.

    `channels` are planes (H, W), such as `film.variance.R` and `film.dropped`. Where pixels share
    numbers, there are so many `groups`.
    """
    size, is_shared = stderr.shape[:2], groups > 0
    planes = {name: plane for name, plane in channels.items() if plane.shape == size}
    counts, shares = NO_COUNTS, NO_SHARES
    if COUNTS in planes and SHARES in planes:
        counts, shares = planes[COUNTS].astype(np.int32), planes[SHARES].astype(np.float32)
    is_whole = is_shared or counts.size > 0 or samples % block == 0
    none = np.zeros(size, np.float32)
    dropped, missing = (planes.get(name, none).astype(np.float32) for name in (DROPPED, MISSING))
    complete = 0 if is_shared else (counts if counts.size else samples) // block
    observations = np.asarray(complete, np.float32) - missing
    folded, part = _stacked(planes, VARIANCE), _stacked(planes, PART)
    begun = planes.get(BEGUN)
    if is_whole:
        part, begun = np.zeros_like(stderr), none
    means = group_channels.from_channels(planes, size, samples, groups, block)
    if folded is None or folded.dtype != np.uint32 or part is None or begun is None:
        return None
    if means is None:
        return None
    units = (folded >> 1).view(np.int32) ^ -(folded & 1).view(np.int32)
    near = _variance(stderr, observations, is_whole).view(np.int32)
    variance = (near + units).view(np.float32)
    return FilmState(variance, dropped, observations, part, begun, means, counts, shares)


def _variance(stderr: Array, observations: Array, is_whole: bool) -> Array:
    """Variance of one observation, v = e^2 (k - 1), to the rounding of float32.

    It is computed in float32 step by step, so that it is the same on every machine. It is 0 where
    the error does not determine it: with fewer than two observations, or with an incomplete one.
    """
    count = observations[..., None]
    with np.errstate(over="ignore", invalid="ignore"):
        variance = stderr * stderr * (count - np.float32(1))
    return np.where(is_whole & (count >= 2), variance, np.float32(0)).astype(np.float32)


def _stacked(planes: Mapping[str, NDArray[Any]], layer: str) -> NDArray[Any] | None:
    names = [f"{layer}.{channel}" for channel in "RGB"]
    if not all(name in planes for name in names):
        return None
    return np.stack([planes[name] for name in names], axis=-1)
