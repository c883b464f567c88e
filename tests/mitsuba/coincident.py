"""Flat faces of shapes that coincide: Mitsuba would show one or the other at random."""

from typing import NamedTuple

import numpy as np

from glrt.core.errors import SceneError
from glrt.scene.export.faces import TOUCH
from glrt.scene.export.placing import Vector, around, corners, length, normal_of
from glrt.scene.scene import Scene
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad


class Face(NamedTuple):
    """A flat face."""

    normal: Vector
    points: list[Vector]  # its corners, around; of a disk those of its square; a point of a plane


def refuse_coincident(scene: Scene) -> None:
    """Raise SceneError if flat faces of two shapes overlap in one plane."""
    flat = [(i, face) for i, item in enumerate(scene.visible) for face in _faces(item)]
    for number, (i, first) in enumerate(flat):
        for j, second in flat[number + 1 :]:
            if i != j and _coincide(first, second):
                raise SceneError(
                    f"objects {i} and {j} lie in one plane: Mitsuba would show either, at random; "
                    "move one of them."
                )


def _faces(item: Shape) -> list[Face]:
    if isinstance(item, Plane):
        return [Face(normal_of(item), [np.array(item.point)])]
    if isinstance(item, Quad):
        return [Face(normal_of(item), corners(item))]
    if isinstance(item, Disk):
        return [_round_face(np.array(item.center), normal_of(item), item.radius)]
    if isinstance(item, Cylinder) and item.capped:
        ends = np.array(item.from_), np.array(item.to)
        return [_round_face(end, item.axis, item.radius) for end in ends]
    if isinstance(item, Box):
        rows = [*(item.axes * item.halves[:, None])]
        turns = [rows[axis:] + rows[:axis] for axis in range(3)]
        return [
            _face_of(np.array(item.middle) + side * w, u, v)
            for w, u, v in turns
            for side in (-1, 1)
        ]
    return []


def _round_face(center: Vector, normal: Vector, radius: float) -> Face:
    return _face_of(center, *(radius * axis for axis in around(normal)))


def _face_of(center: Vector, u: Vector, v: Vector) -> Face:
    normal = np.cross(u, v)
    points = [center - u - v, center + u - v, center + u + v, center - u + v]
    return Face(normal / length(normal), points)


def _coincide(a: Face, b: Face) -> bool:
    if length(np.cross(a.normal, b.normal)) > TOUCH:
        return False
    apart = [abs(float(np.dot(a.normal, point - a.points[0]))) for point in b.points]
    size = max(length(point - b.points[0]) for point in [*b.points, *a.points])
    if max(apart) > TOUCH * size:
        return False
    return len(a.points) == 1 or len(b.points) == 1 or _overlap(a, b, TOUCH * size)


def _overlap(a: Face, b: Face, least: float) -> bool:
    """Parallelograms of one plane overlap unless an edge of one has the other beyond it."""
    edges = [points[k + 1] - points[k] for points in (a.points, b.points) for k in (0, 1)]
    for side in (np.cross(a.normal, edge) for edge in edges):
        first, second = ([float(np.dot(side, p)) for p in face.points] for face in (a, b))
        slack = least * length(side)
        if max(first) <= min(second) + slack or max(second) <= min(first) + slack:
            return False
    return True
