"""The smallest change that a comparison would have found, for several kinds of change."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from glrt.comparison.noise import CALM, Pair, Sums
from glrt.comparison.regions import Array, ratio_of

Flags = NDArray[np.bool_]

POWER = 0.95  # a change "would have been found" if it is found so often
LEAST_LIGHT = 0.01  # of all light: less of it is not representative


@dataclass(frozen=True)
class Sensitivity:
    """The smallest relative changes that are found 19 times in 20; infinite where none is.

    `light`: of all light that surfaces reflect. `block`: of one block of 8 x 8 pixels, in 19 of 20
    blocks with light. `groups`: of the light of each group on surfaces, where that is known.
    """

    light: float
    block: float
    groups: Mapping[str, float] = field(default_factory=dict)

    @property
    def worst(self) -> float:
        """The change of all light, or of the light group that is the hardest to find."""
        return max(self.light, *self.groups.values()) if self.groups else self.light


def sensitivity(
    pair: Pair, tests: list[tuple[Sums, float]], groups: Mapping[str, Array]
) -> Sensitivity:
    """The smallest changes that `tests` find: sums with the score from which on they differ.

    The last test is that of blocks. `groups` are the radiance of each light group alone, (H, W, 3).
    A group without light is left out.
    """
    blocks, limit = tests[-1]
    is_noisy = has_noise(pair)
    lit = {name: light * is_noisy for name, light in groups.items() if light.any()}
    return Sensitivity(
        light=_least(tests, pair.level * is_noisy),
        block=_of_most(blocks.factor_found(pair.level, limit, POWER)),
        groups={name: _least(tests, light) for name, light in lit.items()},
    )


def has_noise(pair: Pair) -> Flags:
    """Where the light is that of surfaces, (H, W, 3); everywhere if that is hardly any.

    Lamps and sky that the camera sees directly have hardly any noise. They would show the smallest
    change, which says nothing about the light on surfaces.
    """
    noise = ratio_of(np.sqrt(pair.shuffled_variance), np.abs(pair.level))
    usual = np.quantile(noise[noise > 0], 0.9) if noise.any() else 0.0
    found = noise > CALM * usual
    light = pair.level[found].sum()
    return found if light > LEAST_LIGHT * pair.level.sum() else np.ones_like(found)


def _least(tests: list[tuple[Sums, float]], change: Array) -> float:
    return min(float(sums.factor_found(change, limit, POWER).min()) for sums, limit in tests)


def _of_most(factors: Array) -> float:
    """The change that 19 of 20 blocks find, each by the channel that shows it best."""
    best = factors.min(axis=-1).ravel()
    return float(np.quantile(best, POWER, method="higher"))
