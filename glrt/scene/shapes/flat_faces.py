"""Flat faces of solids, and whether two of them share a part of one plane."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

STEPS = 9  # points of a face along each of its axes
INNER = 0.98  # share of a face that they cover: edges may touch

Floats = NDArray[np.float64]


class FlatFace(NamedTuple):
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


def share_a_plane(first: Sequence[FlatFace], second: Sequence[FlatFace], slack: float) -> bool:
    """Return whether some of two solids' faces overlap in a plane, within `slack` of their size."""
    return any(_overlap(a, b, slack) for a in first for b in second)


def _overlap(a: FlatFace, b: FlatFace, slack: float) -> bool:
    offset = b.center - a.center
    size = float(np.linalg.norm(a.u) + np.linalg.norm(a.v) + np.linalg.norm(b.u + b.v))
    if (
        np.linalg.norm(np.cross(a.normal, b.normal)) > slack
        or abs(offset @ a.normal) > slack * size
    ):
        return False
    return b.holds(a.points()) or a.holds(b.points())
