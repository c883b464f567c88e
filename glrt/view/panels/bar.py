"""Top of the panel: the present problem stays in sight while the rows scroll below it."""

from collections.abc import Iterator
from contextlib import contextmanager

from imgui_bundle import ImVec2, imgui

from glrt.view.app import App
from glrt.view.widgets.steady_widget import ANCHOR

_MOST = 0.3  # share of the panel's height that a problem may fill
_RED = (0.95, 0.35, 0.35, 1.0)


@contextmanager
def below_bar(app: App) -> Iterator[None]:
    """Draw the bar at the top of the panel; rows drawn inside the block are clipped below it."""
    panel, start = imgui.internal.get_current_window(), imgui.get_cursor_pos()
    imgui.set_cursor_pos_y(start.y + imgui.get_scroll_y())
    _problem(app)
    end = imgui.get_cursor_pos_y() - imgui.get_scroll_y()  # from the panel's corner
    panel.deco_inner_size_y1 = end - panel.deco_outer_size_y1  # focus by keys is not under it
    imgui.set_cursor_pos(ImVec2(start.x, end))
    ANCHOR.begin(end)
    clip = panel.inner_clip_rect
    imgui.push_clip_rect(ImVec2(clip.min.x, panel.pos.y + end), clip.max, True)
    yield
    imgui.pop_clip_rect()


def bar_end() -> float:
    """Return where the rows begin, in pixels from the panel's upper edge."""
    panel = imgui.internal.get_current_window()
    return float(panel.deco_outer_size_y1 + panel.deco_inner_size_y1)


def _problem(app: App) -> None:
    """Draw the present problem, which scrolls if it is long, and a button to dismiss it."""
    if not app.session.problem:
        return
    room = imgui.get_content_region_avail().x
    height = imgui.calc_text_size(app.session.problem, wrap_width=room).y
    most = max(_MOST * imgui.get_window_height(), 2 * imgui.get_text_line_height())
    is_long = height > most
    if is_long:
        imgui.begin_child("problem", ImVec2(0.0, most))
    imgui.push_style_color(imgui.Col_.text, _RED)
    imgui.text_wrapped(app.session.problem)
    imgui.pop_style_color()
    if is_long:
        imgui.end_child()
    if imgui.button("dismiss"):
        app.session.problem = ""
    imgui.separator()
