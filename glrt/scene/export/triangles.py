"""Shapes as triangles with normals and texture coordinates."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.shapes.base import UP
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

AROUND = 96  # corners of what is round, at most
_FEWEST = 12
_ROUND_IN_ALL = 1_000_000  # triangles of all that is round
# Lines of the grid that stands for a plane, over the scene's radius. Its middle cell holds the
# scene and is small, since programs know a point on a triangle to a part of the triangle's size.
_LINES = np.array([-100.0, -2.0, 2.0, 100.0])


class Triangles(NamedTuple):
    """Triangles, counter-clockwise seen from outside."""

    points: Floats  # (v, 3)
    faces: Ints  # (n, 3)
    normals: Floats | None  # (v, 3) unit; None for facets
    uv: Floats | None = None  # (v, 2), v downwards; None without


def corners_around(count: int) -> int:
    """Return how many corners a round shape has, of `count` in a scene: an even number.

    A sphere of n corners around has about n^2 triangles.
    """
    most = math.isqrt(_ROUND_IN_ALL // max(count, 1))
    return max(_FEWEST, min(AROUND, most - most % 2))


class Ball(NamedTuple):
    """A ball that holds a scene, without the far parts of planes."""

    center: Floats
    radius: float


def triangles_of(shape: Any, scene: Ball, around: int = AROUND) -> Triangles | None:
    """Return the triangles of an analytic shape in scene units; None for a kind without any.

    A plane becomes a square of 100 times the radius of the scene, about the point next to its
    center. Round shapes have `around` corners.
    """
    if isinstance(shape, Quad):
        given = shape.corner, shape.edge_u, shape.edge_v
        corner, u, v = (np.array(it, np.float64) for it in given)
        return _square(corner, u, v, np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]))
    if isinstance(shape, Plane):
        return _plane(shape, scene)
    if isinstance(shape, Box):
        return _box(shape)
    if isinstance(shape, Disk):
        axis = np.array(shape.normal, np.float64) / np.linalg.norm(shape.normal)
        found = _fan(np.array(shape.center, np.float64), axis, shape.radius, around)
        axes = shape.texture_axes
        uv = (found.points - axes.origin) @ np.stack([axes.u, axes.v], axis=1)
        return found._replace(uv=uv)
    if isinstance(shape, Cylinder):
        return _cylinder(shape, around)
    return _sphere(shape, around) if isinstance(shape, Sphere) else None


def _square(corner: Floats, u: Floats, v: Floats, uv: Floats) -> Triangles:
    points = corner + np.array([0 * u, u, u + v, v])
    normal = np.cross(u, v)
    normals = np.tile(normal / np.linalg.norm(normal), (4, 1))
    return Triangles(points, np.array([[0, 1, 2], [0, 2, 3]]), normals, uv)


def _box(shape: Box) -> Triangles:
    """Return the faces, whose corners are equal where they meet."""
    polygons, middle = shape.polygons, np.array(shape.middle)
    corners = polygons[:2].reshape(-1, 3)
    faces = []
    for polygon in polygons:
        away = np.linalg.norm(polygon[:, None] - corners, axis=2)
        across = polygon.mean(axis=0) - middle
        faces.append(_polygon(corners[away.argmin(axis=1)], across / np.linalg.norm(across)))
    return _joined(faces)


def _plane(shape: Plane, scene: Ball) -> Triangles:
    axes, normal = shape.texture_axes, np.array(shape.normal, np.float64)
    normal /= np.linalg.norm(normal)
    foot = scene.center - ((scene.center - np.array(shape.point)) @ normal) * normal
    across = np.stack([axes.u, axes.v])
    lines = scene.radius * _LINES
    ends = np.array([[x, y] for y in lines for x in lines])
    side = len(lines)
    cells = np.array([y * side + x for y in range(side - 1) for x in range(side - 1)])
    right, above = cells + 1, cells + side
    faces = np.concatenate(
        [np.stack([cells, right, above + 1], 1), np.stack([cells, above + 1, above], 1)]
    )
    if np.cross(axes.u, axes.v) @ normal < 0:
        faces = faces[:, ::-1]
    points = foot + ends @ across
    uv = (points - axes.origin) @ across.T
    return Triangles(points, faces, np.tile(normal, (len(points), 1)), uv)


def _polygon(corners: Floats, normal: Floats) -> Triangles:
    across = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    points = corners if across @ normal > 0 else corners[::-1]
    fan = [[0, k, k + 1] for k in range(1, len(points) - 1)]
    return Triangles(points, np.array(fan), np.tile(normal, (len(points), 1)))


def _ring(axis: Floats, around: int) -> Floats:
    """Return unit vectors around an axis, (around, 3), counter-clockwise seen from its end."""
    other = UP if abs(axis[1]) < 0.9 else np.array([1.0, 0, 0])
    u = np.cross(other, axis)
    u /= np.linalg.norm(u)
    angles = 2 * math.pi * np.arange(around) / around
    ring: Floats = np.cos(angles)[:, None] * u + np.sin(angles)[:, None] * np.cross(axis, u)
    return ring


def _fan(center: Floats, axis: Floats, radius: float, around: int) -> Triangles:
    return _polygon(center + radius * _ring(axis, around), axis)


def _cylinder(shape: Cylinder, around: int) -> Triangles:
    ends = np.array([shape.from_, shape.to], np.float64)
    ring = _ring(shape.axis, around)
    points = np.concatenate([end + shape.radius * ring for end in ends])
    low = np.arange(around)
    side = np.roll(low, -1)
    faces = np.concatenate(
        [np.stack([low, side, side + around], 1), np.stack([low, side + around, low + around], 1)]
    )
    wall = Triangles(points, faces, np.tile(ring, (2, 1)))
    if not shape.capped:
        return wall
    rims = points.reshape(2, around, 3)
    caps = [_polygon(rim, sign * shape.axis) for rim, sign in zip(rims, (-1, 1), strict=True)]
    return _joined([wall, *caps])


def _sphere(shape: Sphere, corners: int) -> Triangles:
    """Return a sphere with u = atan2(x, -z) / 2 pi + 1/2 and v = acos(y) / pi."""
    rows, columns = corners // 2, corners
    v, u = np.meshgrid(np.arange(rows + 1), np.arange(columns + 1), indexing="ij")
    polar, around = math.pi * v / rows, 2 * math.pi * ((u % columns) / columns - 0.5)
    high, wide = np.cos(polar), np.sin(polar) * ((v > 0) & (v < rows))  # exactly 0 at the poles
    unit = np.stack([wide * np.sin(around), high, -wide * np.cos(around)], axis=-1).reshape(-1, 3)
    uv = np.stack([u / columns, v / rows], axis=-1).reshape(-1, 2)
    at = (v * (columns + 1) + u)[:-1, :-1].ravel()
    below = at + columns + 1
    first, second = np.stack([at, at + 1, below], 1), np.stack([at + 1, below + 1, below], 1)
    faces = np.concatenate([first[columns:], second[:-columns]])  # each pole is one point
    points = np.array(shape.center) + shape.radius * unit
    one = points[faces[0]]
    across = np.cross(one[1] - one[0], one[2] - one[0])
    if across @ unit[faces[0, 0]] < 0:
        faces = faces[:, ::-1]
    return Triangles(points, faces, unit, uv)


def _joined(parts: list[Triangles]) -> Triangles:
    counts = [len(part.points) for part in parts]
    firsts = np.cumsum([0, *counts[:-1]])
    return Triangles(
        np.concatenate([part.points for part in parts]),
        np.concatenate([part.faces + first for part, first in zip(parts, firsts, strict=True)]),
        np.concatenate([it.normals for it in parts if it.normals is not None]),
    )
