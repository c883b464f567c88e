"""Rays and points against the triangles of a mesh, on the host."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def winds_around(vertices: Array, faces: NDArray[Any]) -> bool:
    """Return whether triangles wind around the origin (van Oosterom and Strackee 1983).

    `vertices` are (v, 3), `faces` are numbers of vertices, (n, 3).
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    la, lb, lc = (np.linalg.norm(corner, axis=1) for corner in (a, b, c))
    volume = (a * np.cross(b, c)).sum(axis=1)
    rest = la * lb * lc + (a * b).sum(axis=1) * lc
    rest += (b * c).sum(axis=1) * la + (c * a).sum(axis=1) * lb
    turns = abs(np.arctan2(volume, rest).sum()) / (2 * np.pi)
    return bool(turns > 0.5)


def nearest(vertices: Array, faces: NDArray[Any], along: Array, hides_backs: bool) -> float:
    """Return how far a ray from the origin goes to the nearest triangle, in lengths of `along`.

    It is inf for a miss. `vertices` are (v, 3), `faces` are numbers of vertices, (n, 3).
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    u, v, w = (np.cross(x, y) @ along for x, y in ((c, b), (a, c), (b, a)))
    with np.errstate(all="ignore"):
        normal = np.cross(b - a, c - a)
        t = (a * normal).sum(axis=1) / (normal @ along)
        met = ((u >= 0) & (v >= 0) & (w >= 0)) | ((u <= 0) & (v <= 0) & (w <= 0))
        met &= normal @ along < 0 if hides_backs else True
        return float(np.where(met & (t > 0), t, math.inf).min())
