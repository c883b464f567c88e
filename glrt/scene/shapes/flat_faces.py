"""Flat faces of solids, and whether two of them share a part of one plane."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.plane import Plane

STEPS = 9  # points of a face along each of its axes
INNER = 0.98  # share of a face that they cover: edges may touch

Floats = NDArray[np.float64]


class _Face(NamedTuple):
    """A parallelogram, center + s u + t v for s and t from -1 to 1, or the ellipse in it."""

    center: Floats
    u: Floats  # (3,); 0 for a plane, which has no end
    v: Floats
    normal: Floats  # unit
    is_round: bool

    def points(self) -> Floats:
        """Return points of the face, (n, 3)."""
        steps = np.linspace(-INNER, INNER, STEPS)
        s, t = (axis.ravel() for axis in np.meshgrid(steps, steps))
        kept = s * s + t * t <= INNER**2 if self.is_round else np.full(s.shape, True)
        points: Floats = self.center + s[kept, None] * self.u + t[kept, None] * self.v
        return points

    def holds(self, points: Floats) -> bool:
        """Return whether some points of its plane, (n, 3), lie in the face."""
        if not self.u.any():
            return True
        s, t = ((points - self.center) @ axis / (axis @ axis) for axis in (self.u, self.v))
        inside = s * s + t * t <= 1 if self.is_round else (np.abs(s) <= 1) & (np.abs(t) <= 1)
        return bool(inside.any())


def share_a_face(first: Shape, second: Shape, slack: float) -> bool:
    """Return whether flat faces of two solids overlap in a plane, within `slack` of their size."""
    pairs = ((a, b) for a in _faces(first) for b in _faces(second))
    return any(_overlap(a, b, slack) for a, b in pairs)


def _faces(solid: Shape) -> list[_Face]:
    if isinstance(solid, Plane):
        normal = np.array(solid.normal) / np.linalg.norm(solid.normal)
        return [_Face(np.array(solid.point), np.zeros(3), np.zeros(3), normal, False)]
    if isinstance(solid, Cylinder) and solid.capped:
        across = np.cross(solid.axis, np.eye(3)[np.abs(solid.axis).argmin()])
        u = solid.radius * across / np.linalg.norm(across)
        v = np.cross(solid.axis, u)
        ends = np.array(solid.from_), np.array(solid.to)
        return [_Face(end, u, v, solid.axis, True) for end in ends]
    if isinstance(solid, Box):
        edges = solid.axes * solid.halves[:, None]
        return [
            _Face(np.array(solid.middle) + side * edges[k], edges[k - 2], edges[k - 1], axis, False)
            for k, axis in enumerate(solid.axes)
            for side in (-1.0, 1.0)
        ]
    return []


def _overlap(a: _Face, b: _Face, slack: float) -> bool:
    offset = b.center - a.center
    size = float(np.linalg.norm(a.u) + np.linalg.norm(a.v) + np.linalg.norm(b.u + b.v))
    if (
        np.linalg.norm(np.cross(a.normal, b.normal)) > slack
        or abs(offset @ a.normal) > slack * size
    ):
        return False
    return b.holds(a.points()) or a.holds(b.points())
