"""A method with a limit of bounces: its measured bias and noise, and its cost."""

import math
from dataclasses import dataclass
from typing import NamedTuple

from glrt.settings import Settings

_SIGMAS = 2.0  # half width of intervals, in standard errors


class Bias(NamedTuple):
    """A squared relative bias with its standard error over pixels."""

    squared: float
    stderr: float

    @property
    def value(self) -> float:
        """The bias; 0 if the estimate of its square is negative."""
        return math.sqrt(max(self.squared, 0.0))

    @property
    def least(self) -> float:
        """Lower bound of the bias at a confidence of 97.5 %."""
        return math.sqrt(max(self.squared - _SIGMAS * self.stderr, 0.0))

    @property
    def most(self) -> float:
        """Upper bound of the bias at a confidence of 97.5 %."""
        return math.sqrt(max(self.squared + _SIGMAS * self.stderr, 0.0))


class OfProbes(NamedTuple):
    """The cost of probes for a picture of any number of pixels: work and seconds."""

    work_of_set: float = 0.0
    seconds_of_set: float = 0.0
    work_once: float = 0.0
    seconds_once: float = 0.0


NO_PROBES = OfProbes()


@dataclass(frozen=True)
class Candidate:
    """A method with a limit of bounces, its measured bias and variance, and its counted work."""

    name: str
    settings: Settings  # for the requested frame
    bias: Bias
    variance: float  # relative, of one sample: upper bound at a confidence of 97.5 %
    work_per_sample: float  # work of a sample of one pixel
    seconds_per_sample: float  # time of a sample of each pixel of the requested frame; only shown
    probes: OfProbes = NO_PROBES

    def samples_to(self, error: float) -> int | None:
        """Samples per pixel to reach an error; None if the bias is not known to be below it.

        A multiple of the block of the sampler: the samples of an incomplete block are noisier.
        """
        room = error**2 - self.bias.most**2
        block = self.settings.block
        return block * max(1, math.ceil(self.variance / room / block)) if room > 0 else None

    def work_to(self, error: float) -> float:
        """Work of a pixel to reach an error; infinite if `samples_to` is None."""
        samples, probes = self.samples_to(error), self.probes
        if samples is None:
            return math.inf
        fixed = self._sets(samples) * probes.work_of_set + probes.work_once
        return samples * self.work_per_sample + fixed / math.prod(self.settings.size)

    def seconds_of(self, samples: int) -> float:
        """Approximate time of `samples` per pixel, in seconds."""
        fixed = self._sets(samples) * self.probes.seconds_of_set + self.probes.seconds_once
        return samples * self.seconds_per_sample + fixed

    def _sets(self, samples: int) -> int:
        """Number of sets of probes: each lights a block of samples."""
        return math.ceil(samples / self.settings.block)
