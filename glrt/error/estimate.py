"""How large the error of an image is, and whether it is more than chance.

An estimate is a pixel's mean with the standard error of that mean; all sums are in float64.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

BAND = 1 << 20  # values in work at a time: copies in float64 stay small beside the image
DARK = 0.01  # keeps dark pixels from ruling the relative error (a share of the squared mean)
TWO_SIDED_95 = 1.959964  # standard deviations about the mean within which 95 % lie


def relative_error(radiance: ArrayLike, stderr: ArrayLike) -> float | None:
    """Relative RMS error: sqrt(mean(stderr^2 / (radiance^2 + 0.01 * mean(radiance)^2))).

    Both arrays have one shape, (H, W, 3) for an image; all means run over pixels and channels.
    None where `stderr` holds NaN: there are fewer than two observations. A black image without
    noise has error 0.
    """
    total = sum(float(ratio.sum()) for ratio in _relative_variances(radiance, stderr))
    return None if math.isnan(total) else math.sqrt(total / np.size(radiance))


class Band(NamedTuple):
    """A relative error as estimated, and the band that chance leaves it."""

    error: float
    low: float
    high: float


def error_band(radiance: ArrayLike, stderr: ArrayLike) -> Band | None:
    """`relative_error` of an image, (H, W, 3) each, and the interval that holds it at 95 %.

    Pixels are independent of each other, so the mean over them is as sure as their spread tells:
    the standard error s of the error's logarithm is half that of the mean, over the mean, and the
    band is error * exp(+-1.96 s). Light that no sample has met is in no estimate, nor in the band.
    """
    parts = _relative_variances(radiance, stderr)
    pixels = np.concatenate([ratio.mean(axis=-1) for ratio in parts])
    mean = float(pixels.mean())
    if math.isnan(mean):
        return None
    if mean in (0.0, math.inf) or pixels.size < 2:
        return Band(math.sqrt(mean), math.sqrt(mean), math.sqrt(mean))
    spread = float(pixels.std(ddof=1)) / math.sqrt(pixels.size) / mean / 2
    factor = math.exp(TWO_SIDED_95 * spread)
    return Band(math.sqrt(mean), math.sqrt(mean) / factor, math.sqrt(mean) * factor)


def _relative_variances(radiance: ArrayLike, stderr: ArrayLike) -> Iterator[NDArray[np.float64]]:
    """stderr^2 / (radiance^2 + 0.01 * mean(radiance)^2), some rows at a time; NaN stays."""
    values, errors = np.atleast_1d(radiance), np.atleast_1d(stderr)
    rows = max(1, BAND * len(values) // max(1, values.size))
    parts = [slice(first, first + rows) for first in range(0, len(values), rows)]
    dark = DARK * (sum(values[p].sum(dtype=np.float64) for p in parts) / values.size) ** 2
    for part in parts:
        variance = np.square(errors[part], dtype=np.float64)
        scale = np.square(values[part], dtype=np.float64) + dark
        ratio = np.where(variance > 0, np.inf, variance)
        yield np.divide(variance, scale, out=ratio, where=scale > 0)


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
