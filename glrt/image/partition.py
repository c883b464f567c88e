"""A render in parts: ranges of samples that any queue can render and `glrt merge` combines."""

import re
from typing import Self

from pydantic import Field, model_validator

from glrt.core.errors import UsageError
from glrt.core.text import counted
from glrt.settings import MAX_SAMPLES, Frozen, Settings


class Partition(Frozen):
    """The parts of a render that a picture holds.

    The samples of a render are cut between observations into `count` parts, which differ by at most
    one observation. Only the last part can end inside an observation.
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
        """Whether all numbers are those of existing parts, 1 to `count`."""
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
    """One part of a render with these settings; UsageError if there is no such part."""
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
    """The numbers of the samples of a render, or of its one part; UsageError as by `one_part`."""
    if part is None:
        return range(settings.samples)
    one = one_part(part.numbers[0], part.count, settings)
    return sample_range(one, one.numbers[0], settings)


def parse_part(text: str) -> tuple[int, int]:
    """Number and count from `K/N`; ValueError for any other text."""
    match = re.fullmatch(r"(\d{1,7})/(\d{1,7})", text)
    if not match:
        raise ValueError(f"{text!r} is not K/N, such as 3/7")
    number, count = int(match[1]), int(match[2])
    if not count:
        raise ValueError(f"{text!r} has no parts: N must be 1 or more, as in 1/2")
    return number, count
