"""Directions and lengths, and the coordinates in which another program gets a scene.

`near` is for Mitsuba, which lifts each ray off its surface by (1 + |p|) 1500 * 2^-24, p being the
point from the origin. That is not the same in every unit and place. At the size EXTENT the 1 no
longer counts. Where rays graze glass, the lift changes the angle at which they meet its far side,
and shows. So the origin is in a glass ball, or in the camera.
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


class Placing(NamedTuple):
    """The map from the coordinates of a scene to those of another program."""

    origin: Vector  # the point of the scene that becomes the origin
    factor: float  # by which lengths are multiplied
    extent: float  # from the new origin to the farthest point of a shape, planes aside

    def point(self, point: ArrayLike) -> Vector:
        """Return a position."""
        return self.along(np.asarray(point, float) - self.origin)

    def along(self, vector: ArrayLike) -> Vector:
        """Return a difference of positions."""
        return np.asarray(vector, float) * self.factor

    def matrix(self, linear: ArrayLike, origin: ArrayLike) -> Vector:
        """Return the matrix, (4, 4), of what `linear`, (3, 3), and `origin` place in the scene."""
        found = np.eye(4)
        found[:3, :3], found[:3, 3] = self.along(linear), self.point(origin)
        return found


def as_it_is(scene: Scene) -> Placing:
    """Return the coordinates of the scene itself."""
    origin = np.zeros(3)
    return Placing(origin, 1.0, _extent(scene, origin))


def near(scene: Scene) -> Placing:
    """Return the coordinates in which the scene is EXTENT large."""
    origin = _origin(scene)
    return Placing(origin, EXTENT / _extent(scene, origin), EXTENT)


def _extent(scene: Scene, origin: Vector) -> float:
    reaches = [length(origin - scene.camera.position), scene.camera.resolved_focus_distance]
    return max(*reaches, *_reaches(scene, origin))


def _origin(scene: Scene) -> Vector:
    """Return the center of the glass ball that stands nearest to the camera, or else the camera."""
    eye = np.array(scene.camera.position)
    balls = [item for item in scene.visible if isinstance(item, Sphere)]
    glass = [b.center for b in balls if isinstance(scene.materials[b.material], Dielectric)]
    return min(map(np.array, glass), key=lambda center: length(center - eye), default=eye)


def _reaches(scene: Scene, origin: Vector) -> Iterator[float]:
    """Yield how far each shape stretches from the origin, and how far away each plane is."""
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
    """Return the four corners of a quad, around."""
    corner, u, v = (np.array(part) for part in (quad.corner, quad.edge_u, quad.edge_v))
    return [corner, corner + u, corner + u + v, corner + v]


def normal_of(item: Plane | Quad | Disk) -> Vector:
    """Return the unit normal of a flat shape."""
    return unit(np.cross(item.edge_u, item.edge_v) if isinstance(item, Quad) else item.normal)


def around(normal: Vector) -> tuple[Vector, Vector]:
    """Return two unit vectors that make a right-handed frame with a unit normal, their third."""
    u = unit(np.cross(normal, np.eye(3)[np.abs(normal).argmin()]))
    return u, np.cross(normal, u)


def length(vector: ArrayLike) -> float:
    """Return the Euclidean length of a vector."""
    return float(np.linalg.norm(np.asarray(vector, float)))


def unit(vector: ArrayLike) -> Vector:
    """Return the vector scaled to length 1."""
    return np.asarray(vector, float) / length(vector)


def placed(center: ArrayLike, *axes: ArrayLike) -> Vector:
    """Return the matrix, (4, 4), that takes x, y and z to `axes`, and the origin to a center."""
    matrix = np.eye(4)
    matrix[:3] = np.stack([*map(np.asarray, axes), np.asarray(center)], axis=1)
    return matrix
