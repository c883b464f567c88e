"""Visible part of the picture, by pure functions of places on the screen, in pixels."""

import math
from dataclasses import dataclass, replace

Pair = tuple[float, float]
Rectangle = tuple[float, float, float, float]  # left, top, width, height

MOST = 64.0  # screen pixels per picture pixel
LEAST = 1 / 16


@dataclass(frozen=True)
class Zoom:
    """Zoom of the picture; `scale`: screen pixels per picture pixel, None: as large as fits.

    `center` is the point of the picture in the middle of the room, (0, 0) upper left to (1, 1).
    The room is the part of the screen for the picture.
    """

    scale: float | None = None
    center: Pair = (0.5, 0.5)

    def scale_in(self, room: Pair, size: Pair) -> float:
        """Return the scale of a picture of this size in a room."""
        return self.scale or min(room[0] / size[0], room[1] / size[1])

    def placed(self, room: Pair, size: Pair) -> Rectangle:
        """Return the picture's rectangle, from the upper left of the room; it may exceed the room.

        Unless the picture is as large as fits, it begins at a whole pixel of the screen.
        """
        scale = self.scale_in(room, size)
        width, height = max(1.0, scale * size[0]), max(1.0, scale * size[1])
        if not self.scale:
            return ((room[0] - width) / 2, (room[1] - height) / 2, width, height)
        x, y = self.center
        left, top = math.floor(room[0] / 2 - x * width), math.floor(room[1] / 2 - y * height)
        return (left, top, width, height)

    def about(self, room: Pair, size: Pair, at: Pair, factor: float) -> "Zoom":
        """Return the zoom times a factor; the point of the picture at `at` in the room stays."""
        left, top, width, height = self.placed(room, size)
        scale = max(LEAST, min(self.scale_in(room, size) * factor, MOST))
        share = (at[0] - left) / width, (at[1] - top) / height
        aside = (room[0] / 2 - at[0]) / scale / size[0], (room[1] / 2 - at[1]) / scale / size[1]
        return Zoom(scale, _inside((share[0] + aside[0], share[1] + aside[1])))

    def to(self, scale: float) -> "Zoom":
        """Return the zoom with another scale, about the middle of the room."""
        return replace(self, scale=scale)

    def shifted(self, size: Pair, across: float, down: float) -> "Zoom":
        """Return the zoom moved by screen pixels; a picture as large as fits does not move."""
        if not self.scale:
            return self
        x, y = self.center
        moved = x - across / (self.scale * size[0]), y - down / (self.scale * size[1])
        return replace(self, center=_inside(moved))


FIT = Zoom()


def common(first: Rectangle, second: Rectangle) -> Rectangle:
    """Return the overlap of two rectangles; its size is 0 where they do not overlap."""
    left, top = max(first[0], second[0]), max(first[1], second[1])
    right = min(first[0] + first[2], second[0] + second[2])
    low = min(first[1] + first[3], second[1] + second[3])
    return left, top, max(right - left, 0.0), max(low - top, 0.0)


def _inside(center: Pair) -> Pair:
    """Return the nearest centre that keeps some of the picture in sight."""
    x, y = (min(max(part, 0.0), 1.0) for part in center)
    return x, y
