"""Draw the picture, and the one to compare it with: side by side, or divided by a line."""

import math

from imgui_bundle import ImVec2, imgui

from glrt.view.app import App
from glrt.view.state.zoom import Rectangle
from glrt.view.viewport.picture import Picture

_NOTICE = (0.0, 0.0, 0.0, 0.65)


def draw_image(
    app: App, place: Rectangle, seen: Rectangle, picture: Picture, is_kept: bool = False
) -> None:
    """Draw a picture, or only its visible part with sharp pixels if it is magnified."""
    (left, top, width, height), painter = place, imgui.get_window_draw_list()
    name = picture.kept_name if is_kept else picture.name
    columns, rows = picture.size
    if app.zoom.scale and app.zoom.scale > 1 and min(seen[2:]) >= 1:
        across, down = columns / width, rows / height
        part = (seen[0] - left) * across, (seen[1] - top) * down, seen[2] * across, seen[3] * down
        name = picture.part(part, (round(seen[2]), round(seen[3])), is_kept)
        left, top, width, height = seen
    end = (left + width, top + height)
    painter.add_image(imgui.ImTextureRef(name), (left, top), end, (0, 1), (1, 0))  # row 0 is lowest


def _draw_a(app: App, place: Rectangle, seen: Rectangle) -> None:
    kept = app.pair.picture
    if kept:
        draw_image(app, place, seen, *kept)


def draw_side_by_side(app: App, seen: Rectangle, step: float) -> None:
    """Draw A to the left of B, the same part of it, and the names of both."""
    (left, top, width, height), painter = app.rectangle, imgui.get_window_draw_list()
    shown = (seen[0] - step, *seen[1:])
    painter.push_clip_rect(shown[:2], (shown[0] + shown[2], shown[1] + shown[3]), True)
    _draw_a(app, (left - step, top, width, height), shown)
    painter.pop_clip_rect()
    low = seen[1] + seen[3] - imgui.get_font_size() * 2.4
    for name, x in (("A", shown[0]), ("B", seen[0])):
        draw_notice(name, ImVec2(x, low))


def draw_wipe(app: App, seen: Rectangle) -> None:
    """Draw A over the left part of B, and the line between them."""
    left, top, width, height = app.rectangle
    share = app.show.wipe
    painter, edge = imgui.get_window_draw_list(), math.floor(left + share * width) + 0.5
    painter.push_clip_rect((left, top), (edge, top + height), True)
    _draw_a(app, app.rectangle, seen)
    painter.pop_clip_rect()
    black, white = (imgui.get_color_u32((c, c, c, 1.0)) for c in (0.0, 1.0))
    for color, thickness in ((black, 3.0), (white, 1.0)):  # visible on any picture
        painter.add_line((edge, top), (edge, top + height), color, thickness)
    for name, x in (("A", edge - imgui.get_font_size() * 2.4), ("B", edge)):
        draw_notice(name, ImVec2(x, top + height - imgui.get_font_size() * 2.4))


def draw_wipe_handle(app: App) -> None:
    """Let the mouse drag the line between A and B."""
    left, top, width, height = app.rectangle
    grip = imgui.get_font_size() * 0.7
    imgui.set_cursor_screen_pos(ImVec2(left + app.show.wipe * width - grip / 2, top))
    imgui.invisible_button("wipe", ImVec2(grip, height))
    if imgui.is_item_hovered() or imgui.is_item_active():
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew.value)
    if imgui.is_item_active():
        share = (imgui.get_io().mouse_pos.x - left) / width
        app.show.wipe = min(max(share, 0.0), 1.0)


def draw_notice(text: str, corner: ImVec2, width: float = 0.0) -> float:
    """Draw a text over the picture, wrapped at `width` pixels if given; return its height."""
    em = imgui.get_font_size()
    margin, room = ImVec2(em * 0.6, em * 0.4), max(width - 2.4 * em, 8 * em) if width else 0.0
    painter, at = imgui.get_window_draw_list(), corner + margin
    size = imgui.calc_text_size(text, wrap_width=room or -1.0) + margin + margin
    painter.add_rect_filled(at, at + size, imgui.get_color_u32(_NOTICE), 4.0)
    white = imgui.get_color_u32((1.0, 1.0, 1.0, 1.0))
    painter.add_text(imgui.get_font(), em, at + margin, white, text, wrap_width=room)
    return size.y + margin.y
