"""How much of what an update brings the probes take, so that light of all bounces comes soon.

The light E that probes hold is the solution of E = D + T E, D the light that comes straight from
lamps and T one more bounce. To take each update whole brings one bounce more: after n of them the
share a^n is missing, for an albedo a. With weights w that follow from the roots of a Chebyshev
polynomial, E + w (D + T E - E), what is missing after all of them is as small as can be, for every
T whose eigenvalues lie between -a and a (Golub and Varga, Chebyshev semi-iterative methods, 1961).
"""

import math

ALBEDO = 0.95  # up to it all but a hundredth of the light is there at the end
STEPS = 16  # a power of two


def _order(steps: int) -> list[int]:
    """Of the roots, so that nothing grows large between (Lebedev and Finogenov 1971)."""
    found = [1]
    while len(found) < steps:
        twice = 2 * len(found) + 1
        found = [number for root in found for number in (root, twice - root)]
    return found


WEIGHTS = [
    1 / (1 + ALBEDO * math.cos(math.pi * (2 * root - 1) / (2 * STEPS))) for root in _order(STEPS)
]
