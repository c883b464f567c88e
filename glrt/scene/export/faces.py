"""Balls that are seen from inside."""

import numpy as np

from glrt.scene.export.placing import Vector, length, normal_of
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.sphere import Sphere

TOUCH = 1e-6  # of a radius or an edge: surfaces that come as near only touch


def is_seen_from_inside(ball: Sphere, scene: Scene) -> bool:
    """Return whether the camera or a part of another shape is inside of the ball."""
    center = np.array(ball.center)
    room = ball.radius * (1 - TOUCH)
    if length(center - scene.camera.position) < room:
        return True
    return any(item is not ball and _reach(item, center) < room for item in scene.visible)


def _reach(item: Shape, point: Vector) -> float:
    """Return the distance of a point to a shape's surface, or less."""
    if isinstance(item, Sphere):
        return abs(length(point - item.center) - item.radius)
    if isinstance(item, Plane):
        return abs(float(np.dot(normal_of(item), point - item.point)))
    return length(point - item.middle) - item.reach
