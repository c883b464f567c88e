"""Means over the neighbourhood of each pixel."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def window_mean(image: Array, reach: int) -> Array:
    """Mean over the (2 reach + 1)^2 pixels about each; (H, W, ...) of the type that came.

    At the border over the pixels that are there. Sums run in float64.
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
    """First neighbour of each place, and the one after the last."""
    places = np.arange(length)
    return np.maximum(places - reach, 0), np.minimum(places + reach + 1, length)
