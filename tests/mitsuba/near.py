"""Where Mitsuba gets a scene: the camera at the origin, and always of one size.

Mitsuba lifts each ray off its surface by (1 + |p|) 1500 * 2^-24, p being the point from the origin:
not the same in every unit and place. At this size the 1 no longer counts.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt.scene import Plane, Quad, Scene, Sphere

Vector = NDArray[np.float64]

EXTENT = 1000.0  # from the camera to the farthest point of a shape, planes aside


class Near(NamedTuple):
    """From the coordinates of a scene to Mitsuba's."""

    eye: Vector
    factor: float

    def point(self, point: ArrayLike) -> Vector:
        """A position."""
        return self.along(np.asarray(point, float) - self.eye)

    def along(self, vector: ArrayLike) -> Vector:
        """A difference of positions."""
        return np.asarray(vector, float) * self.factor


def near(scene: Scene) -> Near:
    """The coordinates in which the camera is the origin and the scene EXTENT large."""
    eye = np.array(scene.camera.position)
    reaches = [scene.camera.resolved_focus_distance, *_reaches(scene, eye)]
    return Near(eye, EXTENT / max(reaches))


def _reaches(scene: Scene, eye: Vector) -> Iterator[float]:
    """How far each shape stretches from the camera; a plane, how far it is."""
    for item in scene.objects:
        if isinstance(item, Sphere):
            yield length(np.array(item.center) - eye) + item.radius
        elif isinstance(item, Quad):
            yield max(length(corner - eye) for corner in corners(item))
        else:
            yield abs(np.dot(unit(item.normal), np.array(item.point) - eye))


def corners(quad: Quad) -> list[Vector]:
    """The four corners, around."""
    corner, u, v = (np.array(part) for part in (quad.corner, quad.edge_u, quad.edge_v))
    return [corner, corner + u, corner + u + v, corner + v]


def normal_of(item: Plane | Quad) -> Vector:
    """The unit normal of a flat shape."""
    return unit(item.normal if isinstance(item, Plane) else np.cross(item.edge_u, item.edge_v))


def length(vector: ArrayLike) -> float:
    """Euclidean."""
    return float(np.linalg.norm(np.asarray(vector, float)))


def unit(vector: ArrayLike) -> Vector:
    """Of length 1."""
    return np.asarray(vector, float) / length(vector)
