"""The result of a comparison of two pictures."""

from dataclasses import dataclass
from typing import Literal, NamedTuple

from glrt.comparison.noise import Array

Verdict = Literal["same", "different", "undecided"]

CHANNELS = ("red", "green", "blue")


def percent(share: float, digits: int = 2, sign: str = "") -> str:
    """A share in percent, never with an exponent below a million percent."""
    return f"{float(f'{100 * share:.{digits}g}'):{sign}g} %"


class Interval(NamedTuple):
    """A relative difference, image / reference - 1, and between what the truth lies."""

    difference: float
    low: float
    high: float


class Place(NamedTuple):
    """Pixels of a channel, counted from the left and from the top."""

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


@dataclass(frozen=True, eq=False)
class Comparison:
    """The result of `compare`; false in a condition if the pictures differ.

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
    worst: Place  # that block
    pixel: Place  # in it, the pixel that differs most
    shown: float  # the smallest relative difference of a whole picture that is found
    needs: int | None  # samples a pixel of both that would find `bias`; None: unknown
    alike: bool  # both draw their samples in the same way
    block_scores: Array  # (rows, columns, 3)
    pixel_scores: Array  # (H, W, 3), to locate alone: where hits are rare, they are no evidence

    def __bool__(self) -> bool:
        return self.verdict != "different"

    def __str__(self) -> str:
        if self.verdict == "different":
            return f"different: {'; '.join(self.reasons)}"
        if self.verdict == "same":
            return f"same: a difference of {percent(self.bias)} would have shown"
        missing = f"{self.needs} samples in both" if self.needs else "more samples"
        return f"undecided: needs {missing} to show a difference of {percent(self.bias)}"
