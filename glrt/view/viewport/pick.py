"""Find what lies under a point of the picture: a ray against all shapes, in float64."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.rendering.pack import pack_camera
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.scene.shapes import Plane, Quad, Shape, Sphere
from glrt.scene.values import Vector
from glrt.view.memo import kept_for_the_same

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
    with np.errstate(all="ignore"):  # a plane beside the ray is infinitely far
        distances = _distances(_tables(scene.objects), origin, direction)
    if not len(distances) or distances.min() == math.inf:
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


class _Tables(NamedTuple):
    """The objects by kind, a row each; `numbers` are those of the rows in the scene."""

    numbers: NDArray[np.intp]
    spheres: Array  # center, radius
    planes: Array  # point, normal
    quads: Array  # corner, edge_u, edge_v


@kept_for_the_same
def _tables(objects: tuple[Shape, ...]) -> _Tables:
    kinds: list[list[tuple[int, list[float]]]] = [[], [], []]
    for number, shape in enumerate(objects):
        if isinstance(shape, Sphere):
            kinds[0].append((number, [*shape.center, shape.radius]))
        elif isinstance(shape, Plane):
            kinds[1].append((number, [*shape.point, *shape.normal]))
        else:
            kinds[2].append((number, [*shape.corner, *shape.edge_u, *shape.edge_v]))
    numbers = np.array([number for kind in kinds for number, _ in kind], np.intp)
    rows = ([row for _, row in kind] for kind in kinds)
    spheres, planes, quads = (
        np.array(part, np.float64).reshape(-1, width)
        for part, width in zip(rows, (4, 6, 9), strict=True)
    )
    return _Tables(numbers, spheres, planes, quads)


def _distances(tables: _Tables, origin: Array, direction: Array) -> Array:
    """To each object along the ray; inf if it is missed or behind."""
    distances = np.empty(len(tables.numbers))
    distances[tables.numbers] = np.concatenate(
        [
            _to_spheres(tables.spheres, origin, direction),
            _to_planes(tables.planes[:, :3], tables.planes[:, 3:], origin, direction),
            _to_quads(tables.quads, origin, direction),
        ]
    )
    return distances


def _to_spheres(spheres: Array, origin: Array, direction: Array) -> Array:
    to_center = spheres[:, :3] - origin
    along = to_center @ direction
    aside = to_center - along[:, None] * direction
    rest = np.sqrt(spheres[:, 3] ** 2 - np.square(aside).sum(axis=1))  # NaN beside the sphere
    near, far = along - rest, along + rest
    return np.where(near > 0, near, np.where(far > 0, far, math.inf))


def _to_planes(points: Array, normals: Array, origin: Array, direction: Array) -> Array:
    distances: Array = ((points - origin) * normals).sum(axis=1) / (normals @ direction)
    return np.where(distances > 0, distances, math.inf)


def _to_quads(quads: Array, origin: Array, direction: Array) -> Array:
    corner, u, v = quads[:, :3], quads[:, 3:6], quads[:, 6:]
    normal = np.cross(u, v)
    distance = _to_planes(corner, normal, origin, direction)
    offset = origin + distance[:, None] * direction - corner
    square = np.square(normal).sum(axis=1)
    a = (np.cross(offset, v) * normal).sum(axis=1) / square
    b = (np.cross(u, offset) * normal).sum(axis=1) / square
    return np.where((a >= 0) & (a <= 1) & (b >= 0) & (b <= 1), distance, math.inf)
