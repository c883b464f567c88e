"""Values between keys: steps, straight lines, cubic curves, and arcs between rotations."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from glrt.scene.animation.rotations import slerp, unit

Array = NDArray[np.float64]
Interpolation = Literal["linear", "step", "cubic"]

QUATERNION = 4  # numbers of a value that is a rotation


def between(
    times: Sequence[float],
    values: Array,
    moment: float,
    interpolation: Interpolation,
    is_rotation: bool = False,
) -> Array:
    """Return the value at a moment, (k,), from n keys at increasing times, (n, k).

    Before the first key and after the last their values hold. Rotations are quaternions: linear
    then follows the arc, and the result has length 1.
    """
    last = len(times) - 1
    key = int(np.searchsorted(times, moment, side="right")) - 1
    if interpolation == "step" or key < 0 or key == last:
        held: Array = values[max(key, 0)]
        return held
    span = times[key + 1] - times[key]
    share = (moment - times[key]) / span
    if interpolation == "linear":
        if is_rotation:
            return slerp(values[key], values[key + 1], share)
        line: Array = (1 - share) * values[key] + share * values[key + 1]
        return line
    rows = aligned(values) if is_rotation else values
    curve = hermite(rows[key : key + 2], span * slopes(times, rows)[key : key + 2], share)
    return unit(curve) if is_rotation else curve


def aligned(quaternions: Array) -> Array:
    """Return the same rotations, (n, 4), each with the sign nearer to the one before."""
    signs = np.where((quaternions[1:] * quaternions[:-1]).sum(axis=1) < 0, -1.0, 1.0)
    turned: Array = quaternions * np.cumprod([1.0, *signs])[:, None]
    return turned


def slopes(times: Sequence[float], values: Array) -> Array:
    """Return slopes at n keys, (n, k): of the chord between the neighbours (Catmull, Rom 1974)."""
    before = np.maximum(np.arange(len(times)) - 1, 0)
    after = np.minimum(np.arange(len(times)) + 1, len(times) - 1)
    moments = np.asarray(times, np.float64)
    chords: Array = (values[after] - values[before]) / (moments[after] - moments[before])[:, None]
    return chords


def hermite(ends: Array, tangents: Array, share: float) -> Array:
    """Return a cubic at a share of its way, (k,), from its ends and tangents, (2, k) each."""
    square, cube = share * share, share * share * share
    curve: Array = (
        (2 * cube - 3 * square + 1) * ends[0]
        + (cube - 2 * square + share) * tangents[0]
        + (3 * square - 2 * cube) * ends[1]
        + (cube - square) * tangents[1]
    )
    return curve
