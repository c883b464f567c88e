"""The flat faces of shapes and the edges between them, by which a window draws outlines."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STEPS = 64  # segments of a circle


class Faces(NamedTuple):
    """Flat faces that share edges: `vertices` (v, 3), `edges` (e, 2) and two faces for each edge.

    `neighbours` (e, 2) are numbers of rows of `points` and `normals` (f, 3), -1 for none. The
    normals of some neighbours point to different sides of the surface: their edges are `turned`.
    """

    vertices: Array
    edges: NDArray[np.intp]
    neighbours: NDArray[np.intp]
    turned: NDArray[np.bool_]
    points: Array
    normals: Array


def circle(center: Array, axis: Array, radius: float) -> Array:
    """Return segments of a circle about an axis of length 1, (STEPS, 2, 3)."""
    aside = np.eye(3)[np.argmin(np.abs(axis))]
    u = np.cross(axis, aside)
    u /= np.linalg.norm(u)
    angle = np.linspace(0, 2 * math.pi, STEPS + 1)[:, None]
    ring = center + radius * (np.cos(angle) * u + np.sin(angle) * np.cross(axis, u))
    return np.stack([ring[:-1], ring[1:]], axis=1)


def flat_face(corners: Array) -> Faces:
    """Return one flat face with these corners; each edge is a rim."""
    count = len(corners)
    edges = np.stack([np.arange(count), (np.arange(count) + 1) % count], axis=1)
    neighbours, turned = np.tile([0, -1], (count, 1)), np.zeros(count, bool)
    return Faces(corners, edges, neighbours, turned, corners[:1], np.ones((1, 3)))


def box_faces(middle: Array, halves: Array) -> Faces:
    """Return the faces of a box by its middle and half edges, a row each."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners = middle + signs @ halves
    square = np.array(
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    )
    faces = np.concatenate([square[:, [0, 1, 2]], square[:, [0, 2, 3]]])
    return faces_of_triangles(corners, faces, np.tile(np.arange(6), 2))


def faces_of_triangles(
    vertices: Array, triangles: NDArray[np.intp], flat: NDArray[np.intp] | None = None
) -> Faces:
    """Return triangles, (n, 3), as faces; with one number in `flat`, (n,), they are one face."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    sides = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    owners = np.tile(np.arange(len(triangles)), 3)
    kept = sides[:, 0] != sides[:, 1]  # sides that have a length
    sides, owners = sides[kept], owners[kept]
    goes_up = sides[:, 0] < sides[:, 1]
    sides = np.sort(sides, axis=1)
    order = np.lexsort((sides[:, 1], sides[:, 0]))
    sides, owners, goes_up = sides[order], owners[order], goes_up[order]
    is_first = np.ones(len(sides), bool)
    is_first[1:] = (sides[1:] != sides[:-1]).any(axis=1)
    starts = np.flatnonzero(is_first)
    has_two = np.diff(np.append(starts, len(sides))) == 2
    other = np.minimum(starts + 1, len(sides) - 1)
    neighbours = np.stack([owners[starts], np.where(has_two, owners[other], -1)], axis=1)
    turned = has_two & (goes_up[starts] == goes_up[other])
    shown = np.ones(len(starts), bool)
    if flat is not None:
        shown = ~(has_two & (flat[neighbours[:, 0]] == flat[neighbours[:, 1]]))
    normals = np.cross(b - a, c - a)
    return Faces(vertices, sides[starts][shown], neighbours[shown], turned[shown], a, normals)


def welded(vertices: Array) -> NDArray[np.intp]:
    """Return the first vertex at the place of each one, (v,), so that seams are no rims."""
    _, first, which = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    same: NDArray[np.intp] = first[which.reshape(-1)]
    return same
