"""Two halves in, a picture and its error out."""

from dataclasses import dataclass

from glrt.denoise.blend import blended
from glrt.denoise.filters import FILTERS
from glrt.denoise.half import Half, Pixels
from glrt.denoise.risk import error_map, relative_error, squared_error, summed


@dataclass(frozen=True, eq=False)
class Denoised:
    """A picture filtered, and how wrong it is: noise and bias of the filter together."""

    radiance: Pixels  # (H, W, 3)
    error_map: Pixels  # (H, W, 3): root mean squared error about each pixel, in units of radiance
    error: float  # relative RMS error of the picture, as estimated
    error_high: float  # what that is below in 95 of 100 cases


def denoise(halves: tuple[Half, Half], name: str) -> Denoised:
    """Both halves filtered by their own guides and errors, and put together.

    `name` is a key of `FILTERS`. UsageError where the package of the filter is not installed.
    """
    first, second = (blended(half, FILTERS[name](half)) for half in halves)
    radiance = summed(halves, (first, second))
    squares = squared_error(halves, (first, second))
    return Denoised(radiance, error_map(squares), *relative_error(squares, radiance))
