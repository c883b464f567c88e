"""Where things stand in a scene by chance: none in another, none before the camera's very eye."""

import math
from typing import NamedTuple

from bench.dice import Dice

Point = tuple[float, float, float]

DIGITS = 5  # after the point, of every number
SMALLEST = 0.008  # radius
NEAR = 0.5  # from the camera: nothing comes closer than this, and its own diameter
GAP = 0.02  # between things, and to a wall
TRIES = 60  # places that are tried for a thing; after each third it is halved


class Space(NamedTuple):
    """Where things stand: |x| <= half_width, 0 <= y <= height, |z| <= depth."""

    half_width: float
    height: float
    depth: float

    def holds(self, center: Point, radius: float) -> bool:
        """Whether a ball is inside, a gap away from walls and ceiling; it may touch the floor."""
        x, y, z = center
        room = radius + GAP
        is_wide = abs(x) + room <= self.half_width and abs(z) + room <= self.depth
        return is_wide and radius <= y <= self.height - room


class Ball(NamedTuple):
    """Space that is taken."""

    center: Point
    radius: float


class Free:
    """Finds free balls for things, which are then taken."""

    def __init__(self, dice: Dice, space: Space, eye: Point) -> None:
        """All is free but the camera's place, `eye`."""
        self.dice, self.space, self.eye = dice, space, eye
        self.taken: list[Ball] = []

    def place(self, size: float, height: float | None = None, wide: float = 1) -> Ball | None:
        """A free ball of about this radius, or None; at `height`, or on the floor.

        `wide` is the share of the space, around its middle, where it may be.
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
        """Whether it keeps clear of all others, and does not fill the camera's view."""
        center, radius = ball
        if math.dist(center, self.eye) < radius + max(NEAR, 2 * radius):
            return False
        return all(math.dist(center, c) >= radius + r + GAP for c, r in self.taken)
