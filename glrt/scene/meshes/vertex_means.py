"""Normals and tangents of vertices, as means over the triangles around them."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

PORTION = 1 << 18  # triangles that are processed at once, so that memory is bounded


def places(rows: Floats) -> Ints:
    """Return for each row the number of the first equal one, (v,), as of vertices in one place."""
    table = np.ascontiguousarray(rows + 0.0)  # without negative zeros
    whole = table.view(np.dtype((np.void, table.itemsize * table.shape[1]))).ravel()
    _, first, inverse = np.unique(whole, return_index=True, return_inverse=True)
    return first[inverse]


def mean_normals(vertices: Floats, faces: Ints, place: Ints) -> Floats:
    """Return normals, (v, 3), of any length; vertices in the same `place` share theirs.

    Triangles weigh by their angle there (Thuermer and Wuethrich, "Computing Vertex Normals from
    Polygonal Facets", 1998).
    """
    mean = np.zeros((len(place), 3))
    for some in _portions(faces):
        along, angle = corner_angles(vertices[some])
        facing = unit_vectors(np.cross(along[:, 0], along[:, 1]))
        mean += _sums(place[some], angle[:, :, None] * facing[:, None], len(place))
    return mean[place]


def mean_tangents(vertices: Floats, faces: Ints, normals: Floats, uv: Floats) -> Floats:
    """Return unit tangents, (v, 3), along which u of uv, (v, 2), grows; or zero.

    They are perpendicular to unit normals, (v, 3). As in MikkTSpace (Mikkelsen, "Simulation of
    Wrinkled Surfaces Revisited", 2008, appendix A), triangles weigh by their angle, and corners of
    equal place, normal and coordinates share a tangent. It is zero where triangles of both
    orientations share one, and where u grows nowhere.
    """
    alike = places(np.concatenate([vertices, normals, uv], axis=1))
    sums = {sign: np.zeros_like(vertices) for sign in (1.0, -1.0)}
    for some in _portions(faces):
        corners, at = vertices[some], uv[some]
        _, angle = corner_angles(corners)
        one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        u, v = np.moveaxis(at[:, 1:] - at[:, :1], 2, 0)  # (n, 2) each, along both edges
        turn = np.sign(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
        grows = turn[:, None] * (one * v[:, 1:] - other * v[:, :1])
        normal = normals[some]
        flat = unit_vectors(
            grows[:, None] - (grows[:, None] * normal).sum(axis=2, keepdims=True) * normal
        )
        weighted = angle[:, :, None] * flat
        for sign, total in sums.items():
            those = turn == sign
            total += _sums(alike[some[those]], weighted[those], len(alike))
    is_mixed = np.all([total.any(axis=1) for total in sums.values()], axis=0)
    total = sums[1.0] + sums[-1.0]
    total[is_mixed] = 0
    return unit_vectors(total)[alike]


def _portions(faces: Ints) -> Iterator[Ints]:
    return (faces[first : first + PORTION] for first in range(0, len(faces), PORTION))


def corner_angles(corners: Floats) -> tuple[Floats, Floats]:
    """Return unit vectors along edges, (n, 3, 3), and angles, (n, 3), of triangles, (n, 3, 3)."""
    along = unit_vectors(np.roll(corners, -1, axis=1) - corners)
    cosine = -_products(along, np.roll(along, 1, axis=1))
    return along, np.arccos(np.clip(cosine, -1, 1))


def _products(one: Floats, other: Floats) -> Floats:
    """Return scalar products of vectors, (..., 3); numpy takes longer to sum up rows of three."""
    product: Floats = one[..., 0] * other[..., 0]
    for axis in (1, 2):
        product += one[..., axis] * other[..., axis]
    return product


def unit_vectors(vectors: Floats) -> Floats:
    """Return vectors of length 1, or zero where there is no length."""
    length = np.sqrt(_products(vectors, vectors))[..., None]
    unit: Floats = np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)
    return unit


def _sums(at: Ints, rows: Floats, count: int) -> Floats:
    """Return rows, (n, 3, 3), added up by number, (n, 3), as (count, 3)."""
    flat, numbers = rows.reshape(-1, 3), at.ravel()
    columns = [np.bincount(numbers, flat[:, axis], count) for axis in range(3)]
    return np.stack(columns, axis=1)
