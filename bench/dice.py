"""Random numbers that are the same on every machine."""

import math
from collections.abc import Sequence
from typing import TypeVar

import numpy as np

Item = TypeVar("Item")


class Dice:
    """Random values, all derived from doubles of PCG64, whose bits are the same everywhere."""

    def __init__(self, seed: int) -> None:
        """Equal seeds give equal sequences."""
        self._random = np.random.Generator(np.random.PCG64(seed)).random

    def within(self, low: float, high: float) -> float:
        """A number, uniform from `low` to `high`."""
        return low + (high - low) * float(self._random())

    def decades(self, low: float, high: float) -> float:
        """A number whose logarithm is uniform."""
        return math.exp(self.within(math.log(low), math.log(high)))

    def count(self, low: int, high: int) -> int:
        """A whole number, ends included, about log-uniform: each octave is equally likely."""
        return min(high, int(self.decades(low, high + 1)))

    def chance(self, probability: float) -> bool:
        """True with this probability."""
        return float(self._random()) < probability

    def one_of(self, items: Sequence[Item]) -> Item:
        """One of the items, all equally likely."""
        return items[int(len(items) * float(self._random()))]

    def direction(self) -> tuple[float, float, float]:
        """A unit vector, uniform over the sphere."""
        y, angle = self.within(-1, 1), self.within(0, 2 * math.pi)
        r = math.sqrt(1 - y * y)
        return (r * math.cos(angle), y, r * math.sin(angle))
