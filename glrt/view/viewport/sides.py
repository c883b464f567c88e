"""Views of the whole scene from its sides."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.scene.shapes.base import Object
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.values import LARGEST, SMALLEST, Vector
from glrt.view.controls import replaced

Array = NDArray[np.float64]

# The camera looks a tenth of a degree past straight up and down: `up` stays that of the world.
_TILT = math.radians(0.1)
SIDES: dict[str, Vector] = {  # from the scene to the camera
    "front": (0.0, 0.0, 1.0),
    "back": (0.0, 0.0, -1.0),
    "left": (-1.0, 0.0, 0.0),
    "right": (1.0, 0.0, 0.0),
    "top": (0.0, math.cos(_TILT), math.sin(_TILT)),
    "bottom": (0.0, -math.cos(_TILT), math.sin(_TILT)),
}
_UP = (0.0, 1.0, 0.0)


class Ball(NamedTuple):
    """A ball around what is to be seen."""

    center: Vector
    radius: float


def ball_of(scene: Scene) -> Ball | None:
    """Return a ball around all shown objects but infinite ones; None if there is none."""
    boxes = list(_boxes([scene.objects[number] for number in scene.shown]))
    if not boxes:
        return None
    low = np.min([low.min(axis=0) for low, _ in boxes], axis=0)
    high = np.max([high.max(axis=0) for _, high in boxes], axis=0)
    x, y, z = (low + high) / 2
    return Ball((float(x), float(y), float(z)), float(np.linalg.norm(high - low)) / 2)


def _boxes(shapes: list[Object]) -> Iterator[tuple[Array, Array]]:
    """Yield low and high corners of boxes around the shapes, (n, 3) each."""
    rows: dict[type[Object], list[list[float]]] = {}
    for shape in shapes:
        if isinstance(shape, Mesh):
            yield _box(shape)
        elif shape.is_bounded:
            rows.setdefault(type(shape), []).append(shape.row)
    for kind, numbers in rows.items():
        yield kind.bounds(np.array(numbers, np.float64))


def _box(mesh: Mesh) -> tuple[Array, Array]:
    frame = mesh.frame
    ends = np.array([frame.low, frame.high])
    picks = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    corners = ends[picks, np.arange(3)] @ frame.axes.T + frame.origin
    return corners.min(axis=0)[None], corners.max(axis=0)[None]


def seen_from(camera: Camera, ball: Ball, side: str, aspect: float) -> Camera:
    """Return the camera on a side of a ball, which just fits into the frame; what it saw is sharp.

    `aspect` is width over height. Raises `UsageError` if the camera cannot be there.
    """
    half = math.radians(camera.fov) / 2
    half = min(half, math.atan(math.tan(half) * aspect))
    distance = max(ball.radius, SMALLEST) / math.sin(half)
    x, y, z = np.array(ball.center) + min(distance, LARGEST) * np.array(SIDES[side])
    place = (float(x), float(y), float(z))
    return replaced(camera, position=place, look_at=ball.center, up=_UP, focus_distance=None)
