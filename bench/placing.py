"""Random positions of objects in a scene, without overlaps and not too close to the camera."""

import math
from typing import NamedTuple

from bench.dice import Dice

Point = tuple[float, float, float]

DIGITS = 5  # decimal places of all numbers
SMALLEST = 0.008  # radius
NEAR = 0.5  # least distance from the camera; it is also at least the diameter of the object
GAP = 0.02  # least distance between objects, and to walls
TRIES = 60  # positions that are tried for an object; after each third its size is halved


class Space(NamedTuple):
    """The space for objects: |x| <= half_width, 0 <= y <= height, |z| <= depth."""

    half_width: float
    height: float
    depth: float

    def holds(self, center: Point, radius: float) -> bool:
        """Whether a sphere is inside, GAP away from walls and ceiling; it may touch the floor."""
        x, y, z = center
        room = radius + GAP
        is_wide = abs(x) + room <= self.half_width and abs(z) + room <= self.depth
        return is_wide and radius <= y <= self.height - room


class Ball(NamedTuple):
    """A sphere of occupied space."""

    center: Point
    radius: float


class Free:
    """Finds free spheres for objects, and marks them as occupied."""

    def __init__(self, dice: Dice, space: Space, eye: Point) -> None:
        """With no objects yet; `eye` is the position of the camera."""
        self.dice, self.space, self.eye = dice, space, eye
        self.taken: list[Ball] = []

    def place(self, size: float, height: float | None = None, wide: float = 1) -> Ball | None:
        """Occupy a free sphere of radius `size` or less, at `height` or on the floor; None if full.

        Its centre is within the share `wide` of the width and depth, around the middle.
        """
        space, radius = self.space, size
        for attempt in range(TRIES):
            if attempt and attempt % (TRIES // 3) == 0:
                radius = max(radius / 2, min(radius, SMALLEST))
            radius = round(radius, DIGITS)
            x = self.dice.within(-1, 1) * wide * space.half_width
            z = self.dice.within(-1, 1) * wide * space.depth
            ball = Ball((x, radius if height is None else height, z), radius)
            if space.holds(*ball) and self._is_free(ball):
                self.taken.append(ball)
                return ball
        return None

    def _is_free(self, ball: Ball) -> bool:
        """Whether it overlaps no other sphere and is not too close to the camera."""
        center, radius = ball
        if math.dist(center, self.eye) < radius + max(NEAR, 2 * radius):
            return False
        return all(math.dist(center, c) >= radius + r + GAP for c, r in self.taken)
