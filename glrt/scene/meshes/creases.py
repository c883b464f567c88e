"""Normals at the corners of triangles, where edges may be sharp."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.meshes.vertex_means import corner_angles, places, unit_vectors

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST_AT_A_VERTEX = 4096  # triangles: around a vertex with more, all share one normal
_PAIRS = 1 << 22  # pairs of corners that are compared at once, so that memory is bounded


class Split(NamedTuple):
    """Vertices with a normal each; one given vertex may become several."""

    vertex: Ints  # (w,): numbers of the given vertices
    normals: Floats  # (w, 3), of any length
    faces: Ints  # (n, 3): numbers of the new vertices


def by_groups(vertices: Floats, faces: Ints, given: Floats | None, groups: Ints) -> Split:
    """Return normals by smoothing groups, (n,): flat in group 0, means within each of the others.

    Normals that are `given`, (v, 3), are kept where they are not 0.
    """
    weighted, facing = _weighted(vertices, faces)
    place = places(vertices)[faces]
    key = np.unique(place * (groups.max(initial=0) + 1) + groups[:, None], return_inverse=True)[1]
    key = key.reshape(-1)
    sums = [np.bincount(key, weighted[..., axis].ravel()) for axis in range(3)]
    means = np.stack(sums, axis=1)[key].reshape(-1, 3, 3)
    is_flat = (groups == 0)[:, None, None]
    return _split(faces, np.where(is_flat, facing[:, None], means), given)


def by_angle(vertices: Floats, faces: Ints, given: Floats | None, degrees: float) -> Split:
    """Return normals that are means over the triangles within an angle of each triangle's own.

    Normals that are `given`, (v, 3), are kept where they are not 0.
    """
    weighted, facing = _weighted(vertices, faces)
    place = places(vertices)[faces].ravel()
    order = np.argsort(place, kind="stable")
    _, starts, counts = np.unique(place[order], return_index=True, return_counts=True)
    rows, owners = weighted.reshape(-1, 3), facing.repeat(3, axis=0)
    means = np.zeros_like(rows)
    for some, count in _portions(starts, counts):
        corners = order[some[:, None] + np.arange(count)]
        if count > MOST_AT_A_VERTEX:
            means[corners] = rows[corners].sum(axis=1, keepdims=True)
            continue
        facings = owners[corners]
        cosines = facings @ facings.transpose(0, 2, 1)
        is_near = cosines >= math.cos(math.radians(degrees)) - _ROUNDING
        means[corners] = is_near.astype(np.float64) @ rows[corners]
    return _split(faces, means.reshape(-1, 3, 3), given)


_ROUNDING = 1e-9  # of cosines


def _weighted(vertices: Floats, faces: Ints) -> tuple[Floats, Floats]:
    """Return unit normals of triangles times their angles, (n, 3, 3), and without, (n, 3)."""
    along, angle = corner_angles(vertices[faces])
    facing = unit_vectors(np.cross(along[:, 0], along[:, 1]))
    return angle[:, :, None] * facing[:, None], facing


def _portions(starts: Ints, counts: Ints) -> Iterator[tuple[Ints, int]]:
    """Yield places with equally many corners, by where their corners begin, and that number."""
    for count in np.unique(counts):
        some = starts[counts == count]
        step = max(1, _PAIRS // int(count) ** 2)
        yield from ((some[k : k + step], int(count)) for k in range(0, len(some), step))


def _split(faces: Ints, normals: Floats, given: Floats | None) -> Split:
    """Return a vertex for each pair of a vertex and a normal at its corners, (n, 3, 3)."""
    if given is not None:
        own = given[faces]
        normals = np.where(own.any(axis=2, keepdims=True), own, normals)
    rows = normals.reshape(-1, 3)
    keys = faces.ravel() * len(rows) + places(rows)
    _, first, number = np.unique(keys, return_index=True, return_inverse=True)
    return Split(faces.ravel()[first], rows[first], number.reshape(-1, 3))
