"""How much of the picture is seen, and where; pure functions of places on the screen."""

import math
from dataclasses import dataclass, replace

Pair = tuple[float, float]
Rectangle = tuple[float, float, float, float]  # left, top, width, height

MOST = 64.0  # pixels of the screen for one of the picture
LEAST = 1 / 16


@dataclass(frozen=True)
class Zoom:
    """`scale`: pixels of the screen for one of the picture; None: as large as fits.

    `center` is the point of the picture in the middle of the room, (0, 0) upper left to (1, 1).
    """

    scale: float | None = None
    center: Pair = (0.5, 0.5)

    def scale_in(self, room: Pair, size: Pair) -> float:
        """The scale in a room, as of a picture of this size."""
        return self.scale or min(room[0] / size[0], room[1] / size[1])

    def placed(self, room: Pair, size: Pair) -> Rectangle:
        """Where the picture lies, from the upper left of the room; it may reach out of it.

        Beside one that fits, pixels of the screen begin where those of the picture do.
        """
        scale = self.scale_in(room, size)
        width, height = max(1.0, scale * size[0]), max(1.0, scale * size[1])
        if not self.scale:
            return ((room[0] - width) / 2, (room[1] - height) / 2, width, height)
        x, y = self.center
        left, top = math.floor(room[0] / 2 - x * width), math.floor(room[1] / 2 - y * height)
        return (left, top, width, height)

    def about(self, room: Pair, size: Pair, at: Pair, factor: float) -> "Zoom":
        """Larger by a factor, so that the point of the picture at a place of the room stays."""
        left, top, width, height = self.placed(room, size)
        scale = max(LEAST, min(self.scale_in(room, size) * factor, MOST))
        share = (at[0] - left) / width, (at[1] - top) / height
        aside = (room[0] / 2 - at[0]) / scale / size[0], (room[1] / 2 - at[1]) / scale / size[1]
        return Zoom(scale, _inside((share[0] + aside[0], share[1] + aside[1])))

    def to(self, scale: float) -> "Zoom":
        """To a scale, about the middle of the room."""
        return replace(self, scale=scale)

    def shifted(self, size: Pair, across: float, down: float) -> "Zoom":
        """Moved by pixels of the screen; one that fits has nowhere to go."""
        if not self.scale:
            return self
        x, y = self.center
        moved = x - across / (self.scale * size[0]), y - down / (self.scale * size[1])
        return replace(self, center=_inside(moved))


FIT = Zoom()


def common(first: Rectangle, second: Rectangle) -> Rectangle:
    """Where two rectangles overlap; of no size where they do not."""
    left, top = max(first[0], second[0]), max(first[1], second[1])
    right = min(first[0] + first[2], second[0] + second[2])
    low = min(first[1] + first[3], second[1] + second[3])
    return left, top, max(right - left, 0.0), max(low - top, 0.0)


def _inside(center: Pair) -> Pair:
    """So that some of the picture stays in sight."""
    x, y = (min(max(part, 0.0), 1.0) for part in center)
    return x, y
