"""Procedural triangle meshes."""

from typing import Any

import numpy as np

from glrt.scene.files.named_meshes import mesh_of_arrays

Array = np.ndarray[Any, Any]
Faces = tuple[Array, Array]  # vertices (v, 3), faces (n, 3), counter-clockwise seen from outside


def icosphere(steps: int) -> Faces:
    """20 * 4^steps triangles with their corners on the unit sphere."""
    t = (1 + 5**0.5) / 2
    corners = [[0, s * 1, z * t] for s in (-1, 1) for z in (-1, 1)]
    points = np.array([np.roll(corner, k) for k in range(3) for corner in corners], float)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    faces = _hull(points)
    for _ in range(steps):
        points, faces = _subdivided(points, faces)
    return points, faces


def _hull(points: Array) -> Array:
    """The triangles between corners of an icosahedron that are neighbours of each other."""
    near = np.linalg.norm(points[:, None] - points[None], axis=2) < 1.06
    n = len(points)
    found = [
        [a, b, c]
        for a in range(n)
        for b in range(a + 1, n)
        for c in range(b + 1, n)
        if near[a, b] and near[b, c] and near[a, c]
    ]
    return np.array([_outward(points, face) for face in found])


def _outward(points: Array, face: list[int]) -> list[int]:
    a, b, c = points[face]
    return face if np.dot(np.cross(b - a, c - a), a) > 0 else face[::-1]


def _subdivided(points: Array, faces: Array) -> Faces:
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    unique, inverse = np.unique(edges, axis=0, return_inverse=True)
    middle = points[unique].mean(axis=1)
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    new = (inverse.reshape(3, -1) + len(points)).T
    a, b, c = faces.T
    p, q, r = new.T
    four = [[a, p, r], [b, q, p], [c, r, q], [p, q, r]]
    return np.concatenate([points, middle]), np.concatenate([np.stack(f, axis=1) for f in four])


def blob(steps: int) -> Faces:
    """A ball with bumps of three sizes, closed and not convex."""
    points, faces = icosphere(steps)
    x, y, z = points.T
    bumps = 0.15 * np.sin(5 * x) * np.sin(6 * y + 1) * np.sin(4 * z + 2)
    bumps += 0.04 * np.sin(23 * x + 1) * np.sin(19 * y) * np.sin(21 * z)
    return points * (1 + bumps)[:, None], faces


def box(low: Any, high: Any) -> Faces:
    """12 triangles around a box."""
    low, high = np.array(low, float), np.array(high, float)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    sides = np.array(
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    )
    return low + corners * (high - low), np.concatenate([sides[:, [0, 1, 2]], sides[:, [0, 2, 3]]])


def mesh(faces: Faces, material: str, **more: Any) -> dict[str, Any]:
    """An object of a scene, of arrays; with `normals=`, `colors=`, `uv=` those of its vertices."""
    rows = (more.pop(name, None) for name in ("normals", "colors", "uv"))
    file = mesh_of_arrays(*faces, *rows)
    return {"shape": "mesh", "file": file, "material": material, **more}


def quads(*corners: Any) -> Faces:
    """Two triangles each of parallelograms by corner and edges, (3, 3) each."""
    points, faces = [], []
    for number, (corner, u, v) in enumerate(np.array(corners, float)):
        points += [corner, corner + u, corner + u + v, corner + v]
        faces += [[4 * number + k for k in three] for three in ([0, 1, 2], [0, 2, 3])]
    return np.array(points), np.array(faces)
