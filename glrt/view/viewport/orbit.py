"""Move a camera, by pure functions: a camera in, another one out.

Angles are in degrees. A drag is a share of the window's width and height, so that it turns the
camera as far in a small window as in a large one. Vectors are float64.

A move raises `UsageError` if a camera cannot be there, or if float64 could not resolve its
direction of view.
"""

import math

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import UsageError
from glrt.scene.camera import Camera
from glrt.scene.values import LARGEST, SMALLEST, Vector
from glrt.view.controls import replaced

Array = NDArray[np.float64]

POLE = 1.0  # degrees between the view and straight up or down that are kept free
WHEEL = 0.9  # share of the distance that a click of the wheel leaves
MOST_CLICKS = 100  # in one step: more are dropped
NEAREST = 1e-10  # to the point looked at, in largest coordinates: float64 resolves directions there


def axes(camera: Camera) -> tuple[Array, Array, Array]:
    """Return the unit vectors right, up and forward of the camera, (3,) each."""
    forward = _unit(_array(camera.view))
    right = _unit(np.cross(forward, _array(camera.up)))
    return right, np.cross(right, forward), forward


def orbited(camera: Camera, pivot: Vector, yaw: float, pitch: float) -> Camera:
    """Turn the camera about a point, which stays where it is in the frame.

    `yaw` turns about the camera's `up`, `pitch` about its right; the poles are not crossed.
    """
    turn = _turn(camera, yaw, pitch)
    center = _array(pivot)
    return _placed(
        camera,
        center + turn @ (_array(camera.position) - center),
        center + turn @ (_array(camera.look_at) - center),
    )


def looked(camera: Camera, yaw: float, pitch: float) -> Camera:
    """Turn the camera where it stands."""
    eye = _array(camera.position)
    return _placed(camera, eye, eye + _turn(camera, yaw, pitch) @ _array(camera.view))


def moved(camera: Camera, right: float, up: float, forward: float) -> Camera:
    """Shift the camera along its own axes, in scene units."""
    x, y, z = axes(camera)
    step = right * x + up * y + forward * z
    return _placed(camera, _array(camera.position) + step, _array(camera.look_at) + step)


def dollied(camera: Camera, pivot: Vector, clicks: float) -> Camera:
    """Shift the camera by clicks of the wheel towards a point, which it never reaches."""
    center, share = _array(pivot), WHEEL ** max(-MOST_CLICKS, min(clicks, MOST_CLICKS))
    return _placed(
        camera,
        center + share * (_array(camera.position) - center),
        center + share * (_array(camera.look_at) - center),
    )


def carried(point: Vector, before: Camera, after: Camera) -> Vector:
    """Return a point moved along with the camera; unmoved if a coordinate would exceed LARGEST."""
    x, y, z = _array(point) + (_array(after.position) - _array(before.position))
    there = float(x), float(y), float(z)
    return there if all(abs(part) <= LARGEST for part in there) else point


def framed(camera: Camera, center: Vector, radius: float) -> Camera:
    """Look at a ball from the side that the camera is on, so that it just fits into the frame."""
    distance = radius / max(math.sin(math.radians(camera.fov) / 2), SMALLEST)
    forward = axes(camera)[2]
    return _placed(camera, _array(center) - distance * forward, _array(center))


def distance_to(camera: Camera, point: Vector) -> float:
    """Return the distance from the camera's position to a point, in scene units."""
    return math.dist(camera.position, point)


def depth_of(camera: Camera, point: Vector) -> float:
    """Return the distance along the view axis: the `focus_distance` that makes a point sharp."""
    return float(np.dot(_array(point) - _array(camera.position), axes(camera)[2]))


def _turn(camera: Camera, yaw: float, pitch: float) -> Array:
    """Return the rotation by `yaw` and `pitch`, with `pitch` limited before the poles."""
    right, _, forward = axes(camera)
    pole = _unit(_array(camera.up))
    elevation = math.degrees(math.asin(max(-1.0, min(1.0, float(np.dot(forward, pole))))))
    low, high = POLE - 90 - elevation, 90 - POLE - elevation
    tilt = max(min(low, 0.0), min(pitch, max(high, 0.0)))
    return rotation(pole, yaw) @ rotation(right, tilt)


def rotation(axis: Array, angle: float) -> Array:
    """Return the matrix that turns by degrees about a unit axis, right-handed (Rodrigues)."""
    sine, cosine = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn: Array = np.eye(3) + sine * cross + (1 - cosine) * (cross @ cross)
    return turn


def _placed(camera: Camera, position: Array, look_at: Array) -> Camera:
    """Return the camera elsewhere; UsageError below `NEAREST`, unless it was as near before."""
    placed = replaced(camera, position=_vector(position), look_at=_vector(look_at))
    as_near = 0.999 * _nearness(camera)  # allows for rounding of coordinates
    if _nearness(placed) < min(NEAREST, as_near):
        raise UsageError(
            f"The camera cannot be nearer to what it looks at than {NEAREST:g} of the largest "
            "coordinate of both."
        )
    return placed


def _nearness(camera: Camera) -> float:
    """Return the length of the view vector, in units of the largest coordinate."""
    return math.hypot(*camera.view) / max(map(abs, (*camera.position, *camera.look_at)))


def _array(value: Vector) -> Array:
    return np.array(value, np.float64)


def _vector(value: Array) -> Vector:
    return (float(value[0]), float(value[1]), float(value[2]))


def _unit(value: Array) -> Array:
    unit: Array = value / np.linalg.norm(value)
    return unit
