"""What of a scene's surfaces Mitsuba needs to be told: which of them can be seen from inside, and
which coincide, so that it would show one or the other at random."""

import numpy as np

from glrt.errors import SceneError
from glrt.scene.scene import Scene
from glrt.scene.shapes import Plane, Quad, Shape, Sphere
from tests.mitsuba.near import Vector, corners, length, normal_of

TOUCH = 1e-6  # of a radius or an edge: surfaces that come as near only touch


def is_seen_from_inside(ball: Sphere, scene: Scene) -> bool:
    """Whether the camera or a part of another shape is inside of the ball."""
    center = np.array(ball.center)
    room = ball.radius * (1 - TOUCH)
    if length(center - scene.camera.position) < room:
        return True
    return any(item is not ball and _reach(item, center) < room for item in scene.objects)


def _reach(item: Shape, point: Vector) -> float:
    """The distance of a point to a shape's surface; of what is bounded, at most."""
    if isinstance(item, Sphere):
        return abs(length(point - item.center) - item.radius)
    if isinstance(item, Plane):
        return abs(float(np.dot(normal_of(item), point - item.point)))
    return length(point - item.middle) - item.reach


def refuse_coincident(scene: Scene) -> None:
    """Raise SceneError if two flat shapes overlap in one plane."""
    flat = [(i, o) for i, o in enumerate(scene.objects) if isinstance(o, Plane | Quad)]
    for number, (i, first) in enumerate(flat):
        for j, second in flat[number + 1 :]:
            if _coincide(first, second):
                raise SceneError(
                    f"objects {i} and {j} lie in one plane: Mitsuba would show either, at random; "
                    "move one of them."
                )


def _coincide(a: Plane | Quad, b: Plane | Quad) -> bool:
    normal = normal_of(a)
    if length(np.cross(normal, normal_of(b))) > TOUCH:
        return False
    points = _points(b)
    apart = [abs(float(np.dot(normal, point - _points(a)[0]))) for point in points]
    size = max(length(point - points[0]) for point in [*points, *_points(a)])
    if max(apart) > TOUCH * size:
        return False
    return isinstance(a, Plane) or isinstance(b, Plane) or _overlap(a, b, TOUCH * size)


def _points(item: Plane | Quad) -> list[Vector]:
    return [np.array(item.point)] if isinstance(item, Plane) else corners(item)


def _overlap(a: Quad, b: Quad, least: float) -> bool:
    """Convex polygons of one plane overlap unless an edge of one has the other beyond it."""
    normal = normal_of(a)
    sides = [np.cross(normal, edge) for edge in (a.edge_u, a.edge_v, b.edge_u, b.edge_v)]
    for side in sides:
        first, second = ([float(np.dot(side, p)) for p in corners(quad)] for quad in (a, b))
        slack = least * length(side)
        if max(first) <= min(second) + slack or max(second) <= min(first) + slack:
            return False
    return True
