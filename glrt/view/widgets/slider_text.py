"""Place of the number in a slider: next to the grip, not under it."""

import math
from typing import NamedTuple

_PADDING = 2.0  # pixels between the grip and the edge, as in Dear ImGui


class Slider(NamedTuple):
    """A slider on the screen, in pixels; `share` of its range is to the left of the value."""

    width: float
    grip: float
    share: float

    @property
    def middle(self) -> float:
        """Middle of the grip, in pixels from the left end of the slider."""
        room = self.width - 2 * _PADDING - self.grip
        return _PADDING + self.grip / 2 + self.share * room


def share_of(value: float, low: float, high: float, is_logarithmic: bool) -> float:
    """Return the place of a value in its range, from 0 to 1."""
    if is_logarithmic:
        value, low, high = (math.log(max(part, low)) for part in (value, low, high))
    return min(max((value - low) / (high - low), 0.0), 1.0)


def text_next_to_grip(form: str, slider: Slider, text: float, space: float) -> str:
    """Return the format of a number, which Dear ImGui centres: spaces push it off the grip.

    `text` and `space` are the widths of the number and of a space, in pixels.
    """
    if abs(slider.middle - slider.width / 2) > (slider.grip + text) / 2 + space:
        return form
    spaces = " " * max(0, int((slider.width - text - 4 * _PADDING) / space))
    return f"{spaces}{form}" if slider.share < 0.5 else f"{form}{spaces}"
