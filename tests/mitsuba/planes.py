"""How far planes reach that may end, over the extent of the scene.

Mitsuba knows a point on a triangle to a part of the triangle's size. Where planes are 1,000 times
as large as the scene, one at a slant shades itself: up to a third of its light is lost.
"""

from itertools import combinations

import numpy as np

from glrt.scene.export.placing import normal_of
from glrt.scene.scene import Scene
from glrt.scene.shapes.plane import Plane

OF_A_ROOM, TO_THE_HORIZON = 64.0, 1000.0  # the second one leaves a gap of a part of a pixel


def reach_of_planes(scene: Scene) -> float:
    """Return how far planes reach: less if they are a room around the camera."""
    return OF_A_ROOM if _is_room(scene) else TO_THE_HORIZON


def _is_room(scene: Scene) -> bool:
    """Return whether each way out of the camera meets a plane.

    A way that meets none leads along the line of two planes, or else all are parallel to a line.
    """
    planes = [item for item in scene.visible if isinstance(item, Plane)]
    toward = [np.dot(normal_of(p), np.subtract(scene.camera.position, p.point)) for p in planes]
    normals = [np.sign(side) * normal_of(p) for side, p in zip(toward, planes, strict=True)]
    if not planes or np.linalg.matrix_rank(normals) < 3:
        return False
    lines = [np.cross(a, b) for a, b in combinations(normals, 2)]
    ways = [way for line in lines if np.linalg.norm(line) > 1e-6 for way in (line, -line)]
    return not any((np.array(normals) @ way > -1e-9).all() for way in ways)
