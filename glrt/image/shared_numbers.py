"""A picture whose pixels share random numbers, as a control variate between neighbours.

Samples fall into 2 PAIRS groups. Groups with even numbers use the same random numbers in all pixels
(C), the others their own (P). Both have the same mean, and neighbours of C err alike. So the
picture of a pair, (C + P) / 2 + sum_k w_k B_k(C - P), has that mean, too, for any weights w that do
not depend on its samples; B_k is the mean over a box of pixels of one object. (Rousselle, Jarosz
and Novak, "Image-space Control Variates for Rendering", 2016.)

The weights of a region, the pixels of one object in one tile, are found by least squares: they give
the least variance among the pairs of one half. They are used for the pairs of the other half.
"""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.error.estimate import DARK
from glrt.image.aovs import AovImages
from glrt.image.group_channels import judged
from glrt.samplers import GROUPS

PAIRS = GROUPS // 2  # of C and P
TILE = 32  # pixels a side of a region
BOXES = (0, 1, 3, 8)  # radii of the boxes
RIDGE = 1e-3  # of the diagonal: regions without noise have a solution, too
STRIP = 2 * TILE  # rows in work at a time

Array = NDArray[np.float64]
Pixels = NDArray[np.float32]
Numbers = NDArray[Any]  # of objects or regions, (H, W)


class Shared(NamedTuple):
    """A picture and its standard error, (H, W, 3) each."""

    radiance: Pixels
    stderr: Pixels


class _Pairs(NamedTuple):
    """Rows of the pairs of one picture; arrays (PAIRS, 3, H, W), or (PAIRS, 1, H, W)."""

    mean: Pixels  # (C + P) / 2
    apart: Pixels  # C - P
    share: Pixels  # of the pixel's samples


def picture(mean: Pixels, means: NDArray[np.float32], aovs: AovImages) -> Shared:
    """Return the picture of a film with the mean (H, W, 3) and its groups, (2 PAIRS, H, W, 4).

    While a group has no samples, it is the mean, and its error is unknown: NaN. The numbers of
    objects are among the AOVs.
    """
    if not (means[..., 3].max(axis=(1, 2)) > 0).all():
        return Shared(mean, np.full_like(mean, np.nan))
    return combined(means, aovs["object"].value)


def own_part(means: NDArray[np.float32]) -> Shared:
    """Return the picture of the numbers that are a pixel's own: pixels err independently."""
    variance, count = judged(means[1::2])
    weights = means[1::2, ..., 3:].astype(np.float64)
    total = np.maximum(weights.sum(axis=0), 1)
    mean = (weights * means[1::2, ..., :3]).sum(axis=0) / total
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.where(count[..., None] > 1, np.sqrt(variance / (count[..., None] - 1)), np.nan)
    return Shared(mean.astype(np.float32), error.astype(np.float32))


def combined(means: NDArray[np.float32], objects: Numbers) -> Shared:
    """Return the picture of groups, (2 PAIRS, H, W, 4): means, and samples in channel 3.

    `objects` are numbers (H, W). Each group needs samples.
    """
    height, width = objects.shape
    radiance, stderr = np.empty((2, height, width, 3), np.float32)
    numbers, reach = _ranked(objects), max(BOXES)
    scales = [DARK * _mean(means, half) ** 2 for half in (0, 1)]
    for top in range(0, height, STRIP):
        end = min(top + STRIP, height)
        first, last = max(top - reach, 0), min(end + reach, height)
        pairs, kept = _pairs(means[:, first:last]), slice(top - first, end - first)
        boxed = boxes(pairs.apart, BOXES, numbers[first:last])[..., kept, :]
        own = _Pairs(*(part[..., kept, :] for part in pairs))
        found = _strip(own, boxed, regions_of(numbers[top:end]), scales)
        radiance[top:end], stderr[top:end] = (np.moveaxis(plane, 0, -1) for plane in found)
    return Shared(radiance, stderr)


def _ranked(objects: Numbers) -> NDArray[np.intp]:
    """Numbers of objects from 0 on, without gaps."""
    flat = objects.ravel().astype(np.intp)
    is_there = np.bincount(flat) > 0
    return np.asarray((is_there.cumsum() - 1)[flat].reshape(objects.shape))


def _strip(pairs: _Pairs, boxed: Pixels, regions: Numbers, scales: Sequence[float]) -> Shared:
    """Some rows of the picture, (3, H, W); `boxed` is (boxes, PAIRS, 3, H, W)."""
    radiance, variance = np.zeros((2, *pairs.mean.shape[1:]))
    for half in (0, 1):
        seen = 1 - half
        used, known = slice(half, None, 2), slice(seen, None, 2)
        level = np.square(pairs.mean[known].mean(axis=0)) + np.float32(scales[seen])
        level = np.where(level > 0, level, 1)
        found = weights_of(pairs.mean[known], boxed[:, known], level, regions)
        parts = pairs.mean[used].copy()
        for box, weight in zip(boxed, found.T.astype(np.float32), strict=True):
            parts += weight[regions] * box[used]
        share = pairs.share[used]
        whole = share.sum(axis=0)
        inner = share / np.where(whole > 0, whole, 1)
        middle = (inner * parts).sum(axis=0)
        squares = np.square(inner * (parts - middle)).sum(axis=0)
        rest = 1 - np.square(inner).sum(axis=0)
        radiance += whole * middle
        variance += np.square(whole) * squares / np.where(rest > 0, rest, 1)
    return Shared(radiance.astype(np.float32), np.sqrt(variance).astype(np.float32))


def _pairs(means: NDArray[np.float32]) -> _Pairs:
    planes = np.ascontiguousarray(np.moveaxis(means, -1, 1))
    common, own, both = planes[0::2, :3], planes[1::2, :3], planes[0::2, 3:] + planes[1::2, 3:]
    share = np.asarray(both / np.maximum(both.sum(axis=0), 1), np.float32)
    return _Pairs(np.asarray((common + own) / 2, np.float32), common - own, share)


def _mean(means: NDArray[np.float32], half: int) -> float:
    """The mean of all groups of a half of the pairs."""
    groups = [group for number, group in enumerate(means) if number // 2 % 2 == half]
    return float(np.mean([group[..., :3].mean(dtype=np.float64) for group in groups]))


def boxes(pictures: NDArray[Any], radii: Sequence[int], objects: Numbers) -> NDArray[Any]:
    """Means of (..., H, W) over squares of pixels of one object (H, W), cut at the edges.

    Squares have 2 radius + 1 pixels a side; the result is (radii, ..., H, W).
    """
    found = np.stack([pictures] * len(radii))
    for rows, columns, is_own in _places(objects):
        sums = _sums(pictures[..., rows, columns] * is_own, max(radii))
        counts = _sums(is_own, max(radii))
        for held, radius in zip(found[..., rows, columns], radii, strict=True):
            if radius:
                count = _over_squares(counts, radius, max(radii))
                mean = _over_squares(sums, radius, max(radii)) / np.maximum(count, 1)
                np.copyto(held, mean, where=is_own, casting="same_kind")
    return found


def _places(objects: Numbers) -> Iterator[tuple[slice, slice, NDArray[np.bool_]]]:
    """Yield rows and columns that hold an object, and which pixels there are its own."""
    for number in np.flatnonzero(np.bincount(objects.ravel())):
        is_own = objects == number
        rows, columns = (np.flatnonzero(is_own.any(axis=axis)) for axis in (1, 0))
        place = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        yield *place, is_own[place]


def _sums(values: NDArray[Any], reach: int) -> Array:
    """Sums over all above and to the left of corners of pixels, `reach` pixels beyond each edge.

    (..., H, W) to (..., H + 2 reach + 1, W + 2 reach + 1).
    """
    sums = values.astype(np.float64).cumsum(axis=-2).cumsum(axis=-1)
    still = [(0, 0)] * (values.ndim - 2)
    sums = np.pad(sums, [*still, (reach + 1, 0), (reach + 1, 0)])
    return np.asarray(np.pad(sums, [*still, (0, reach), (0, reach)], mode="edge"))


def _over_squares(sums: Array, radius: int, reach: int) -> Array:
    """Sums (..., H, W) over squares of 2 radius + 1 pixels, from `_sums`."""
    low, high = reach - radius, reach + radius + 1
    rows, columns = (size - 2 * reach - 1 for size in sums.shape[-2:])
    down = sums[..., high : high + rows, :] - sums[..., low : low + rows, :]
    return np.asarray(down[..., high : high + columns] - down[..., low : low + columns])


def regions_of(objects: Numbers, tile: int = TILE) -> NDArray[np.intp]:
    """Return the number of each pixel's region, (H, W) from 0; `objects` are numbers from 0."""
    row, column = (place // tile for place in np.indices(objects.shape))
    return _ranked((objects * (row.max() + 1) + row) * (column.max() + 1) + column)


def weights_of(mean: Pixels, boxed: Pixels, level: Pixels, regions: Numbers) -> Array:
    """Return the weights of boxes with the least variance, (regions, boxes).

    `mean` is (C + P) / 2 of several pairs, (N, 3, H, W); `boxed` is (boxes, N, 3, H, W); `level`
    divides squared errors, (3, H, W).
    """
    scale = 1 / np.sqrt(level)
    apart = (mean - mean.mean(axis=0)) * scale
    x = (boxed - boxed.mean(axis=1, keepdims=True)) * scale
    count = len(x)
    matrix = np.empty((regions.max() + 1, count, count))
    wanted = np.empty((regions.max() + 1, count))
    for i in range(count):
        wanted[:, i] = -_by_region(x[i] * apart, regions)
        for j in range(i, count):
            matrix[:, i, j] = matrix[:, j, i] = _by_region(x[i] * x[j], regions)
    steps = np.arange(count)
    matrix[:, steps, steps] = matrix[:, steps, steps] * (1 + RIDGE) + np.finfo(float).tiny
    return np.asarray(np.linalg.solve(matrix, wanted[..., None])[..., 0])


def _by_region(values: Pixels, regions: Numbers) -> Array:
    """Sums of (N, 3, H, W) over pairs, channels and the pixels of a region."""
    return np.bincount(regions.ravel(), values.sum(axis=(0, 1)).ravel()).astype(np.float64)
