"""Chance that is the same on every machine."""

import math
from collections.abc import Sequence
from typing import TypeVar

import numpy as np

Item = TypeVar("Item")


class Dice:
    """Chance; all of it comes from doubles of PCG64, whose bits are the same everywhere."""

    def __init__(self, seed: int) -> None:
        """The same dice for the same seed."""
        self._random = np.random.Generator(np.random.PCG64(seed)).random

    def within(self, low: float, high: float) -> float:
        """Uniform."""
        return low + (high - low) * float(self._random())

    def decades(self, low: float, high: float) -> float:
        """Uniform in the logarithm."""
        return math.exp(self.within(math.log(low), math.log(high)))

    def count(self, low: int, high: int) -> int:
        """A whole number, both ends included; small ones are as likely as large ones."""
        return min(high, int(self.decades(low, high + 1)))

    def chance(self, probability: float) -> bool:
        """Whether it happens."""
        return float(self._random()) < probability

    def one_of(self, items: Sequence[Item]) -> Item:
        """Any of them."""
        return items[int(len(items) * float(self._random()))]

    def direction(self) -> tuple[float, float, float]:
        """Uniform over the sphere."""
        y, angle = self.within(-1, 1), self.within(0, 2 * math.pi)
        r = math.sqrt(1 - y * y)
        return (r * math.cos(angle), y, r * math.sin(angle))
