"""The axes of the scene in a corner of the picture: a click on one looks along it."""

import numpy as np
from imgui_bundle import ImVec2, imgui

from glrt.view.app import App
from glrt.view.state.zoom import Rectangle
from glrt.view.viewport.orbit import axes

_ENDS = (  # side of the scene, name of the axis that points there, its unit vector
    ("right", "x", (1.0, 0.0, 0.0)),
    ("top", "y", (0.0, 1.0, 0.0)),
    ("front", "z", (0.0, 0.0, 1.0)),
    ("left", "", (-1.0, 0.0, 0.0)),
    ("bottom", "", (0.0, -1.0, 0.0)),
    ("back", "", (0.0, 0.0, -1.0)),
)
_COLORS = ((0.93, 0.33, 0.31), (0.51, 0.77, 0.16), (0.33, 0.58, 0.98))  # x, y, z
_LENGTH, _RADIUS = 2.4, 0.62  # of an axis and of its end, in sizes of the font
_FAR = 0.45  # opacity of what points away from the camera


def draw_axes(app: App, seen: Rectangle) -> bool:
    """Draw them in the upper right of the part `seen` of the picture, if they are wanted.

    Returns whether the mouse is over one: a click is then none on the picture.
    """
    font = imgui.get_font_size()
    room = 2 * (_LENGTH + 2 * _RADIUS) * font
    if not app.preferences.axes or min(seen[2:]) < room:
        return False
    middle = ImVec2(seen[0] + seen[2] - room / 2, seen[1] + room / 2)
    right, up, forward = axes(app.camera)
    ends = [(float(-np.dot(way, forward)), number) for number, (_, _, way) in enumerate(_ENDS)]
    places = {
        number: middle
        + ImVec2(
            _LENGTH * font * float(np.dot(way, right)), -_LENGTH * font * float(np.dot(way, up))
        )
        for number, (_, _, way) in enumerate(_ENDS)
    }
    radius = _RADIUS * font
    nearest_first = [number for _, number in sorted(ends, reverse=True)]  # it takes the mouse
    is_over = [_button(app, number, places[number], radius) for number in nearest_first]
    ground = imgui.get_color_u32((0.0, 0.0, 0.0, 0.25))
    imgui.get_window_draw_list().add_circle_filled(middle, room / 2, ground)
    for near, number in sorted(ends):
        _draw_end(number, middle, places[number], radius, near)
    return any(is_over)


def _button(app: App, number: int, place: ImVec2, radius: float) -> bool:
    """Let a click look along an axis; return whether the mouse is over its end."""
    side = _ENDS[number][0]
    imgui.set_cursor_screen_pos(place - ImVec2(radius, radius))
    if imgui.invisible_button(f"axis {side}", ImVec2(2 * radius, 2 * radius)):
        app.see_from(side)
    imgui.set_item_tooltip(f"see the {side} of the scene")
    return bool(imgui.is_item_hovered())


def _draw_end(number: int, middle: ImVec2, place: ImVec2, radius: float, near: float) -> None:
    """Draw an end, with its line and name where the axis points there."""
    _, name, _ = _ENDS[number]
    painter, opacity = imgui.get_window_draw_list(), 1.0 if near > -1e-6 else _FAR
    color = imgui.get_color_u32((*_COLORS[number % 3], opacity))
    if not name:
        painter.add_circle_filled(place, radius, imgui.get_color_u32((0, 0, 0, 0.35 * opacity)))
        painter.add_circle(place, radius, color, 0, 1.5)
        return
    painter.add_line(middle, place, color, 2.5)
    painter.add_circle_filled(place, radius, color)
    size = imgui.calc_text_size(name)
    painter.add_text(
        place - ImVec2(size.x / 2, size.y / 2), imgui.get_color_u32((0, 0, 0, 1)), name
    )
