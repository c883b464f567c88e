"""How large the error of an image is, and whether it is more than chance.

An estimate is a pixel's mean with the standard error of that mean; all sums are in float64.
"""

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt.error.brightest_neighbour import brightest_around

BAND = 1 << 18  # values in work at a time: copies in float64 stay small compared to the image
DARK = 0.01  # keeps dark pixels from ruling the relative error (a share of the squared mean)
UNSURE = 4.0  # squared standard errors: a radiance below two standard errors may be luck
LUCK = 32.0  # times the true radiance: what one lucky sample shows is no more, in 249 of 250 cases
TWO_SIDED_95 = 1.959964  # standard deviations about the mean within which 95 % lie


def relative_error(level: ArrayLike, errors: ArrayLike) -> float | None:
    """Relative RMS of errors about a level: sqrt(mean(errors^2 / (level^2 + 0.01 mean(level)^2))).

    For a known level, such as a reference; for a picture alone see `estimated_error`. Both arrays
    have one shape, (H, W, 3) for an image; all means run over pixels and channels. None where
    `errors` hold NaN. A black level without errors has error 0.
    """
    values = np.atleast_1d(level)
    squares = (np.square(values[part], dtype=np.float64) for part in _bands(values))
    return _root_mean(_ratios(values, np.atleast_1d(errors), squares))


def estimated_error(radiance: ArrayLike, stderr: ArrayLike) -> float | None:
    """Estimated relative RMS error of a picture: sqrt(mean(stderr^2 / (L^2 + 0.01 mean^2))).

    `radiance` and its standard error are (H, W, channels); L^2 is `squared_levels`, `mean` that of
    the radiance. None where `stderr` holds NaN: there are fewer than two observations. A black
    image without noise has error 0.
    """
    return _root_mean(_estimated_ratios(radiance, stderr))


class Band(NamedTuple):
    """An estimated relative error, with its 95 % confidence interval."""

    error: float
    low: float
    high: float


def error_band(radiance: ArrayLike, stderr: ArrayLike) -> Band | None:
    """`estimated_error` of an image, (H, W, 3) each, with its 95 % confidence interval.

    Pixels are independent, so their spread gives the standard error of the mean over them. The
    standard error s of the error's logarithm is half of that, over the mean, and the interval is
    error * exp(+-1.96 s). Light that no sample has met is neither in the estimate nor in the
    interval. None where `stderr` holds NaN.
    """
    parts = _estimated_ratios(radiance, stderr)
    pixels = np.concatenate([ratio.mean(axis=-1) for ratio in parts])
    mean = float(pixels.mean())
    if math.isnan(mean):
        return None
    if mean in (0.0, math.inf) or pixels.size < 2:
        return Band(math.sqrt(mean), math.sqrt(mean), math.sqrt(mean))
    spread = float(pixels.std(ddof=1)) / math.sqrt(pixels.size) / mean / 2
    factor = math.exp(TWO_SIDED_95 * spread)
    return Band(math.sqrt(mean), math.sqrt(mean) / factor, math.sqrt(mean) * factor)


def squared_levels(
    radiance: ArrayLike, stderr: ArrayLike, rows: slice = slice(None)
) -> NDArray[np.float64]:
    """Squares of the estimated true radiance, (H, W, channels) or some rows; NaN where `stderr` is.

    A pixel that a rare bright sample met is too bright by luck. So its level is that of its
    brightest neighbour in the picture, by channel, if that is darker. But it is at least what its
    own noise leaves certain: the root of radiance^2 - UNSURE stderr^2, and radiance / LUCK.
    """
    values, errors = np.asarray(radiance), np.asarray(stderr)
    start, stop, _ = rows.indices(len(values))
    first = max(start - 1, 0)
    beside = brightest_around(values[first : stop + 1])[start - first :]
    own = values[start:stop].astype(np.float64)
    beside = beside[: len(own)].astype(np.float64)
    near = own if values.shape[0] * values.shape[1] == 1 else np.minimum(own, beside)
    squares = np.square(own)
    certain = squares - UNSURE * np.square(errors[start:stop], dtype=np.float64)
    return np.asarray(np.maximum(np.maximum(np.square(near), certain), squares / LUCK**2))


def _estimated_ratios(radiance: ArrayLike, stderr: ArrayLike) -> Iterator[NDArray[np.float64]]:
    values, errors = np.asarray(radiance), np.asarray(stderr)
    levels = (squared_levels(values, errors, part) for part in _bands(values))
    return _ratios(values, errors, levels)


def _bands(values: NDArray[Any]) -> list[slice]:
    """Slices of rows with about BAND values each."""
    rows = max(1, BAND * len(values) // max(1, values.size))
    return [slice(top, min(top + rows, len(values))) for top in range(0, len(values), rows)]


def _ratios(
    values: NDArray[Any], errors: NDArray[Any], squares: Iterable[NDArray[np.float64]]
) -> Iterator[NDArray[np.float64]]:
    """errors^2 / (squares + 0.01 mean(values)^2), band by band; NaN stays."""
    bands = _bands(values)
    dark = DARK * (sum(values[part].sum(dtype=np.float64) for part in bands) / values.size) ** 2
    for part, square in zip(bands, squares, strict=True):
        variance = np.square(errors[part], dtype=np.float64)
        scale = square + dark
        ratio = np.where(variance > 0, np.inf, variance)
        yield np.divide(variance, scale, out=ratio, where=scale > 0)


def _root_mean(ratios: Iterable[NDArray[np.float64]]) -> float | None:
    """Root of the mean over all values; None where one is NaN."""
    total, count = 0.0, 0
    for ratio in ratios:
        total, count = total + float(ratio.sum()), count + ratio.size
    return None if math.isnan(total) else math.sqrt(total / count)


def sidak_threshold(alpha: float, tests: int) -> float:
    """The p-value below which one of k independent tests fails: 1 - (1 - alpha)^(1/k).

    Then all k together fail by chance with probability `alpha`.
    """
    return -math.expm1(math.log1p(-alpha) / tests)


def block_means(image: ArrayLike, size: int = 8) -> NDArray[np.float64]:
    """Means of blocks of size x size pixels: (H, W, ...) to (H // size, W // size, ...).

    They show what pixels hide, such as seeds that neighbours share. Rows and columns that fill
    no block are left out. Raises ValueError for an image smaller than one block.
    """
    pixels = np.asarray(image, np.float64)
    rows, columns = pixels.shape[0] // size, pixels.shape[1] // size
    if rows == 0 or columns == 0:
        raise ValueError(f"{pixels.shape[1]} x {pixels.shape[0]} pixels hold no block of {size}")
    whole = pixels[: rows * size, : columns * size]
    blocks = whole.reshape(rows, size, columns, size, *pixels.shape[2:])
    return np.asarray(blocks.mean(axis=(1, 3)))


def block_stderr(stderr: ArrayLike, size: int = 8) -> NDArray[np.float64]:
    """Standard error of `block_means` if pixels are independent: sqrt(sum(stderr^2)) / size^2."""
    return np.sqrt(block_means(np.square(np.asarray(stderr, np.float64)), size)) / size
