"""How many samples each pixel of an adaptive picture gets, from the noise of its neighbours.

All pixels get the samples of a floor. Beyond it, samples go where the error is: the relative error
of a picture is least if counts are in proportion to standard deviations (Neyman, "On the Two
Different Aspects of the Representative Method", 1934).

If a pixel's own luck decided on its count, its mean would be biased. So groups of 8 pixels of a row
form a checkerboard of two halves, and the shares of a half follow from the floor of the other half
alone. Given the shares, the samples of a pixel are those of any render, whatever their number.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.error.estimate import DARK
from glrt.settings import Settings

Array = NDArray[np.float32]
Floats = NDArray[np.float64]
Counts = NDArray[np.int32]
Mask = NDArray[np.bool_]
Sizes = NDArray[np.int64]

NO_SHARES: Array = np.zeros((0, 0), np.float32)  # of a picture whose pixels have equal counts
NO_COUNTS: Counts = np.zeros((0, 0), np.int32)
FLOOR = 64  # samples that each pixel gets, and at least FLOOR_BLOCKS blocks
FLOOR_BLOCKS = 4
UNIT = 16  # samples that a pixel gets at a time, or one block if that is more
GROUP = 8  # pixels of a row that stay together, as they are traced together
REACH = 3  # pixels on each side of a window
LEAST, MOST = 0.25, 8.0  # shares, where 1 is the mean


def floor_of(settings: Settings) -> int:
    """Samples that each pixel gets before counts differ."""
    return max(FLOOR, FLOOR_BLOCKS * settings.block)


def unit_of(settings: Settings) -> int:
    """Samples that a pixel gets at a time: whole blocks."""
    return max(UNIT, settings.block)


def shares_of(mean: NDArray[Any], variance: NDArray[Any]) -> Array:
    """The share of each pixel in further samples, (H, W) float32, with mean 1 in both halves.

    `mean` is the floor's, and `variance` that of its observations, (H, W, 3) each. A share is in
    proportion to the root of the mean variance of the neighbours in the other half, each relative
    to its radiance as in `relative_error`. All pixels of a group have one share. It lies between
    LEAST and MOST; if few pixels are noisy, all get what these leave.
    """
    shares = np.ones(mean.shape[:2], np.float64)
    for half in halves(shares.shape):
        noise = _by_groups(_pooled(_relative(mean, variance, ~half), ~half))[half]
        if half.any() and noise.any():
            shares[half] = _scaled(np.sqrt(noise))
    return shares.astype(np.float32)


def counts_of(shares: Array, samples: int, settings: Settings) -> Counts:
    """Samples of each pixel, (H, W), if a pixel has `samples` on average, the floor at least.

    Whole units are dealt out so that no count falls when `samples` rises (Webster's method). All
    pixels of a group have one count. The mean of a half is below `samples` by less than one unit
    for each pixel of a group.
    """
    floor, unit = floor_of(settings), unit_of(settings)
    counts = np.full(shares.shape, samples, np.int32)
    sizes = np.broadcast_to(_group_sizes(shares.shape[1]), shares[:, ::GROUP].shape)
    for half in halves(shares.shape):
        if samples > floor and half.any():
            groups = half[:, ::GROUP]
            own, pixels = shares[:, ::GROUP][groups].astype(np.float64), sizes[groups]
            dealt = _dealt(own, pixels, samples * int(pixels.sum()) // unit, floor // unit)
            counts[half] = unit * np.repeat(dealt, pixels)
    return counts


def halves(shape: tuple[int, ...]) -> Iterator[Mask]:
    """Yield the two halves of a picture of (H, W) pixels; the second is empty for a single group.

    Groups of GROUP pixels of a row belong to them in turn, along rows and columns.
    """
    rows, columns = np.ogrid[: shape[0], : shape[1]]
    first = np.asarray((rows + columns // GROUP) % 2 == 0)
    yield first
    yield ~first


def _relative(mean: NDArray[Any], variance: NDArray[Any], half: Mask) -> Floats:
    """Variance over squared radiance, averaged over channels, (H, W); 0 outside of `half`."""
    found = np.zeros(half.shape, np.float64)
    if half.any():
        level, spread = mean[half].astype(np.float64), variance[half].astype(np.float64)
        scale = np.square(level) + DARK * level.mean() ** 2
        found[half] = np.divide(spread, scale, out=np.zeros_like(spread), where=scale > 0).mean(1)
    return found


def _pooled(values: Floats, half: Mask) -> Floats:
    """Mean over the pixels of `half` in the window about each pixel, (H, W); 0 without any."""
    total, count = _window_sum(values), _window_sum(half.astype(np.float64))
    return np.divide(total, count, out=np.zeros_like(total), where=count > 0)


def _group_sizes(width: int) -> Sizes:
    """Pixels of each group of a row."""
    return np.diff(np.arange(0, width, GROUP), append=width)


def _by_groups(values: Floats) -> Floats:
    """The mean over the group of each pixel, (H, W)."""
    width = values.shape[1]
    sums = np.add.reduceat(values, np.arange(0, width, GROUP), axis=1)
    return np.asarray(np.repeat(sums / _group_sizes(width), _group_sizes(width), axis=1))


def _window_sum(values: Floats) -> Floats:
    """Sum over a window of 2 REACH + 1 pixels along both edges; 0 beyond the picture."""
    for axis in (0, 1):
        length = values.shape[axis]
        framed = np.pad(values, [(REACH, REACH) if axis == k else (0, 0) for k in (0, 1)])
        parts = (framed.take(range(k, k + length), axis) for k in range(2 * REACH + 1))
        values = np.asarray(sum(parts))
    return values


def _scaled(noise: Floats) -> Floats:
    """Noise as shares with mean 1, between LEAST and MOST; what is left over goes to all."""
    low, high = 0.0, MOST / float(noise[noise > 0].min())
    for _ in range(60):
        middle = (low + high) / 2
        fits = float(np.clip(middle * noise, LEAST, MOST).mean()) <= 1
        low, high = (middle, high) if fits else (low, middle)
    shares = np.clip(low * noise, LEAST, MOST)
    return np.asarray(shares + (1 - shares.mean()))


def _dealt(shares: Floats, pixels: Sizes, total: int, least: int) -> Sizes:
    """Units of the pixels of each group, at least `least`, in proportion to `shares`.

    They are `total` over all pixels, less what does not suffice for the next group.
    """

    def units(scale: float) -> Floats:
        return np.asarray(np.maximum(np.floor(scale * shares + 0.5), least))

    low, high = 0.0, (total + int(pixels.max())) / float((shares * pixels).max())
    while high - low > 1e-13 * high:
        middle = (low + high) / 2
        low, high = (middle, high) if units(middle) @ pixels <= total else (low, middle)
    dealt = units(low)
    order = np.argsort((dealt + 0.5) / shares, kind="stable")  # several may be next at once
    fits = np.cumsum(pixels[order]) <= total - int(dealt @ pixels)
    dealt[order[fits]] += 1
    return dealt.astype(np.int64)
