"""All keys and functions of the mouse, over the window, until a key or a click closes them."""

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.view.app import App
from glrt.view.panels.key_table import MOUSE
from glrt.view.state.keys import MEANING, label

NAME = "Keys###keys over the window"
_SHARE = 0.92  # of the window: the largest size of the box
_APART = 2.0  # em: between the columns


def draw_key_overlay(app: App) -> None:
    """Draw the table of keys, as the user has chosen them, if it is open."""
    if not app.shows_keys:
        return
    area = imgui.get_main_viewport()
    middle = area.pos + ImVec2(area.size.x / 2, area.size.y / 2)
    imgui.set_next_window_pos(middle, imgui.Cond_.always.value, ImVec2(0.5, 0.5))
    largest = ImVec2(_SHARE * area.size.x, _SHARE * area.size.y)
    imgui.set_next_window_size_constraints(ImVec2(0, 0), largest)
    imgui.set_next_window_bg_alpha(1.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 1.0)
    flags = imgui.WindowFlags_.always_auto_resize | imgui.WindowFlags_.no_docking
    flags |= imgui.WindowFlags_.no_saved_settings | imgui.WindowFlags_.no_title_bar
    is_shown, _ = imgui.begin(NAME, None, int(flags))
    if is_shown:
        _tables(app)
        is_clicked = imgui.is_mouse_clicked(0) and not imgui.is_window_appearing()
        app.shows_keys = not is_clicked or imgui.is_window_hovered()
    imgui.end()
    imgui.pop_style_var()


def _tables(app: App) -> None:
    """Draw keys on the left, the mouse and commands on the right; all in one column if narrow."""
    bound = {MEANING[action]: chords for action, chords in app.preferences.bindings.items()}
    keys = [
        (" or ".join(map(label, chords)), meaning) for meaning, chords in bound.items() if chords
    ]
    single = [row for row in keys if "Ctrl+" not in row[0]]
    commands = [row for row in keys if "Ctrl+" in row[0]]
    mouse = [(gesture, told.partition(";")[0]) for gesture, told in MOUSE.items()]
    room = _SHARE * imgui.get_main_viewport().size.x
    right = max(_width(mouse), _width(commands))
    wide = _width(single) + right + hello_imgui.em_size(_APART)
    imgui.begin_group()
    imgui.text_disabled("keys; Escape closes this")
    _table("keys", single)
    imgui.end_group()
    if wide < room:
        imgui.same_line(0.0, hello_imgui.em_size(_APART))
    imgui.begin_group()
    imgui.text_disabled("in the picture")
    _table("mouse", mouse)
    imgui.text_disabled("commands")
    _table("commands", commands)
    imgui.end_group()


def _width(rows: list[tuple[str, str]]) -> float:
    """Return the width of a table, in pixels."""
    parts = (max((imgui.calc_text_size(row[k]).x for row in rows), default=0.0) for k in (0, 1))
    return sum(parts) + hello_imgui.em_size(1)


def _table(name: str, rows: list[tuple[str, str]]) -> None:
    flags = imgui.TableFlags_.sizing_fixed_fit | imgui.TableFlags_.no_host_extend_x
    if imgui.begin_table(name, 2, int(flags)):
        for key, meaning in rows:
            imgui.table_next_column()
            imgui.text_unformatted(key)
            imgui.table_next_column()
            imgui.text_unformatted(meaning)
        imgui.end_table()
