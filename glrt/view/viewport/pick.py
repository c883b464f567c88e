"""Find the object under a point of the picture: a ray against all shapes, in float64."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.memo import kept_for_the_same
from glrt.packing.scene_arrays import pack_camera
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.scene.shapes.base import Object
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.values import Vector

Array = NDArray[np.float64]

TIE = 2.0**-18  # of a distance: surfaces closer than this coincide


class Picked(NamedTuple):
    """An object of the scene by its number, and the point on it that is seen."""

    number: int
    point: Vector


def ray_through(camera: Camera, aspect: float, x: float, y: float) -> tuple[Array, Array]:
    """Return origin and unit direction through a point, from (0, 0) upper left to (1, 1).

    `aspect` is width over height. The ray begins in the middle of the lens.
    """
    frame = {name: np.asarray(value) for name, value in pack_camera(camera, aspect).items()}
    across = (2 * x - 1) * frame["tan_x"] * frame["right"]
    down = (1 - 2 * y) * frame["tan_y"] * frame["up"]
    direction = frame["forward"] + across + down
    return np.array(camera.position), direction / np.linalg.norm(direction)


def pick(scene: Scene, aspect: float, x: float, y: float) -> Picked | None:
    """Return the nearest object under a point of the picture; None where there is only sky."""
    origin, direction = ray_through(scene.camera, aspect, x, y)
    met = first_along(scene, origin, direction)
    if met is None:
        return None
    index, distance = met
    point = origin + distance * direction
    return Picked(index, (float(point[0]), float(point[1]), float(point[2])))


def first_along(scene: Scene, origin: Array, direction: Array) -> tuple[int, float] | None:
    """Return the number and the distance of the object that a ray hits first; None for none."""
    with np.errstate(all="ignore"):  # a plane parallel to the ray is infinitely far
        tables = _tables(scene.objects, scene.shown)
        distances = _distances(tables, len(scene.objects), origin, direction)
        for number, shape in enumerate(scene.objects):
            if isinstance(shape, Mesh) and distances[number] < math.inf:  # its ball is hit
                distances[number] = shape.distance(origin, direction)
    if not len(distances) or distances.min() == math.inf:
        return None
    # Where surfaces coincide, a lamp is seen first (shaders_glsl/shapes/coincident.glsl).
    tied = np.flatnonzero(distances <= distances.min() * (1 + TIE)).tolist()
    index = min(tied, key=lambda n: (not scene.finish(scene.objects[n]).group, n))
    return index, float(distances[index])


class _Table(NamedTuple):
    """Objects of one kind, a row each; `numbers`: the number in the scene of each row."""

    kind: type[Object]
    numbers: NDArray[np.intp]
    rows: Array


@kept_for_the_same
def _tables(objects: tuple[Shape, ...], shown: tuple[int, ...]) -> list[_Table]:
    found: dict[type[Object], list[int]] = {}
    for number in shown:
        found.setdefault(type(objects[number]), []).append(number)
    return [
        _Table(kind, np.array(numbers, np.intp), np.array([objects[n].row for n in numbers]))
        for kind, numbers in found.items()
    ]


def _distances(tables: list[_Table], count: int, origin: Array, direction: Array) -> Array:
    """Return the distance to each object along the ray; inf if it is missed or behind."""
    distances = np.full(count, math.inf)
    for kind, numbers, rows in tables:
        distances[numbers] = kind.distances(rows, origin, direction)
    return distances
