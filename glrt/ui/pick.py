"""What lies under a point of the picture: a ray against all shapes, in numpy, float64."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.pack import pack_camera
from glrt.scene import Camera, Plane, Quad, Scene, Shape, Sphere, Vector

Array = NDArray[np.float64]


class Picked(NamedTuple):
    """An object of the scene by its number, and the point on it that is seen."""

    number: int
    point: Vector


def ray_through(camera: Camera, aspect: float, x: float, y: float) -> tuple[Array, Array]:
    """Origin and unit direction through a point of the picture, from (0, 0) upper left to (1, 1).

    `aspect` is width over height. Through the middle of the lens.
    """
    frame = {name: np.asarray(value) for name, value in pack_camera(camera, aspect).items()}
    across = (2 * x - 1) * frame["tan_x"] * frame["right"]
    down = (1 - 2 * y) * frame["tan_y"] * frame["up"]
    direction = frame["forward"] + across + down
    return np.array(camera.position), direction / np.linalg.norm(direction)


def pick(scene: Scene, aspect: float, x: float, y: float) -> Picked | None:
    """The nearest object under a point of the picture; None where there is nothing but sky."""
    origin, direction = ray_through(scene.camera, aspect, x, y)
    distances = [_distance(shape, origin, direction) for shape in scene.objects]
    if not distances or min(distances) == math.inf:
        return None
    index = int(np.argmin(distances))
    point = origin + distances[index] * direction
    return Picked(index, (float(point[0]), float(point[1]), float(point[2])))


def middle(shape: Shape) -> Vector:
    """The point that a shape is moved by."""
    if isinstance(shape, Sphere):
        return shape.center
    if isinstance(shape, Plane):
        return shape.point
    center = np.array(shape.corner) + np.add(shape.edge_u, shape.edge_v) / 2
    return (float(center[0]), float(center[1]), float(center[2]))


def reach(shape: Shape) -> float:
    """The radius of a ball about the middle that holds the shape; of a plane, 1."""
    if isinstance(shape, Sphere):
        return shape.radius
    if isinstance(shape, Quad):
        diagonals = np.add(shape.edge_u, shape.edge_v), np.subtract(shape.edge_u, shape.edge_v)
        return float(max(np.linalg.norm(diagonal) for diagonal in diagonals)) / 2
    return 1.0


def _distance(shape: Shape, origin: Array, direction: Array) -> float:
    """Along the ray; inf if the shape is missed or behind."""
    if isinstance(shape, Sphere):
        return _to_sphere(shape, origin, direction)
    if isinstance(shape, Plane):
        return _to_plane(np.array(shape.point), np.array(shape.normal), origin, direction)
    return _to_quad(shape, origin, direction)


def _to_sphere(sphere: Sphere, origin: Array, direction: Array) -> float:
    to_center = np.array(sphere.center) - origin
    along = float(to_center @ direction)
    aside = to_center - along * direction
    rest = sphere.radius**2 - float(aside @ aside)
    if rest < 0:
        return math.inf
    near, far = along - math.sqrt(rest), along + math.sqrt(rest)
    return near if near > 0 else far if far > 0 else math.inf


def _to_plane(point: Array, normal: Array, origin: Array, direction: Array) -> float:
    slope = float(normal @ direction)
    if slope == 0:
        return math.inf
    distance = float(normal @ (point - origin)) / slope
    return distance if distance > 0 else math.inf


def _to_quad(quad: Quad, origin: Array, direction: Array) -> float:
    corner, u, v = np.array(quad.corner), np.array(quad.edge_u), np.array(quad.edge_v)
    normal = np.cross(u, v)
    distance = _to_plane(corner, normal, origin, direction)
    if distance == math.inf:
        return distance
    offset = origin + distance * direction - corner
    square = float(normal @ normal)
    a, b = (
        float(np.cross(offset, v) @ normal) / square,
        float(np.cross(u, offset) @ normal) / square,
    )
    return distance if 0 <= a <= 1 and 0 <= b <= 1 else math.inf
