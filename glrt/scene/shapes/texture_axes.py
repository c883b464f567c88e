"""Axes of texture coordinates of flat shapes."""

from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray[Any, np.dtype[np.float64]]

_STEEPEST = 0.999  # largest |y| of the normal of a wall


class TextureAxes(NamedTuple):
    """Axes of texture coordinates: a point p has u . (p - origin) and v . (p - origin)."""

    origin: Array  # (3,)
    u: Array  # (3,)
    v: Array  # (3,)


def axes_across(normal: Any) -> tuple[Array, Array]:
    """Return unit vectors u and v across a normal, (3,): v leads down, or along z on floors."""
    n = np.array(normal, np.float64) / np.linalg.norm(normal)
    down = np.array([0.0, -1.0, 0.0])
    if abs(n[1]) > _STEEPEST:
        down = np.array([0.0, 0.0, np.copysign(1.0, n[1])])
    v = down - (down @ n) * n
    v /= np.linalg.norm(v)
    return np.cross(n, v), v
