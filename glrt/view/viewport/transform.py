"""Move, turn and scale shapes, by pure functions, and the matrices that the handles need.

Matrices are 4 x 4 in OpenGL's order, column by column, as flat lists.
"""

import math

import numpy as np
from numpy.typing import NDArray

from glrt.scene.animation.rotations import angles_of
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.scene.shapes.box import Box, rotation
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.values import Vector
from glrt.view.controls import replaced
from glrt.view.edits.scene_edits import with_object, with_objects
from glrt.view.viewport.orbit import axes

Matrix = list[float]
_NO_TURN = 1e-6  # largest difference of a turn from none: rounding of the gizmo
_ANGLE_DIGITS = 4  # of an angle in degrees after the point
_CLEAR = 1.02  # heights of an object from its middle to that of its copy


def view_matrix(camera: Camera) -> Matrix:
    """Return the matrix from the world to the camera, which looks along -z."""
    right, up, forward = axes(camera)
    turn = np.array([right, up, -forward])
    return _flat(turn, -turn @ np.array(camera.position))


def projection_matrix(camera: Camera, aspect: float) -> Matrix:
    """Return the matrix from the camera to the clip cube; its near and far do not matter here."""
    focal = 1 / math.tan(math.radians(camera.fov) / 2)
    near, far = 0.01, 1000.0
    depth, shift = (far + near) / (near - far), 2 * far * near / (near - far)
    return [focal / aspect, 0, 0, 0, 0, focal, 0, 0, 0, 0, depth, -1, 0, 0, shift, 0]


def object_matrix(shape: Shape) -> Matrix:
    """Return the matrix from a shape to the world: a shift to its middle, without a scale."""
    return _flat(np.eye(3), np.array(shape.middle))


def moved_to(shape: Shape, matrix: NDArray[np.float32]) -> Shape:
    """Return the shape where a gizmo has put it, scaled by the mean scale of the three axes."""
    columns = np.asarray(matrix, np.float64).reshape(4, 4)
    step, axes = columns[3, :3] - np.array(shape.middle), columns[:3, :3]
    lengths = np.linalg.norm(axes, axis=1, keepdims=True)
    moved, is_flat = shifted(shape, step), not lengths.all()  # scaled to nothing: without axes
    return scaled(moved if is_flat else turned(moved, (axes / lengths).T), float(lengths.mean()))


def with_moved(scene: Scene, index: int, moved: Shape, chosen: frozenset[int]) -> Scene:
    """Return the scene with an object as it was moved, and the other chosen ones moved along.

    They keep their sizes and turns.
    """
    step = np.subtract(moved.middle, scene.objects[index].middle)
    if others := chosen - {index} if step.any() else frozenset[int]():
        scene = with_objects(scene, others, lambda other: shifted(other, step))
    return with_object(scene, index, moved)


def shifted(shape: Shape, step: NDArray[np.float64]) -> Shape:
    """Return the shape moved by a vector, in scene units."""
    return replaced(
        shape, **{name: _short(np.add(getattr(shape, name), step)) for name in _points(shape)}
    )


def clear_of(shape: Shape, pivot: Vector, least: float) -> Shape:
    """Return the shape moved up by its own height, or down if it is above the pivot.

    Two surfaces in one place would shade each other at random. A flat or endless shape moves by
    `least`, a plane along its normal; lengths are in scene units.
    """
    low, high = type(shape).bounds(np.array([shape.row], np.float64))
    height, normal = float(high[0][1] - low[0][1]), getattr(shape, "normal", None)
    if not math.isfinite(shape.reach) and normal is not None:
        along = np.array(normal, np.float64)
        return shifted(shape, least * along / float(np.linalg.norm(along)))
    step = max(_CLEAR * height, least)
    return shifted(shape, np.array([0.0, -step if shape.middle[1] > pivot[1] else step, 0.0]))


def can_turn(shape: Shape) -> bool:
    """Whether a turn about its middle changes the shape."""
    return bool(shape.points or shape.directions or hasattr(shape, "rotate"))


def turned(shape: Shape, turn: NDArray[np.float64]) -> Shape:
    """Return the shape turned about its middle by a matrix for columns, (3, 3)."""
    if not can_turn(shape) or np.allclose(turn, np.eye(3), atol=_NO_TURN, rtol=0):
        return shape
    vectors = {name: turn @ np.array(getattr(shape, name)) for name in shape.directions}
    if isinstance(shape, Box | Mesh):
        angles = angles_of(turn @ rotation(shape.rotate))
        vectors["rotate"] = np.array([round(angle, _ANGLE_DIGITS) for angle in angles])
    if not isinstance(shape, Box):  # its corners are those before it is turned about its middle
        middle = np.array(shape.middle)
        vectors |= {
            name: middle + turn @ (np.array(getattr(shape, name)) - middle)
            for name in _points(shape)
        }
    return replaced(shape, **{name: _short(value) for name, value in vectors.items()})


def scaled(shape: Shape, factor: float) -> Shape:
    """Return the shape scaled about its middle; a shape without size stays as it is."""
    if factor == 1 or not (shape.extents or shape.points):
        return shape
    middle = np.array(shape.middle)
    lengths = {name: factor * np.array(getattr(shape, name)) for name in shape.extents}
    points = {
        name: middle + factor * (np.array(getattr(shape, name)) - middle) for name in _points(shape)
    }
    changes = {name: _short(value) for name, value in {**lengths, **points}.items()}
    return replaced(shape, **changes)


def _points(shape: Shape) -> tuple[str, ...]:
    """Return the names of the fields that hold points of the shape."""
    return (shape.anchor, *shape.points)


def _flat(turn: NDArray[np.float64], shift: NDArray[np.float64]) -> Matrix:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, shift
    return [float(value) for value in matrix.T.ravel()]


def _short(value: NDArray[np.float64]) -> Vector | float:
    """Round to seven digits: a gizmo has no more, and scene files are to be legible."""
    if value.ndim == 0:
        return _digits(float(value))
    return (_digits(value[0]), _digits(value[1]), _digits(value[2]))


def _digits(value: float) -> float:
    return float(f"{value:.7g}")
