"""Meshes of a scene, and shapes as meshes, as other programs read them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.export.placing import Placing, around, normal_of
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane

Floats = NDArray[np.float64]

# Lines of the grid that stands for a plane, over the extent of the scene. It is so large that the
# gap to the horizon is a small part of a pixel. Its outer cells are larger, since other programs
# know a point on a triangle to a part of the triangle's size; few, since they cost time.
_LINES = np.array([-(2.0**15), -8.0, 8.0, 2.0**15])


class Form(NamedTuple):
    """Triangles, counter-clockwise seen from outside."""

    points: Floats  # (v, 3)
    faces: NDArray[np.int64]  # (n, 3)
    normals: Floats | None = None  # (v, 3) unit; None: facets
    uv: Floats | None = None  # (v, 2), v downwards


def form_of(item: Mesh, uv_set: int = 0) -> Form:
    """Return the triangles of a mesh in coordinates of its file, with one set of coordinates."""
    mesh, normals = item.triangles, None
    if item.smooth:
        given = np.asarray(mesh.shading_normals, np.float64)
        sizes = np.linalg.norm(given, axis=1, keepdims=True)
        upright = np.tile([0.0, 0.0, 1.0], (len(given), 1))  # for normals of length 0
        normals = np.divide(given, sizes, out=upright, where=sizes > 0)
    uv = None if mesh.uv is None else mesh.uv[:, 2 * uv_set : 2 * uv_set + 2]
    return Form(mesh.vertices, mesh.faces, normals, uv)


def grid_of_plane(item: Plane, at: Placing, reach: float | None = None) -> Form:
    """Return a plane as a grid around the foot of the origin, in other coordinates.

    With `reach` it is one cell that ends there, over the extent of the scene.
    """
    normal = normal_of(item)
    u, v = around(normal)
    foot = np.dot(at.point(item.point), normal) * normal
    lines = at.extent * (np.array([-reach, reach]) if reach else _LINES)
    points = np.array([foot + x * u + y * v for y in lines for x in lines])
    side = len(lines)
    cells = [y * side + x for y in range(side - 1) for x in range(side - 1)]
    first = [[cell, cell + 1, cell + side + 1] for cell in cells]
    second = [[cell, cell + side + 1, cell + side] for cell in cells]
    axes = item.texture_axes
    uv = (points / at.factor + at.origin - axes.origin) @ np.stack([axes.u, axes.v], axis=1)
    return Form(points, np.array(first + second), None, uv)
