"""The result of a comparison of two pictures."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

from glrt.comparison.regions import BLOCK, Array
from glrt.comparison.sensitivity import Sensitivity
from glrt.core.text import escaped

Verdict = Literal["same", "different", "undecided"]

UNSEEN = 10.0  # times the light: a picture that misses a change so large shows nothing
CHANNELS = ("red", "green", "blue")


def percent(share: float, digits: int = 2, sign: str = "") -> str:
    """A share in percent, never with an exponent below a million percent."""
    return f"{float(f'{100 * share:.{digits}g}'):{sign}g} %"


class Interval(NamedTuple):
    """A relative difference, image / reference - 1, and the interval in which the truth lies."""

    difference: float
    low: float
    high: float


class Place(NamedTuple):
    """A pixel or block of one channel; x is counted from the left and y from the top."""

    channel: str
    x: int
    y: int
    width: int = 1
    height: int = 1

    def __str__(self) -> str:
        if self.width == self.height == 1:
            return f"{self.channel} at x {self.x}, y {self.y}"
        right, bottom = self.x + self.width - 1, self.y + self.height - 1
        return f"{self.channel} at x {self.x} to {right}, y {self.y} to {bottom}"


class HeavyTails(NamedTuple):
    """Rare light in one of two pictures: its errors are too small where it has not met any."""

    picture: str  # "image" or "reference"
    pixels: int  # pixels that have met it
    share: float  # fraction of the noise that is in these pixels

    def __str__(self) -> str:
        return (
            f"{self.pixels} pixels of the {self.picture} carry {percent(self.share)} of its noise: "
            "rare light, which other pixels may have missed"
        )


@dataclass(frozen=True, eq=False, repr=False)
class Comparison:
    """The result of `compare`; false in a condition if the pictures differ.

    `str` is the verdict in one line; `repr`, which notebooks show, is the report of `glrt compare`.

    A score is the number of standard errors of a normal distribution that is as unlikely: about 1
    by chance. Pixels that are NaN or infinite are left out of all figures.
    """

    verdict: Verdict
    reasons: tuple[str, ...]  # why they differ; empty otherwise
    alpha: float  # largest share of equal pictures that are called different
    bias: float  # the relative difference that "same" excludes
    means: tuple[tuple[float, float], ...]  # of image and reference, for each channel
    differences: tuple[Interval, ...]  # of the means; all hold together at 1 - alpha
    factors: tuple[Interval, ...]  # of blocks weighted by 1 / noise; () if the methods may differ
    spread: float  # root mean square of the scores of blocks
    limit: float  # a block with a score beyond it differs
    largest: float  # score of the worst block
    worst: Place  # the block with that score
    pixel: Place  # in it, the pixel that differs most
    sensitivity: Sensitivity  # the smallest relative changes that are found
    heavy_tails: HeavyTails | None  # why the noise that a picture claims is not believed
    needs: int | None  # samples a pixel of both that would find `bias`; None: unknown
    alike: bool  # both draw their samples in the same way
    block_scores: Array  # (rows, columns, 3)
    pixel_scores: Array  # (H, W, 3), to locate alone: where hits are rare, they are no evidence

    def __bool__(self) -> bool:
        return self.verdict != "different"

    def __repr__(self) -> str:
        return _report(self)

    def __str__(self) -> str:
        if self.verdict == "different":
            return f"different: {'; '.join(self.reasons)}"
        change = f"a change of {'each' if self.sensitivity.groups else 'all'} light"
        if self.verdict == "same":
            return f"same: {change} by {percent(self.bias)} would have been found"
        if self.heavy_tails:
            return f"undecided: heavy tails: {self.heavy_tails}"
        missing = f"{self.needs} samples in both" if self.needs else "more samples"
        return f"undecided: needs {missing} to find {change} by {percent(self.bias)}"


def _report(c: Comparison) -> str:
    """The report of `glrt compare`: verdict and figures."""
    sure = f"{100 * (1 - c.alpha):g} % interval"
    lines = [str(c), "", _row("mean", "image", "reference", "difference", sure)]
    rows = zip(CHANNELS, c.means, c.differences, strict=True)
    lines += [_row(name, *(f"{m:.5g}" for m in means), *_percent(d)) for name, means, d in rows]
    if c.factors:
        lines += ["", "weighted by 1 / noise, which best shows a factor between the pictures:"]
        rest = zip(CHANNELS, c.factors, strict=True)
        lines += [_row(name, "", "", *_percent(factor)) for name, factor in rest]
    else:
        lines += ["", "The methods may differ: each picture is judged by its own noise."]
    lines += [
        "",
        f"{BLOCK} x {BLOCK} blocks: spread {c.spread:.2f} of 1 expected; largest "
        f"{c.largest:+.2f} of {c.limit:.2f} allowed, {c.worst}",
        f"its worst pixel: {c.pixel}",
        "",
        "smallest change that would have been found, 19 times in 20:",
        *_changes(c.sensitivity),
    ]
    return "\n".join(lines)


def _changes(found: Sensitivity) -> Iterator[str]:
    """Yield a row for each kind of change."""
    yield f"  all light on surfaces  {_known(found.light)}"
    for name, size in found.groups.items():
        yield f"  light group {escaped(name)}  {_known(size)}"
    yield f"  one {BLOCK} x {BLOCK} block, in 19 of 20 places  {_known(found.block)}"


def _known(size: float) -> str:
    """A relative change in percent; from UNSEEN on, in words."""
    return percent(size) if size < UNSEEN else "none: too much noise"


def _row(*cells: str) -> str:
    return "{:<7}{:>11}{:>11}  {:>11}   {}".format(*cells)


def _percent(interval: Interval) -> tuple[str, str]:
    difference, low, high = (
        percent(value, digits=3, sign="+") if math.isfinite(value) else "unknown"
        for value in interval
    )
    return difference, f"{low} to {high}" if low != high else low
