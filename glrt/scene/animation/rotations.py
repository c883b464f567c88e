"""Quaternions (x, y, z, w), the angles that turn as they do, and what lies between two."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

QUATERNION = 4  # numbers
_STRAIGHT = 1 - 1e-9  # cosine between two quaternions above which their chord is their arc


def unit(quaternion: Array) -> Array:
    """Return a quaternion of length 1, (4,)."""
    turned: Array = quaternion / np.linalg.norm(quaternion)
    return turned


def slerp(start: Array, end: Array, share: float) -> Array:
    """Return the rotation at a share of the shorter way between two, (4,) (Shoemake 1985)."""
    start, end = unit(start), unit(end)
    cosine = float(start @ end)
    if cosine < 0:
        end, cosine = -end, -cosine  # the same rotation, the shorter way round
    if cosine > _STRAIGHT:
        return unit((1 - share) * start + share * end)
    angle = math.acos(cosine)
    return unit(math.sin((1 - share) * angle) * start + math.sin(share * angle) * end)


def matrix(quaternion: Sequence[float] | Array) -> Array:
    """Return the matrix, (3, 3), that turns columns as a quaternion, (4,), of any length does."""
    x, y, z, w = (float(part) for part in quaternion)
    length = (x * x + y * y + z * z + w * w) ** 0.5
    x, y, z, w = (part / length for part in (x, y, z, w))
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def of_angles(degrees: Sequence[float]) -> Array:
    """Return the quaternion, (4,), that turns as degrees about the x, then the y, then the z axis.

    So `rotate` of an object turns; its w is not below 0.
    """
    found = np.array([0.0, 0.0, 0.0, 1.0])
    for axis, angle in enumerate(np.radians(degrees)):
        turn = np.zeros(QUATERNION)
        turn[axis], turn[3] = math.sin(angle / 2), math.cos(angle / 2)
        found = _product(turn, found)
    return found if found[3] >= 0 else -found


def _product(second: Array, first: Array) -> Array:
    """Return the quaternion that turns by the first and then by the second."""
    vector = second[3] * first[:3] + first[3] * second[:3] + np.cross(second[:3], first[:3])
    return np.array([*vector, second[3] * first[3] - second[:3] @ first[:3]])


def angles(quaternion: Array) -> Array:
    """Return degrees about the x, then the y, then the z axis, (3,), that turn as a quaternion."""
    return angles_of(matrix(quaternion))


def angles_of(turn: Array) -> Array:
    """Return degrees about the x, then the y, then the z axis, (3,), that turn as a matrix, (3, 3).

    They are what `rotate` of an object takes. With y at 90 degrees only the sum or the difference
    of the others counts; then the last is 0.
    """
    level = math.hypot(turn[0, 0], turn[1, 0])
    y = math.atan2(-turn[2, 0], level)
    if level < _LEVEL:
        return np.degrees([math.atan2(-turn[1, 2], turn[1, 1]), y, 0.0])
    x, z = math.atan2(turn[2, 1], turn[2, 2]), math.atan2(turn[1, 0], turn[0, 0])
    return np.degrees([x, y, z])


_LEVEL = 1e-12  # cosine of y below which the angles about x and z turn about one axis
