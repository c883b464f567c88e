"""Marks for the cost of an edit, at the right edge of a row of the panel."""

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.settings import Cost
from glrt.view.controls import MEANING
from glrt.view.widgets.tips import explain

# Hues distinguish the classes in both themes, and shapes do so without hues: see `_draw`.
COLORS = {
    Cost.FREE: (0.30, 0.66, 0.36, 1.0),
    Cost.RELIGHT: (0.30, 0.58, 0.90, 1.0),
    Cost.RESTART: (0.85, 0.58, 0.13, 1.0),
    Cost.RECOMPILE: (0.88, 0.36, 0.36, 1.0),
}
_SIZE = 0.9  # em: width of a mark
_RADIUS = 0.26  # em
_LINE = 1.5  # pixels


def legend() -> None:
    """Draw the classes of cost and their meanings."""
    for cost, meaning in MEANING.items():
        _mark(cost, imgui.get_text_line_height())
        imgui.same_line()
        imgui.text_colored(COLORS[cost], cost.value)
        imgui.same_line(hello_imgui.em_size(7))
        imgui.text_wrapped(meaning)


def tag(cost: Cost) -> None:
    """Draw the cost of the item drawn last; in a new line if that leaves no room."""
    end = imgui.get_item_rect_max().x - imgui.get_window_pos().x
    if end > _tags_end() - hello_imgui.em_size(_SIZE):
        imgui.new_line()
    tags(((cost, ""),))


def tags(costs: tuple[tuple[Cost, str], ...]) -> None:
    """Draw costs at the right edge, each with the values that it applies to as a tooltip."""
    height = min(imgui.get_item_rect_size().y, imgui.get_frame_height())
    imgui.same_line(_tags_end() - len(costs) * hello_imgui.em_size(_SIZE))
    for number, (cost, where) in enumerate(costs):
        if number:
            imgui.same_line(0.0, 0.0)
        _mark(cost, height)
        explain(f"{cost.value} {where}".strip() + f": {MEANING[cost]}")


def tags_start() -> float:
    """Return where marks of two costs begin, in pixels from the window's left edge."""
    return _tags_end() - 2 * hello_imgui.em_size(_SIZE)


def _mark(cost: Cost, height: float) -> None:
    """Draw a ring for free, one around a dot for relight, a disk for restart, else a square."""
    corner = imgui.get_cursor_screen_pos()
    size = ImVec2(hello_imgui.em_size(_SIZE), height)
    imgui.dummy(size)
    painter, middle = imgui.get_window_draw_list(), corner + size / 2
    radius, color = hello_imgui.em_size(_RADIUS), imgui.get_color_u32(COLORS[cost])
    if cost is Cost.RECOMPILE:
        half = ImVec2(radius, radius)
        painter.add_rect_filled(middle - half, middle + half, color)
    elif cost is Cost.RESTART:
        painter.add_circle_filled(middle, radius, color)
    else:
        painter.add_circle(middle, radius, color, 0, _LINE)
    if cost is Cost.RELIGHT:
        painter.add_circle_filled(middle, radius / 2, color)


def _tags_end() -> float:
    """Return the right edge of the panel's content, in pixels from the window's left edge."""
    style = imgui.get_style()
    return imgui.get_window_width() - style.scrollbar_size - style.window_padding.x
