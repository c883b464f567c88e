"""Bar below the picture: messages at the left, figures at the right."""

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.view.app import App
from glrt.view.panels.plots import short_figures
from glrt.view.widgets.tips import explain

_FIGURES = 0.45  # largest share of the bar that figures take
_BETWEEN = "  |  "


def height_of_status() -> float:
    """Return the height of the bar with the space above it, in pixels."""
    return float(imgui.get_text_line_height_with_spacing() + imgui.get_style().item_spacing.y)


def draw_status(app: App, lines: list[str]) -> None:
    """Draw messages, and the figures of the picture if there is room for both."""
    start, width = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail().x
    imgui.dummy(ImVec2(width, imgui.get_text_line_height()))  # an item, whatever is drawn here
    figures = short_figures(app)
    side = imgui.calc_text_size(figures).x
    has_room = side < _FIGURES * width
    _messages(lines, start, width - (side + hello_imgui.em_size(1)) * has_room)
    if has_room:
        imgui.set_cursor_screen_pos(start + ImVec2(width - side, 0.0))
        imgui.text_disabled(figures)
        explain("Samples, error, and frames a second; the part Figures has more")


def _messages(lines: list[str], start: ImVec2, width: float) -> None:
    """Draw messages in one line, or in more, which cover the lower edge of the picture."""
    if not lines:
        return
    text = _BETWEEN.join(lines)
    if imgui.calc_text_size(text).x > width:
        text = "\n".join(lines)
    size = imgui.calc_text_size(text, wrap_width=width)
    line = imgui.get_text_line_height()
    top = start + ImVec2(0.0, line - size.y)
    painter, color = imgui.get_window_draw_list(), imgui.get_color_u32(imgui.Col_.window_bg)
    if size.y > line:
        margin = imgui.get_style().item_spacing
        painter.add_rect_filled(top - margin, top + size + margin, color)
    white = imgui.get_color_u32(imgui.Col_.text)
    painter.add_text(imgui.get_font(), imgui.get_font_size(), top, white, text, wrap_width=width)
