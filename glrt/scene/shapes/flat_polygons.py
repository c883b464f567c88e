"""The flat surfaces of shapes as polygons, to find where two of them lie in one place."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.shapes.base import Object

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Polygons(NamedTuple):
    """Convex polygons in scene units."""

    corners: Floats  # (n, k, 3)
    owner: Ints  # (n,): number of the object

    @property
    def boxes(self) -> tuple[Floats, Floats]:
        """Lowest and highest coordinates, (n, 3) each."""
        return self.corners.min(axis=1), self.corners.max(axis=1)

    def of(self, rows: Any) -> "Polygons":
        """Return some of the polygons."""
        return Polygons(self.corners[rows], self.owner[rows])

    @property
    def normals(self) -> Floats:
        """Unit normals, (n, 3), of either sign; 0 if the corners lie on a line."""
        first = self.corners[:, :1]
        # The corners go round: the sum of these products is twice the area.
        across = np.cross(self.corners - first, np.roll(self.corners, -1, axis=1) - first)
        total = across.sum(axis=1)
        length = np.linalg.norm(total, axis=1, keepdims=True)
        unit: Floats = np.divide(total, length, out=np.zeros_like(total), where=length > 0)
        return unit


def polygons_of(thing: Object, number: int, low: Floats, high: Floats) -> Polygons:
    """Return the flat surfaces of an object that touch a box, (3,) each corner; none of a plane."""
    found = thing.polygons
    near = (found.max(axis=1) >= low).all(axis=1) & (found.min(axis=1) <= high).all(axis=1)
    some = found[near]
    return Polygons(some, np.full(len(some), number))


def joined(parts: list[Polygons]) -> Polygons:
    """Return all polygons; each is padded to the corners of the one that has most."""
    most = max((part.corners.shape[1] for part in parts), default=3)
    none = [Polygons(np.zeros((0, most, 3)), np.zeros(0, np.int64))]
    alike = [
        np.concatenate(
            [it.corners, np.repeat(it.corners[:, -1:], most - it.corners.shape[1], 1)], 1
        )
        for it in none + parts
    ]
    return Polygons(np.concatenate(alike), np.concatenate([it.owner for it in none + parts]))
