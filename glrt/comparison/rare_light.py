"""Noise that is concentrated in single pixels: light that few samples find.

A picture whose method hardly ever finds some of the light claims too little noise wherever it has
not met it yet. The pixels that have met it show it: their variance is far above that of the pixels
around them, and above that of the other picture in the same place. Every method sees the rim of a
lamp, so its noise is in both pictures.
"""

from itertools import pairwise

import numpy as np

from glrt.comparison.regions import Array, edges, spread_out

FAR = 16.0  # times the variance that is usual in a place


def rare_variance(variance: Array, other: Array) -> Array:
    """The variance of the pixels that met rare light, 0 elsewhere, (H, W, 3).

    `variance` is that of the means of a picture's pixels. `other` is that of another picture's,
    scaled to as many samples per pixel.
    """
    usual = spread_out(_largest_around(_medians(variance)), variance.shape)
    return np.where(variance > FAR * np.maximum(usual, other), variance, 0.0)


def _medians(pixels: Array) -> Array:
    """Medians of the blocks, (rows, columns, 3)."""
    rows, columns = edges(pixels.shape[0]), edges(pixels.shape[1])
    bands = [pixels[top:end] for top, end in pairwise(rows)]
    sides = list(pairwise(columns))
    return np.array([[np.median(band[:, i:j], axis=(0, 1)) for i, j in sides] for band in bands])


def _largest_around(values: Array) -> Array:
    """The maximum over each block and its eight neighbours."""
    rows, columns = values.shape[:2]
    framed = np.pad(values, ((1, 1), (1, 1), (0, 0)), mode="edge")
    shifted = [framed[y : y + rows, x : x + columns] for y in range(3) for x in range(3)]
    return np.asarray(np.max(shifted, axis=0))
