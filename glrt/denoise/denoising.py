"""Make a denoised picture and its error from two halves of the samples."""

import math
from dataclasses import dataclass

import numpy as np

from glrt.denoise.blend import blended
from glrt.denoise.filters import FILTERS
from glrt.denoise.half import Half, Pixels
from glrt.denoise.risk import error_map, relative_error, squared_error, summed


@dataclass(frozen=True, eq=False)
class Denoised:
    """A filtered picture, and its error: noise and bias of the filter together."""

    radiance: Pixels  # (H, W, 3)
    error_map: Pixels  # (H, W, 3): root mean squared error about each pixel, in units of radiance
    error: float  # relative RMS error of the picture, as estimated
    error_high: float  # upper limit of `error` in 95 of 100 cases
    noise: Pixels | None = None  # (H, W, 3): its square is the variance that is left, on average;
    # the rest of the error is bias. None if read from a file


def denoise(halves: tuple[Half, Half], name: str) -> Denoised:
    """Filter both halves by their own guides and errors, and combine them.

    `name` is a key of `FILTERS`. Raises UsageError if the package of the filter is not installed.
    """
    first, second = (blended(half, FILTERS[name](half)) for half in halves)
    radiance = summed(halves, (first, second))
    squares = squared_error(halves, (first, second))
    band = relative_error(squares, radiance)
    noise = math.sqrt(halves[0].share * halves[1].share) * np.abs(first - second)
    return Denoised(radiance, error_map(squares), band.error, band.high, noise.astype(np.float32))
