"""Histogram of a picture: shares of its pixels by luminance."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

STOPS = (-12.0, 8.0)  # of the luminance, as powers of two
STEPS = 80
_LUMINANCE = (0.2126, 0.7152, 0.0722)  # of linear sRGB (ITU-R BT.709)


class Histogram(NamedTuple):
    """`shares` (STEPS,) of pixels in equal steps; the outermost hold all beyond STOPS."""

    stops: NDArray[np.float64]  # (STEPS,): middles of the steps
    shares: NDArray[np.float64]
    black: float  # share of pixels without light

    def above(self, exposure: float) -> float:
        """Return the share of pixels brighter than white at an exposure in EV, up to a step."""
        return float(self.shares[self.stops + exposure > 0].sum())


def histogram(radiance: NDArray[Any]) -> Histogram:
    """Return the histogram of a picture (H, W, 3), linear sRGB."""
    luminance = (radiance.reshape(-1, 3).astype(np.float64) @ np.array(_LUMINANCE)).clip(0)
    lit = luminance[luminance > 0]
    low, high = STOPS
    step = (high - low) / STEPS
    places = ((np.log2(lit) - low) / step).clip(0, STEPS - 1).astype(np.intp)
    counts = np.bincount(places, minlength=STEPS)
    stops = np.asarray(low + step * (np.arange(STEPS) + 0.5), np.float64)
    shares = np.asarray(counts / max(len(luminance), 1), np.float64)
    return Histogram(stops, shares, 1 - len(lit) / max(len(luminance), 1))


DARK = histogram(np.zeros((1, 1, 3)))
