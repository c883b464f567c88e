"""A render in parts: ranges of samples that any queue can render and `glrt merge` puts together."""

import re
from typing import Self

from pydantic import Field, model_validator

from glrt.core.errors import UsageError
from glrt.core.text import counted
from glrt.settings import MAX_SAMPLES, Frozen, Settings


class Partition(Frozen):
    """Which parts of a render a picture holds.

    The samples of a render are cut between observations, of 16 samples or of one, into `count`
    parts that differ by one observation at most; only the last part can end inside one.
    """

    count: int = Field(description="parts of the render", ge=1, le=MAX_SAMPLES)
    numbers: tuple[int, ...] = Field(description="the parts that are held, from 1", min_length=1)

    @model_validator(mode="after")
    def _numbers_are_of_parts(self) -> Self:
        if sorted(set(self.numbers)) != [*self.numbers] or not self.is_within:
            raise ValueError(f"{self.numbers} are no parts of {self.count}, each once and in order")
        return self

    @property
    def is_within(self) -> bool:
        """Whether the numbers are those of parts."""
        return self.numbers[0] >= 1 and self.numbers[-1] <= self.count

    @property
    def is_complete(self) -> bool:
        """Whether no part is missing."""
        return len(self.numbers) == self.count

    @property
    def missing(self) -> list[int]:
        """The parts that are not held."""
        return sorted(set(range(1, self.count + 1)) - {*self.numbers})

    def samples(self, settings: Settings) -> int:
        """Samples of each pixel in all parts that are held."""
        return sum(len(sample_range(self, number, settings)) for number in self.numbers)

    def __str__(self) -> str:
        return f"{', '.join(map(str, self.numbers))} of {self.count}"


def one_part(number: int, count: int, settings: Settings) -> Partition:
    """One part of a render with these settings; UsageError where there is no such part."""
    observations = -(-settings.samples // settings.block)
    if not 1 <= number <= count:
        raise UsageError(f"--part {number}/{count}: parts are numbered from 1 to {count}.")
    if count > observations:
        samples, block = (counted(n, "sample") for n in (settings.samples, settings.block))
        raise UsageError(
            f"--part {number}/{count}: {samples} make at most {counted(observations, 'part')}, "
            f"each of {block} or more; give fewer parts or more --samples."
        )
    return Partition(count=count, numbers=(number,))


def sample_range(partition: Partition, number: int, settings: Settings) -> range:
    """The numbers of the samples in a part."""
    block, samples = settings.block, settings.samples
    observations = -(-samples // block)
    first, end = (k * observations // partition.count for k in (number - 1, number))
    return range(block * first, min(block * end, samples))


def wanted_range(part: Partition | None, settings: Settings) -> range:
    """The numbers of the samples that a render wants, or its one part; UsageError as `one_part`."""
    if part is None:
        return range(settings.samples)
    one = one_part(part.numbers[0], part.count, settings)
    return sample_range(one, one.numbers[0], settings)


def parse_part(text: str) -> tuple[int, int]:
    """Number and count from `K/N`; ValueError for anything else."""
    match = re.fullmatch(r"(\d{1,7})/(\d{1,7})", text)
    if not match:
        raise ValueError(f"{text!r} is not K/N, such as 3/7")
    return int(match[1]), int(match[2])
