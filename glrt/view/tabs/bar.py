"""Top of the panel: its tabs and the present problem, which stay while the rows scroll below."""

from collections.abc import Iterator
from contextlib import contextmanager

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.view.app import App
from glrt.view.controls import replaced
from glrt.view.state.preferences import Tab
from glrt.view.widgets.fields import beside
from glrt.view.widgets.steady_widget import ANCHOR

_MOST = 0.3  # share of the panel's height that a problem may fill
_LEAST = 9.0  # em: of a panel with its tabs in lines
_LINE = 2.0  # pixels, below the tab that is shown
_RED = (0.95, 0.35, 0.35, 1.0)


@contextmanager
def below_bar(app: App, tabs: tuple[Tab, ...]) -> Iterator[None]:
    """Draw the bar at the top of the panel; rows drawn inside the block are clipped below it."""
    panel, start = imgui.internal.get_current_window(), imgui.get_cursor_pos()
    imgui.set_cursor_pos_y(start.y + imgui.get_scroll_y())
    _tabs(app, tabs)
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


def _tabs(app: App, tabs: tuple[Tab, ...]) -> None:
    """Draw the names of tabs, in as many lines as they need, or as a list if that is too many."""
    if imgui.get_content_region_avail().x < hello_imgui.em_size(_LEAST):
        return _list_of(app, tabs)
    style = imgui.get_style()
    for number, tab in enumerate(tabs):
        if number:
            beside(tab)
        is_chosen = tab == app.preferences.tab
        color = imgui.Col_.tab_selected if is_chosen else imgui.Col_.tab
        imgui.push_style_color(imgui.Col_.button, style.color_(color))
        imgui.push_style_color(imgui.Col_.button_hovered, style.color_(imgui.Col_.tab_hovered))
        if imgui.button(f"{tab}##tab") and not is_chosen:
            app.prefer(replaced(app.preferences, tab=tab))
        imgui.pop_style_color(2)
        if is_chosen:
            _underline()
    imgui.separator()
    return None


def _list_of(app: App, tabs: tuple[Tab, ...]) -> None:
    """Draw a list of the tabs, for a panel of a few letters' width."""
    imgui.set_next_item_width(-1.0)
    changed, number = imgui.combo("##tabs", tabs.index(app.preferences.tab), list(tabs))
    if changed:
        app.prefer(replaced(app.preferences, tab=tabs[number]))
    imgui.separator()


def _underline() -> None:
    """Draw a line below the button drawn last: colours alone are not seen by all."""
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    color = imgui.get_color_u32(imgui.Col_.text)
    painter = imgui.get_window_draw_list()
    painter.add_line(ImVec2(low.x, high.y), high, color, _LINE)


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
