"""Weights of the updates of probes, which bring light of all bounces soon.

The light E that probes hold is the solution of E = D + T E. D is the light that comes straight
from lamps, T adds one more bounce. Updates of weight 1 bring one bounce each: after n updates the
share a^n is missing, for an albedo a. Updates E + w (D + T E - E) take their weights w from the
roots of a Chebyshev polynomial. Then as little light as possible is missing after all of them, for
every T whose eigenvalues lie between -a and a (Golub and Varga, Chebyshev semi-iterative methods,
1961).
"""

import math

ALBEDO = 0.95  # up to it, at most a hundredth of the light is missing at the end
STEPS = 16  # a power of two


def _order(steps: int) -> list[int]:
    """An order of the roots in which nothing grows large between (Lebedev and Finogenov 1971)."""
    found = [1]
    while len(found) < steps:
        twice = 2 * len(found) + 1
        found = [number for root in found for number in (root, twice - root)]
    return found


WEIGHTS = [
    1 / (1 + ALBEDO * math.cos(math.pi * (2 * root - 1) / (2 * STEPS))) for root in _order(STEPS)
]
