"""Where Mitsuba gets a scene: a glass ball in the origin, or the camera, and always of one size.

Mitsuba lifts each ray off its surface by (1 + |p|) 1500 * 2^-24, p being the point from the origin:
not the same in every unit and place. At this size the 1 no longer counts. Where rays graze glass,
the lift changes the angle that they meet its far side at, and shows; so the origin is there.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.scene import Scene
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere

Vector = NDArray[np.float64]

EXTENT = 1000.0  # from the origin to the farthest point of a shape, planes aside


class Near(NamedTuple):
    """The map from the coordinates of a scene to Mitsuba's."""

    origin: Vector
    factor: float

    def point(self, point: ArrayLike) -> Vector:
        """A position."""
        return self.along(np.asarray(point, float) - self.origin)

    def along(self, vector: ArrayLike) -> Vector:
        """A difference of positions."""
        return np.asarray(vector, float) * self.factor


def near(scene: Scene) -> Near:
    """The coordinates in which the scene is EXTENT large."""
    origin = _origin(scene)
    reaches = [length(origin - scene.camera.position), scene.camera.resolved_focus_distance]
    return Near(origin, EXTENT / max(*reaches, *_reaches(scene, origin)))


def _origin(scene: Scene) -> Vector:
    """The center of the glass ball that stands nearest to the camera, or else the camera."""
    eye = np.array(scene.camera.position)
    balls = [item for item in scene.visible if isinstance(item, Sphere)]
    glass = [b.center for b in balls if isinstance(scene.materials[b.material], Dielectric)]
    return min(map(np.array, glass), key=lambda center: length(center - eye), default=eye)


def _reaches(scene: Scene, origin: Vector) -> Iterator[float]:
    """How far each shape stretches from the origin; a plane, how far it is."""
    for item in scene.visible:
        if isinstance(item, Sphere):
            yield length(origin - item.center) + item.radius
        elif isinstance(item, Quad):
            yield max(length(corner - origin) for corner in corners(item))
        elif not isinstance(item, Plane):
            yield length(origin - item.middle) + item.reach
        else:
            yield abs(float(np.dot(unit(item.normal), origin - item.point)))


def corners(quad: Quad) -> list[Vector]:
    """The four corners, around."""
    corner, u, v = (np.array(part) for part in (quad.corner, quad.edge_u, quad.edge_v))
    return [corner, corner + u, corner + u + v, corner + v]


def normal_of(item: Plane | Quad | Disk) -> Vector:
    """The unit normal of a flat shape."""
    return unit(np.cross(item.edge_u, item.edge_v) if isinstance(item, Quad) else item.normal)


def around(normal: Vector) -> tuple[Vector, Vector]:
    """Two unit vectors that make a right-handed frame with a unit normal, their third."""
    u = unit(np.cross(normal, np.eye(3)[np.abs(normal).argmin()]))
    return u, np.cross(normal, u)


def length(vector: ArrayLike) -> float:
    """Euclidean."""
    return float(np.linalg.norm(np.asarray(vector, float)))


def unit(vector: ArrayLike) -> Vector:
    """The vectors scaled to length 1."""
    return np.asarray(vector, float) / length(vector)
