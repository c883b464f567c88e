"""Polygons with any number of corners, divided into triangles."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_ROUNDING = (
    1e-9  # sine of the angle by which a corner of a convex polygon may seem to point inwards
)


def triangulated(points: Floats, corners: Ints, counts: Ints) -> tuple[Ints, Ints]:
    """Return triangles as numbers of corners, (n, 3), and the polygon of each, (n,), in order.

    `corners`, (c,), are numbers of points, (v, 3), of all polygons one after another; `counts`,
    (p,), says how many each has, three at least. Convex polygons become fans around their first
    corners, others are divided by ear clipping. Every edge of a polygon is an edge of a triangle.
    """
    starts = np.cumsum(counts) - counts
    triangles, owners = list[Ints](), list[Ints]()
    for count in np.unique(counts):
        polygons = np.flatnonzero(counts == count)
        rows = starts[polygons, None] + np.arange(count)
        is_convex = np.ones(len(rows), bool) if count == 3 else _convex(points[corners[rows]])
        fans = _fans(rows[is_convex])
        triangles.append(fans)
        owners.append(np.repeat(polygons[is_convex], count - 2))
        for polygon, row in zip(polygons[~is_convex], rows[~is_convex], strict=True):
            clipped = row[_clipped(points[corners[row]])]
            triangles.append(clipped)
            owners.append(np.full(len(clipped), polygon))
    if not triangles:
        return np.zeros((0, 3), np.int64), np.zeros(0, np.int64)
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return np.concatenate(triangles)[order], owner[order]


def _fans(rows: Ints) -> Ints:
    """Return polygons of k corners each, (n, k), as triangles around their first corners."""
    fans = [rows[:, [0, k, k + 1]] for k in range(1, rows.shape[1] - 1)]
    return np.stack(fans, axis=1).reshape(-1, 3)


def _normals(polygons: Floats) -> Floats:
    """Return normals of polygons, (n, k, 3), as long as their doubled areas (Newell's method)."""
    arms = polygons - polygons[:, :1]
    normals: Floats = np.cross(arms[:, 1:-1], arms[:, 2:]).sum(axis=1)
    return normals


def _convex(polygons: Floats) -> NDArray[np.bool_]:
    """Return whether no corner of polygons, (n, k, 3), points inwards or turns back, (n,)."""
    ahead = np.roll(polygons, -1, axis=1) - polygons
    behind = np.roll(ahead, 1, axis=1)
    normals = _normals(polygons)
    turns = (np.cross(behind, ahead) * normals[:, None]).sum(axis=2)
    sizes = np.linalg.norm(ahead, axis=2) * np.linalg.norm(behind, axis=2)
    limit = _ROUNDING * sizes * np.linalg.norm(normals, axis=1)[:, None]
    turns_back = (np.abs(turns) <= limit) & ((ahead * behind).sum(axis=2) < 0)
    wrong: NDArray[np.bool_] = ((turns < -limit) | turns_back).any(axis=1)
    return ~wrong


def _clipped(polygon: Floats) -> Ints:
    """Return a polygon, (k, 3), as triangles of its corners, (n, 3), that face as it does."""
    from mapbox_earcut import triangulate_float64

    normal = _normals(polygon[None])[0]
    axis = int(np.abs(normal).argmax())
    flat = np.delete(polygon, axis, axis=1)
    ends = np.array([len(flat)], np.uint32)
    found = triangulate_float64(np.ascontiguousarray(flat), ends).reshape(-1, 3).astype(np.int64)
    if not len(found):
        return _fans(np.arange(len(polygon))[None])
    arms = polygon[found[:, 1:]] - polygon[found[:, :1]]
    faces_back = (np.cross(arms[:, 0], arms[:, 1]) @ normal) < 0
    found[faces_back] = found[faces_back, ::-1]
    return np.concatenate([found, _on_edges(found, len(polygon))])


def _on_edges(triangles: Ints, count: int) -> Ints:
    """Return flat triangles for corners that a triangulation left out, as the tips of spikes.

    With them the mesh stays closed where a neighbour has these corners.
    """
    used = np.zeros(count, bool)
    used[triangles] = True
    kept = np.flatnonzero(used)
    gaps = zip(kept, np.roll(kept, -1), strict=True)
    rows = list[tuple[int, int, int]]()
    for start, end in gaps:
        between = [int(start + k) % count for k in range(1, (end - start) % count)]
        way = [*between, int(end)]
        rows += [(int(start), a, b) for a, b in pairwise(way)]
    return np.array(rows, np.int64).reshape(-1, 3)
