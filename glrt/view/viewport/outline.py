"""The outline of an object as the camera sees it, as line segments in the picture.

For a ball it is the circle where rays touch it. For faces it is the edges between faces that look
at the camera and faces that look away, and the rims of open surfaces.
"""

import math

import numpy as np
from numpy.typing import NDArray

from glrt.core.memo import kept_for_the_same
from glrt.packing.scene_arrays import pack_camera
from glrt.scene.camera import Camera
from glrt.scene.shapes.faces import Faces, circle
from glrt.scene.shapes.kinds import Shape

Array = NDArray[np.float64]
Segments = NDArray[np.float64]  # (n, 2, 2): ends in shares of the picture, (0, 0) upper left

_NEAR = 1e-4  # of the distance to the object: lines nearer to the camera's plane are cut


def outline(shape: Shape, camera: Camera, aspect: float) -> Segments:
    """Return the outline of an object in the picture; `aspect` is width over height."""
    eye = np.array(camera.position)
    faces = _faces_of(shape)
    if faces is None:
        ends = _circle_seen(np.array(shape.middle), shape.reach, eye)
    else:
        ends = faces.vertices[faces.edges[_is_outer(faces, eye)]]
    near = _NEAR * max(float(np.linalg.norm(np.array(shape.middle) - eye)), 1e-9)
    return projected(ends, camera, aspect, near)


def _circle_seen(center: Array, radius: float, eye: Array) -> Array:
    """Return segments (n, 2, 3) where rays from the eye touch a ball; none from inside."""
    away = center - eye
    square = float(away @ away)
    if square <= radius**2:
        return np.zeros((0, 2, 3))
    share = radius**2 / square
    axis = away / math.sqrt(square)
    return circle(center - share * away, axis, radius * math.sqrt(1 - share))


def _is_outer(faces: Faces, eye: Array) -> NDArray[np.bool_]:
    """Return (e,) whether an edge is a rim, or just one of its faces looks towards the eye."""
    is_towards = ((eye - faces.points) * faces.normals).sum(axis=1) > 0
    is_rim = (faces.neighbours < 0).any(axis=1)
    first, second = (is_towards[faces.neighbours[:, side]] for side in (0, 1))
    outer: NDArray[np.bool_] = is_rim | ((first != second) != faces.turned)
    return outer


def projected(ends: Array, camera: Camera, aspect: float, near: float) -> Segments:
    """Project segments (n, 2, 3) to the picture, cut at the depth `near` before the camera."""
    frame = {name: np.asarray(value) for name, value in pack_camera(camera, aspect).items()}
    axes = np.stack([frame[name] for name in ("right", "up", "forward")], axis=1)
    seen = (ends - np.array(camera.position)) @ axes
    seen = seen[(seen[..., 2] > near).any(axis=1)]
    a, b = seen[:, 0], seen[:, 1]
    a, b = _cut(a, b, near), _cut(b, a, near)
    x, y = (
        np.stack([end[:, k] / (end[:, 2] * float(frame[tan])) for end in (a, b)], axis=1)
        for k, tan in ((0, "tan_x"), (1, "tan_y"))
    )
    return np.stack([0.5 + 0.5 * x, 0.5 - 0.5 * y], axis=-1)


def _cut(end: Array, other: Array, near: float) -> Array:
    """Return ends of segments; those at a depth below `near` are moved along to that depth."""
    with np.errstate(all="ignore"):
        share = (near - end[:, 2]) / (other[:, 2] - end[:, 2])
        moved = end + share[:, None] * (other - end)
    return np.where((end[:, 2] < near)[:, None], moved, end)


@kept_for_the_same
def _faces_of(shape: Shape) -> Faces | None:
    return shape.faces
