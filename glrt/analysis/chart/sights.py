"""How errors look: parts of pictures of a scene that have about the errors of LEVELS."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.analysis.chart.curves import LEVELS, Curve
from glrt.analysis.chart.measure import Bench
from glrt.analysis.reference import Reference
from glrt.image.tonemap import expose_and_encode

MOST_SECONDS = 1.5  # for all pictures of a scene
LOOSE = 1.25  # errors above this times their level are shown by a mean
PRECISE = 1.5  # least ratio of an error that is shown to that of the reference
MOST_SIDE = 96  # pixels of a part
WHITE, TAIL = 0.8, 95.0  # the code of a pixel of the reference that is brighter than TAIL %

Pixels = NDArray[np.float32]


class Sight(NamedTuple):
    """A picture with about the error of a level."""

    level: float
    variant: str
    samples: int  # per pixel
    error: float  # relative RMS, of this picture
    radiance: Pixels  # (H, W, 3)
    share: float = 1.0  # of a rendered picture; the rest is the reference


def sights_of(bench: Bench, curves: Sequence[Curve], reference: Reference) -> list[Sight]:
    """A picture for each of LEVELS that is well above the error of the reference.

    All are of the unbiased variant that comes furthest in MOST_SECONDS. Its film continues from
    level to level. Errors that take longer are shown by a mean of its last picture and the
    reference, an unbiased picture too. None without such a variant or level.
    """
    levels = [level for level in LEVELS if level >= PRECISE * reference.error]
    plans = [plan for curve in curves if (plan := _plan(curve))]
    if not plans or not levels:
        return []
    name, wanted, _ = min(plans, key=lambda plan: plan[2])
    found: list[Sight] = []
    for level, picture in zip(levels, bench.pictures(name, wanted), strict=False):
        error = math.sqrt(max(reference.squared_error(picture.radiance), 0.0))
        found.append(Sight(level, name, picture.samples, error, picture.radiance))
    last = found[-1]
    if last.error > LOOSE * last.level:
        found.pop()
    return [*found, *(_mixed(last, level, reference) for level in levels[len(found) :])]


def _mixed(sight: Sight, level: float, reference: Reference) -> Sight:
    """A picture of a smaller error: a share of another, and the rest of the reference."""
    share = min(1.0, level / sight.error) if sight.error > 0 else 1.0
    radiance = share * sight.radiance + (1 - share) * reference.radiance
    shown = radiance.astype(np.float32)
    return Sight(level, sight.variant, sight.samples, share * sight.error, shown, share)


def _plan(curve: Curve) -> tuple[str, list[int], float] | None:
    """Name, samples for each of LEVELS that fits into MOST_SECONDS, and the last error.

    If none fits, the samples for MOST_SECONDS. None for curves that are biased.
    """
    if curve.seen_bias or "denoised" in curve.name or not curve.is_rival:
        return None
    last = curve.points[-1]
    times = [curve.milliseconds_to(level) for level in LEVELS]
    limit = 1e3 * MOST_SECONDS
    fitting = [time[0] for time in times if time and time[0] <= limit] or [limit]
    error = last.error.value * math.sqrt(last.milliseconds.value / limit)
    return curve.name, [_samples(curve, time) for time in fitting], error


def _samples(curve: Curve, milliseconds: float) -> int:
    """Samples in a time, interpolated in logarithms; beyond the last point, in proportion."""
    times = [math.log(point.milliseconds.value) for point in curve.points]
    samples = [math.log(point.samples) for point in curve.points]
    wanted = math.log(milliseconds)
    beyond = max(0.0, wanted - times[-1])
    return max(1, round(math.exp(float(np.interp(wanted, times, samples)) + beyond)))


def codes_of(sights: Sequence[Sight], reference: Reference) -> list[NDArray[np.uint8]]:
    """The same part of each picture, and at last of the reference, as sRGB of one exposure."""
    truth = np.nan_to_num(reference.radiance, posinf=0.0, neginf=0.0)
    bright = float(np.percentile(truth.max(axis=2), TAIL))
    stops = math.log2(WHITE / bright) if bright > 0 else 0.0
    rows, columns = _part(sights[0], reference)
    pictures: list[NDArray[Any]] = [*(sight.radiance for sight in sights), truth]
    parts = [np.nan_to_num(picture[rows, columns]) for picture in pictures]
    return [expose_and_encode(part, stops, "neutral") for part in parts]


def captions(sights: Sequence[Sight], reference: Reference) -> list[str]:
    """A line for each picture, and for the reference."""
    return [*map(_caption, sights), f"{_percent(reference.error)}: reference"]


def _caption(sight: Sight) -> str:
    rendered = f"{sight.variant}, {sight.samples} samples"
    made = rendered if sight.share == 1 else "mixed with the reference"
    return f"{_percent(sight.error)}: {made}"


def _percent(error: float) -> str:
    return f"{100 * error:.2g} %"


def _part(sight: Sight, reference: Reference) -> tuple[slice, slice]:
    """The part whose own error is nearest to that of the picture; MOST_SIDE pixels at most."""
    height, width, _ = sight.radiance.shape
    side = min(MOST_SIDE, height, width)
    squares = np.square(sight.radiance - reference.radiance)
    weighed = np.divide(squares, reference.scale, out=squares * 0, where=reference.scale > 0)
    mean = weighed.mean()
    found = []
    for top in _starts(height, side):
        for left in _starts(width, side):
            part = slice(top, top + side), slice(left, left + side)
            found.append((abs(float(weighed[part].mean() - mean)), top, left))
    _, top, left = min(found)
    return slice(top, top + side), slice(left, left + side)


def _starts(length: int, side: int) -> list[int]:
    """Starts of parts that overlap by a half."""
    return sorted({min(start, length - side) for start in range(0, length, max(1, side // 2))})
