"""The mean squared error of a filtered picture, from two halves, without bias.

A and B are independent means over shares a and b = 1 - a of the samples. D(A) may be any function
of A alone. As B is independent of it, the squared error of D(A) is (D(A) - B)^2 less the variance
of B, on average; likewise for D(B). The picture a D(A) + b D(B) then has the squared error

    a [(D(A) - B)^2 - Var B] + b [(D(B) - A)^2 - Var A] - a b [D(A) - D(B)]^2

since the square of a sum of two errors is a x^2 + b y^2 - a b (x - y)^2. The value of a single
pixel may be negative, so only sums are reported. With D the identity the formula is the variance of
the plain picture; with a constant D it is the squared bias.

The split is that of cross-validation. Estimates of error that drive filters are in Rousselle, Knaus
and Zwicker, "Adaptive Sampling and Reconstruction using Greedy Error Minimization" (2011).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt.denoise.half import Half, Pixels
from glrt.denoise.windows import window_mean
from glrt.error.estimate import DARK

REGION = 8  # pixels: the map is taken over 17 x 17

ONE_SIDED_95 = 1.644854  # standard deviations below which 95 % lie

Squares = NDArray[np.float64]


def squared_error(halves: tuple[Half, Half], denoised: tuple[ArrayLike, ArrayLike]) -> Squares:
    """Squared error per pixel, (H, W, 3); unbiased, may be negative. `denoised`: D(A), D(B)."""
    (first, second), (a, b) = halves, (np.asarray(d, np.float64) for d in denoised)
    of_first = np.square(a - second.radiance) - second.variance
    of_second = np.square(b - first.radiance) - first.variance
    between = first.share * second.share * np.square(a - b)
    squares: Squares = first.share * of_first + second.share * of_second - between
    return squares


def summed(halves: tuple[Half, Half], denoised: tuple[Pixels, Pixels]) -> Pixels:
    """The combined picture a D(A) + b D(B), (H, W, 3)."""
    (first, second), (a, b) = halves, denoised
    return (first.share * a.astype(np.float64) + second.share * b).astype(np.float32)


class Band(NamedTuple):
    """An estimated relative RMS error, and its upper limit in 95 of 100 cases."""

    error: float
    high: float


def relative_error(squares: Squares, radiance: Pixels) -> Band:
    """Relative RMS error of a picture: sqrt(mean(squares / (radiance^2 + 0.01 mean(radiance)^2))).

    It is the error of plain pictures with one change: a pixel brighter than the mean of its 3 x 3
    counts as bright as that mean. Otherwise a pixel that is much too bright would divide its own
    error. The error is 0 where chance makes the mean negative. The upper limit follows from the
    spread of pixels, whose noise is independent.
    """
    values = radiance.astype(np.float64)
    usual = np.minimum(values, window_mean(values, 1))
    scale = np.square(usual) + DARK * values.mean() ** 2
    parts = np.divide(squares, scale, out=np.zeros_like(squares), where=scale > 0)
    pixels = parts.mean(axis=-1)
    chance = ONE_SIDED_95 * pixels.std() / np.sqrt(pixels.size)
    mean = float(pixels.mean())
    return Band(math.sqrt(max(mean, 0)), math.sqrt(max(mean + chance, 0)))


def error_map(squares: Squares) -> Pixels:
    """Root of the mean squared error around each pixel, (H, W, 3), in units of radiance."""
    return np.sqrt(np.maximum(window_mean(squares, REGION), 0)).astype(np.float32)
