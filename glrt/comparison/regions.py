"""Sums of pixels over regions of a picture: the whole, and blocks of 8 x 8 pixels."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Add = Callable[[Array], Array]  # sums pixels, (H, W, 3), over regions

BLOCK = 8  # pixels on a side


def whole(pixels: Array) -> Array:
    """Sum of all pixels, (3,)."""
    return np.asarray(pixels.sum(axis=(0, 1)))


def edges(length: int) -> NDArray[np.intp]:
    """Where the blocks of a side begin, and its end; a remainder joins the last block."""
    starts = np.arange(max(length // BLOCK, 1), dtype=np.intp) * BLOCK
    return np.append(starts, length)


def blocks(pixels: Array) -> Array:
    """Sums of blocks of 8 x 8 pixels, (rows, columns, 3)."""
    rows, columns = (edges(length)[:-1] for length in pixels.shape[:2])
    return np.asarray(np.add.reduceat(np.add.reduceat(pixels, rows, axis=0), columns, axis=1))


def spread_out(values: Array, shape: tuple[int, ...]) -> Array:
    """The value of each pixel's block, for pictures of `shape`."""
    rows, columns = (np.diff(edges(length)) for length in shape[:2])
    return np.repeat(np.repeat(values, rows, axis=0), columns, axis=1)


def ratio_of(above: Array, below: Array) -> Array:
    """The quotient; 0 where `below` is not positive."""
    return np.divide(above, below, where=below > 0, out=np.zeros_like(above))
