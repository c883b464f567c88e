"""Texture coordinates of flat shapes."""

from typing import Any, NamedTuple

import numpy as np

from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad

Array = np.ndarray[Any, np.dtype[np.float64]]


class TextureAxes(NamedTuple):
    """Axes of texture coordinates: a point p has u . (p - origin) and v . (p - origin)."""

    origin: Array
    u: Array
    v: Array


def texture_axes(shape: Shape) -> TextureAxes | None:
    """Return the axes of a quad, a disk or a plane; None for other shapes.

    The axes of a quad run along its edges from its corner, those of a disk over the square around
    it, and those of a plane in scene units from its point.
    """
    if isinstance(shape, Quad):
        edge_u, edge_v = np.array(shape.edge_u, np.float64), np.array(shape.edge_v, np.float64)
        normal = np.cross(edge_u, edge_v)
        area = normal @ normal
        dual_u, dual_v = np.cross(edge_v, normal) / area, np.cross(normal, edge_u) / area
        return TextureAxes(np.array(shape.corner, np.float64), dual_u, dual_v)
    if isinstance(shape, Disk):
        u, v = _across(shape.normal)
        center = np.array(shape.center, np.float64)
        corner = center - shape.radius * (u + v)
        return TextureAxes(corner, u / (2 * shape.radius), v / (2 * shape.radius))
    if isinstance(shape, Plane):
        return TextureAxes(np.array(shape.point, np.float64), *_across(shape.normal))
    return None


def _across(normal: Any) -> tuple[Array, Array]:
    """Return unit vectors along u and v: v leads down, or along z on floors and ceilings."""
    n = np.array(normal, np.float64) / np.linalg.norm(normal)
    down = np.array([0.0, -1.0, 0.0])
    if abs(n[1]) > _STEEPEST:
        down = np.array([0.0, 0.0, np.copysign(1.0, n[1])])
    v = down - (down @ n) * n
    v /= np.linalg.norm(v)
    return np.cross(n, v), v


_STEEPEST = 0.999  # largest |y| of the normal of a wall
