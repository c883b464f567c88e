"""Legend of false colours over the picture: a title, and a bar with numbers."""

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.rendering.screen.false_colors import Color, Scale
from glrt.view.state.costs import limit_beyond
from glrt.view.state.error_history import Look
from glrt.view.state.session import Session
from glrt.view.viewport.picture_view import PictureView
from glrt.view.viewport.views import has_scale, ticks_of, title_of

_BACK = (0.0, 0.0, 0.0, 0.72)  # white text on it is legible over any picture, in both themes
_TEXT = (1.0, 1.0, 1.0, 1.0)
_TALLEST = 1.0  # height of the bar, in lines of text
HEIGHT = 4.2  # of the whole legend, in lines of text


def draw_legend(
    show: PictureView,
    session: Session,
    last: Look | None,
    corner: ImVec2,
    width: float,
) -> None:
    """Draw the legend of the view; `corner`: lower left of the picture, `width`: its width."""
    title = title_of(show.drawn, session.scene.camera, limit_beyond(session))
    if not has_scale(show.drawn):
        return _draw_title(title, corner)
    if show.drawn == "dropped" and last and not last.nonfinite:
        title = "no sample was dropped"
    return _draw(title, show.scale, ticks_of(show.drawn, show.scale), corner, width)


def _draw_title(title: str, corner: ImVec2) -> None:
    painter, em = imgui.get_window_draw_list(), hello_imgui.em_size(1)
    line = imgui.get_text_line_height()
    size = imgui.calc_text_size(title) + ImVec2(3 * em, 0.8 * line)
    low = corner + ImVec2(0, -size.y)
    painter.add_rect_filled(low, low + size, _code(_BACK))
    painter.add_text(low + ImVec2(1.5 * em, 0.4 * line), _code(_TEXT), title)


def _draw(title: str, scale: Scale, ticks: dict[float, str], corner: ImVec2, width: float) -> None:
    painter, em = imgui.get_window_draw_list(), hello_imgui.em_size(1)
    line = imgui.get_text_line_height()
    length = min(width - 4 * em, 20 * em)
    size = ImVec2(length + 4 * em, HEIGHT * line)
    low = corner + ImVec2(0, -size.y)
    painter.add_rect_filled(low, low + size, _code(_BACK))
    painter.add_text(low + ImVec2(1.5 * em, 0.4 * line), _code(_TEXT), title)
    bar = low + ImVec2(2 * em, 1.6 * line)
    _draw_bar(scale, bar, ImVec2(length, _TALLEST * line))
    for number, name in ticks.items():
        place = bar + ImVec2(float(scale.share(number)) * length, _TALLEST * line)
        painter.add_line(place, place + ImVec2(0, 0.2 * line), _code(_TEXT))
        text = ImVec2(-imgui.calc_text_size(name).x / 2, 0.2 * line)
        painter.add_text(place + text, _code(_TEXT), name)


def _draw_bar(scale: Scale, at: ImVec2, size: ImVec2) -> None:
    painter, steps = imgui.get_window_draw_list(), len(scale.colors) - 1
    for number, (left, right) in enumerate(zip(scale.colors, scale.colors[1:], strict=False)):
        start = at + ImVec2(number * size.x / steps, 0)
        end = at + ImVec2((number + 1) * size.x / steps, size.y)
        first, last = _opaque(left), _opaque(right)
        painter.add_rect_filled_multi_color(start, end, first, last, last, first)


def _opaque(color: Color) -> int:
    return _code((*color, 1.0))


def _code(color: tuple[float, float, float, float]) -> int:
    return int(imgui.get_color_u32(color))
