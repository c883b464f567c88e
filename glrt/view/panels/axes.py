"""The axes of the scene in a corner of the picture: a click on one looks along it."""

from typing import NamedTuple

import numpy as np
from imgui_bundle import ImVec2, imgui

from glrt.view.app import App
from glrt.view.state.zoom import Rectangle
from glrt.view.viewport.orbit import axes
from glrt.view.viewport.sides import SIDES

_NAMES = {"right": "x", "top": "y", "front": "z"}  # of the axis that points to a side
_COLORS = ((0.93, 0.33, 0.31), (0.51, 0.77, 0.16), (0.33, 0.58, 0.98))  # x, y, z
_LENGTH, _RADIUS = 2.4, 0.62  # of an axis and of its end, in sizes of the font
_FAR = 0.45  # opacity of what points away from the camera
_EDGE_ON = 1e-6  # cosine below which an axis points neither way


class _End(NamedTuple):
    near: float  # cosine of the angle between the axis and the way to the camera
    side: str
    place: ImVec2
    color: tuple[float, float, float]


def draw_axes(app: App, seen: Rectangle) -> None:
    """Draw them in the upper right of the part `seen` of the picture, if they are wanted."""
    ends = _ends(app, seen)
    if not ends:
        return
    ground = imgui.get_color_u32((0.0, 0.0, 0.0, 0.25))
    font, painter = imgui.get_font_size(), imgui.get_window_draw_list()
    painter.add_circle_filled(_middle(seen), _room() / 2, ground)
    for end in ends:
        _draw_end(end, _middle(seen), _RADIUS * font)


def click_axes(app: App, seen: Rectangle) -> bool:
    """Look along an axis that is clicked; return whether the mouse is over one."""
    radius, is_over = _RADIUS * imgui.get_font_size(), False
    for end in reversed(_ends(app, seen)):  # the nearest takes the mouse
        imgui.set_cursor_screen_pos(end.place - ImVec2(radius, radius))
        if imgui.invisible_button(f"axis {end.side}", ImVec2(2 * radius, 2 * radius)):
            app.see_from(end.side)
        imgui.set_item_tooltip(f"see the {end.side} of the scene")
        is_over |= imgui.is_item_hovered()
    return is_over


def _room() -> float:
    return 2 * (_LENGTH + 2 * _RADIUS) * imgui.get_font_size()


def _middle(seen: Rectangle) -> ImVec2:
    return ImVec2(seen[0] + seen[2] - _room() / 2, seen[1] + _room() / 2)


def _ends(app: App, seen: Rectangle) -> list[_End]:
    """Return the ends of the axes, the farthest first; none where there is no room."""
    if not app.preferences.axes or min(seen[2:]) < _room():
        return []
    right, up, forward = axes(app.camera)
    middle, length, found = _middle(seen), _LENGTH * imgui.get_font_size(), list[_End]()
    for side, way in SIDES.items():
        across, above, away = (float(np.dot(way, axis)) for axis in (right, up, forward))
        place = middle + ImVec2(length * across, -length * above)
        found.append(_End(-away, side, place, _COLORS[int(np.argmax(np.abs(way)))]))
    return sorted(found, key=lambda end: end.near)


def _draw_end(end: _End, middle: ImVec2, radius: float) -> None:
    """Draw an end, with its line and name where the axis points there."""
    painter, opacity = imgui.get_window_draw_list(), 1.0 if end.near > -_EDGE_ON else _FAR
    color = imgui.get_color_u32((*end.color, opacity))
    name = _NAMES.get(end.side, "")
    if not name:
        painter.add_circle_filled(end.place, radius, imgui.get_color_u32((0, 0, 0, 0.35 * opacity)))
        painter.add_circle(end.place, radius, color, 0, 1.5)
        return
    painter.add_line(middle, end.place, color, 2.5)
    painter.add_circle_filled(end.place, radius, color)
    size, black = imgui.calc_text_size(name), imgui.get_color_u32((0, 0, 0, 1))
    painter.add_text(end.place - ImVec2(size.x / 2, size.y / 2), black, name)
