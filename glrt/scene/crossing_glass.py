"""Relations between solids of glass: which cross, lie inside another, or share a face."""

import math
from collections.abc import Iterator
from itertools import islice
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.shapes.base import Object
from glrt.scene.shapes.flat_faces import share_a_plane
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.sphere import Sphere

MOST_COMPARED = 1000  # solids that are compared with each other
MOST_PAIRS = 300  # compared pairs of solids near each other that are not both balls
POINTS = 256  # points on a surface
SLACK = 1e-6  # share of the size by which solids that touch may overlap

Floats = NDArray[np.float64]
Pair = tuple[int, int]
Relation = Literal["cross", "share a face", "inside"]


class Found(NamedTuple):
    """Two solids, by index, and their relation; for "inside", the first lies in the second."""

    relation: Relation
    pair: Pair


def relations(solids: list[Shape], eye: Floats) -> Iterator[Found]:
    """Yield which of the solids cross, share a part of a flat face, or lie inside another.

    Balls are compared exactly, others by points of their surfaces. `eye`, (3,), is where rounding
    should be least.
    """
    few = solids[:MOST_COMPARED]
    balls = [index for index, solid in enumerate(few) if isinstance(solid, Sphere)]
    center = np.array([few[i].middle for i in balls], np.float64).reshape(-1, 3) - eye
    radius = np.array([few[i].reach for i in balls], np.float64)
    for relation, a, b in _balls(center, radius):
        yield Found(relation, (balls[a], balls[b]))
    for first, second in islice(_near_pairs(few), MOST_PAIRS):
        yield from _between(few, first, second)


def _balls(center: Floats, radius: Floats) -> Iterator[tuple[Relation, int, int]]:
    """Yield pairs of balls whose surfaces meet in a circle, and balls within others."""
    for first in range(len(radius) - 1):
        apart = np.linalg.norm(center[first + 1 :] - center[first], axis=1)
        total, rest = radius[first + 1 :] + radius[first], radius[first + 1 :] - radius[first]
        slack = SLACK * total
        for second in np.flatnonzero((apart < total - slack) & (apart > np.abs(rest) + slack)):
            yield "cross", first, first + 1 + int(second)
        for second in np.flatnonzero(apart < rest - slack):
            yield "inside", first, first + 1 + int(second)
        for second in np.flatnonzero(apart < -rest - slack):
            yield "inside", first + 1 + int(second), first


def _near_pairs(solids: list[Shape]) -> Iterator[Pair]:
    """Yield pairs that are not both balls and whose bounding spheres meet."""
    single = [index for index, solid in enumerate(solids) if not isinstance(solid, Sphere)]
    for first in single:
        for second in range(len(solids)):
            is_twice = second in single and second <= first
            if second != first and not is_twice and _may_meet(solids[first], solids[second]):
                yield min(first, second), max(first, second)


def _may_meet(a: Shape, b: Shape) -> bool:
    return math.dist(a.middle, b.middle) < a.reach + b.reach  # infinite for a plane


def _between(solids: list[Shape], first: int, second: int) -> Iterator[Found]:
    a, b = solids[first], solids[second]
    if isinstance(a, Plane) and isinstance(b, Plane):
        if float(np.linalg.norm(np.cross(a.normal, b.normal))) > SLACK:
            yield Found("cross", (first, second))
        return
    depths = _depths(a, b), _depths(b, a)
    if share_a_plane(a.flat_faces, b.flat_faces, SLACK):
        yield Found("share a face", (first, second))
    elif any(low < 0 < high for low, high in depths):
        yield Found("cross", (first, second))
    elif depths[0][0] > 0:
        yield Found("inside", (first, second))
    elif depths[1][0] > 0:
        yield Found("inside", (second, first))


def _depths(solid: Shape, other: Shape) -> tuple[float, float]:
    """Return the least and the largest depth of a solid's surface points in another; 0 on it."""
    if isinstance(solid, Plane):
        return -math.inf, -math.inf
    depths = np.array([_depth(other, point) for point in _surface(solid)])
    depths[np.abs(depths) <= SLACK * solid.reach] = 0
    return float(depths.min()), float(depths.max())


def _surface(solid: Shape) -> Iterator[Floats]:
    """Yield the points where rays from a solid's middle leave it, evenly over all directions."""
    for direction in _directions():
        away = _distance(solid, direction)
        yield np.asarray(solid.middle) + away * direction


def _depth(solid: Shape, point: Floats) -> float:
    """Return how far a point is below a solid's surface, seen from its middle; negative outside."""
    if isinstance(solid, Plane):
        normal = np.asarray(solid.normal) / np.linalg.norm(solid.normal)
        return float((np.asarray(solid.point) - point) @ normal)
    offset = point - np.asarray(solid.middle)
    away = float(np.linalg.norm(offset))
    return _distance(solid, offset / away) - away if away else solid.reach


def _distance(solid: Object, direction: Floats) -> float:
    """Return the distance from a solid's middle to its surface in a direction."""
    rows = np.array([solid.row], np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(type(solid).distances(rows, np.asarray(solid.middle), direction)[0])


def _directions() -> Floats:
    """Return unit vectors spread over the sphere, (POINTS, 3): a Fibonacci lattice."""
    steps = np.arange(POINTS) + 0.5
    up = 1 - 2 * steps / POINTS
    around = np.pi * (1 + 5**0.5) * steps
    across = np.sqrt(1 - up * up)
    return np.stack([across * np.cos(around), up, across * np.sin(around)], axis=1)
