"""Glass that crosses glass: light between the two is refracted as if it entered air."""

import math
from collections.abc import Iterator
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from glrt.scene.objects import Object
from glrt.scene.shapes import Plane, Shape, Sphere

MOST_COMPARED = 1000  # solids that are looked at with all others
MOST_PAIRS = 300  # of solids near each other, of which one is no ball, that are looked at
POINTS = 256  # of a surface
SLACK = 1e-6  # of the size: solids that were meant to touch do

Floats = NDArray[np.float64]
Pair = tuple[int, int]


def first_crossing(solids: list[Shape], eye: Floats) -> Pair | None:
    """The first two of the solids, by index, whose surfaces cross; None if none do.

    A solid within another is fine, and so is one that touches another. Balls are compared exactly,
    others by points of their surfaces. `eye` is where rounding should be least, (3,).
    """
    few = solids[:MOST_COMPARED]
    balls = [index for index, solid in enumerate(few) if isinstance(solid, Sphere)]
    center = np.array([few[i].middle for i in balls], np.float64).reshape(-1, 3) - eye
    radius = np.array([few[i].reach for i in balls], np.float64)
    exact = ((balls[a], balls[b]) for a, b in _crossing_balls(center, radius))
    others = (pair for pair in islice(_near_pairs(few), MOST_PAIRS) if _cross(few, pair))
    return min(filter(None, (next(exact, None), next(others, None))), default=None)


def _crossing_balls(center: Floats, radius: Floats) -> Iterator[Pair]:
    """Pairs of balls whose surfaces meet in a circle, not in a point."""
    for first in range(len(radius) - 1):
        apart = np.linalg.norm(center[first + 1 :] - center[first], axis=1)
        total, rest = radius[first + 1 :] + radius[first], radius[first + 1 :] - radius[first]
        slack = SLACK * total
        for second in np.flatnonzero((apart < total - slack) & (apart > np.abs(rest) + slack)):
            yield first, first + 1 + int(second)


def _near_pairs(solids: list[Shape]) -> Iterator[Pair]:
    """Pairs that are not both balls and whose bounding spheres meet."""
    single = [index for index, solid in enumerate(solids) if not isinstance(solid, Sphere)]
    for first in single:
        for second in range(len(solids)):
            is_twice = second in single and second <= first
            if second != first and not is_twice and _may_meet(solids[first], solids[second]):
                yield min(first, second), max(first, second)


def _may_meet(a: Shape, b: Shape) -> bool:
    if isinstance(a, Plane) or isinstance(b, Plane):
        return True
    return math.dist(a.middle, b.middle) < a.reach + b.reach


def _cross(solids: list[Shape], pair: Pair) -> bool:
    a, b = (solids[index] for index in pair)
    if isinstance(a, Plane) and isinstance(b, Plane):
        return float(np.linalg.norm(np.cross(a.normal, b.normal))) > SLACK
    return any(_is_cut(solid, other) for solid, other in ((a, b), (b, a)))


def _is_cut(solid: Shape, other: Shape) -> bool:
    """Whether some points of a solid's surface lie inside another and some outside."""
    if isinstance(solid, Plane):
        return False
    depths = [_depth(other, point) for point in _surface(solid)]
    slack = SLACK * solid.reach
    return max(depths) > slack and min(depths) < -slack


def _surface(solid: Shape) -> Iterator[Floats]:
    """Points that rays from its middle meet, evenly over all directions."""
    for direction in _directions():
        away = _distance(solid, direction)
        yield np.asarray(solid.middle) + away * direction


def _depth(solid: Shape, point: Floats) -> float:
    """How far a point lies below the surface of a solid, seen from its middle; negative outside."""
    if isinstance(solid, Plane):
        normal = np.asarray(solid.normal) / np.linalg.norm(solid.normal)
        return float((np.asarray(solid.point) - point) @ normal)
    offset = point - np.asarray(solid.middle)
    away = float(np.linalg.norm(offset))
    return _distance(solid, offset / away) - away if away else solid.reach


def _distance(solid: Object, direction: Floats) -> float:
    """From its middle to its surface."""
    rows = np.array([solid.row], np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(type(solid).distances(rows, np.asarray(solid.middle), direction)[0])


def _directions() -> Floats:
    """Spread over the sphere, (POINTS, 3): Fibonacci's."""
    steps = np.arange(POINTS) + 0.5
    up = 1 - 2 * steps / POINTS
    around = np.pi * (1 + 5**0.5) * steps
    across = np.sqrt(1 - up * up)
    return np.stack([across * np.cos(around), up, across * np.sin(around)], axis=1)
