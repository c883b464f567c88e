"""Means over the neighbourhood of each pixel, and pairs of neighbours."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Place = tuple[slice, ...]


def window_mean(image: Array, reach: int) -> Array:
    """Mean over the (2 reach + 1)^2 pixels around each pixel; (H, W, ...), of the given type.

    At the border it is over the pixels that exist. Sums are in float64.
    """
    result = image.astype(np.float64)
    for axis in (0, 1):
        result = _sums(result, reach, axis) / _counts(image.shape, reach, axis)
    return result.astype(image.dtype)


def _sums(image: Array, reach: int, axis: int) -> Array:
    """Sums over 2 reach + 1 neighbours along an axis, as differences of running sums."""
    low, high = _ends(image.shape[axis], reach)
    zero = np.zeros_like(image.take([0], axis))
    running = np.concatenate([zero, np.cumsum(image, axis)], axis)
    sums: Array = running.take(high, axis) - running.take(low, axis)
    return sums


def _counts(shape: tuple[int, ...], reach: int, axis: int) -> Array:
    low, high = _ends(shape[axis], reach)
    across = [1] * len(shape)
    across[axis] = shape[axis]
    return (high - low).reshape(across)


def _ends(length: int, reach: int) -> tuple[Array, Array]:
    """The first neighbour of each place, and the one after the last neighbour."""
    places = np.arange(length)
    return np.maximum(places - reach, 0), np.minimum(places + reach + 1, length)


def pairs(size: tuple[int, ...], reach: int) -> Iterator[tuple[Place, Place]]:
    """Yield each pair of pixels of a picture (H, W) once that are up to `reach` apart either way.

    All pairs of one offset come together: the places of the first pixels, and those of the second.
    """
    height, width = size
    across = min(reach, width - 1)
    for down in range(min(reach, height - 1) + 1):
        for right in range(-across, across + 1):
            if down > 0 or right > 0:
                yield _overlap(size, (down, right))


def _overlap(size: tuple[int, ...], offset: tuple[int, int]) -> tuple[Place, Place]:
    """Slices of the pixels whose partner at the offset is in the picture, and of the partners."""
    here, there = [], []
    for length, step in zip(size, offset, strict=True):
        here.append(slice(max(0, -step), max(0, length - max(0, step))))
        there.append(slice(max(0, step), max(0, length - max(0, -step))))
    return tuple(here), tuple(there)
