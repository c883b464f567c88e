"""Keys: the section of the panel that shows and changes them, and all of them over the window."""

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.core.errors import GlrtError
from glrt.view.app import App
from glrt.view.controls import replaced
from glrt.view.state import keys
from glrt.view.state.keys import Action
from glrt.view.widgets.boxes import box
from glrt.view.widgets.fields import beside, button, tip

NAME = "Keys###keys over the window"
_SHARE = 0.92  # of the window: the largest size of that box
_APART = 2.0  # em: between its columns
_MOUSE = {  # in the picture, and on labels in the panel
    "left drag": "turn about the pivot; in fly mode: look around",
    "right drag": "look around; in fly mode: turn about the pivot",
    "middle drag": "shift",
    "wheel": "move nearer or farther",
    "Ctrl, wheel": "zoom into the picture",
    "Ctrl, drag": "move the picture that is zoomed",
    "click": "select an object; its handles move or turn it, with Shift they scale it",
    "Alt, click": "focus on that point",
    "double click": "make that point the pivot",
    "Ctrl, 1 to 9": "keep the view under that number",
    "Alt, 1 to 9": "go back to the view of that number",
    "drag a label": "change its value; a double click there sets it back",
    "Ctrl, click": "on a slider: type a value",
}


def draw_key_table(app: App) -> None:
    """Draw the functions of the mouse, and a row with the keys of each action.

    After a click on a key, the next key that is pressed replaces it.
    """
    for gesture, meaning in _MOUSE.items():
        imgui.text(gesture)
        imgui.same_line(hello_imgui.em_size(7))
        imgui.text_wrapped(meaning)
    imgui.separator_text("click a key to change it")
    if imgui.begin_table("keys", 2):
        imgui.table_setup_column("action", imgui.TableColumnFlags_.width_fixed.value)
        imgui.table_setup_column("keys", imgui.TableColumnFlags_.width_stretch.value)
        for action, chords in app.preferences.bindings.items():
            imgui.table_next_column()
            imgui.align_text_to_frame_padding()
            imgui.text(keys.MEANING[action])
            imgui.table_next_column()
            _row(app, action, chords)
        imgui.end_table()
    if button("reset keys", app.preferences.bindings != keys.DEFAULTS):
        app.prefer(replaced(app.preferences, bindings=keys.DEFAULTS))


def _row(app: App, action: Action, chords: tuple[str, ...]) -> None:
    """Draw the keys of an action, and a button to add one."""
    for index, chord in enumerate((*chords, "")):
        text = keys.label(chord) if chord else "+"
        if index:
            beside(text)
        if app.awaited == (action, index):
            _waiting(app, action, chords)
        elif button(f"{text}##{action} {index}"):
            app.awaited = (action, index)
        tip("Click, then press a key" if chord else "Add a key")


def _waiting(app: App, action: Action, chords: tuple[str, ...]) -> None:
    assert app.awaited
    index = app.awaited[1]
    if button("press a key##awaited"):
        app.awaited = None
    if index < len(chords):
        beside("remove")
        if button("remove##awaited"):
            _bind(app, action, (*chords[:index], *chords[index + 1 :]))


def is_choosing(app: App) -> bool:
    """Take the key that is being chosen; return whether keys have no other effect now.

    They have none until they are released: the new key of a move must not move the camera.
    """
    if app.awaited:
        _catch(app)
    elif app.is_deaf:
        app.is_deaf = any(imgui.is_key_down(key_named(name)) for name in keys.NAMES)
    return app.awaited is not None or app.is_deaf


def key_named(name: str) -> imgui.Key:
    """Return the key of Dear ImGui with this name."""
    return imgui.Key[f"_{name}" if name.isdigit() else name]


def _catch(app: App) -> None:
    assert app.awaited
    action, index = app.awaited
    if imgui.is_key_pressed(imgui.Key.escape):
        app.awaited, app.is_deaf = None, True
        return
    io = imgui.get_io()
    held = {"ctrl": io.key_ctrl, "shift": io.key_shift, "alt": io.key_alt}
    for name in keys.NAMES:
        if imgui.is_key_pressed(key_named(name), repeat=False):
            chords = app.preferences.bindings[action]
            _bind(app, action, (*chords[:index], keys.chord(name, held), *chords[index + 1 :]))
            return


def _bind(app: App, action: Action, chords: tuple[str, ...]) -> None:
    """Bind other keys to an action; a conflict is reported, and the old keys stay."""
    app.awaited, app.is_deaf = None, True
    try:
        bindings = {**app.preferences.bindings, action: chords}
        app.prefer(replaced(app.preferences, bindings=bindings))
    except GlrtError as error:
        app.messages.complain(str(error).removeprefix("bindings: "))


def draw_key_overlay(app: App) -> None:
    """Draw the table of keys, as the user has chosen them, if it is open."""
    if not app.shows_keys:
        return
    area = imgui.get_main_viewport()
    middle = area.pos + ImVec2(area.size.x / 2, area.size.y / 2)
    imgui.set_next_window_pos(middle, imgui.Cond_.always.value, ImVec2(0.5, 0.5))
    largest = ImVec2(_SHARE * area.size.x, _SHARE * area.size.y)
    imgui.set_next_window_size_constraints(ImVec2(0, 0), largest)
    with box(NAME, imgui.WindowFlags_.always_auto_resize.value) as drawn:
        if drawn.is_shown:
            _tables(app)
            is_clicked = imgui.is_mouse_clicked(0) and not imgui.is_window_appearing()
            app.shows_keys = not is_clicked or imgui.is_window_hovered()


def _tables(app: App) -> None:
    """Draw keys on the left, the mouse and commands on the right; all in one column if narrow."""
    bound = app.preferences.bindings.items()
    rows = [
        (" or ".join(map(keys.label, chords)), keys.MEANING[action])
        for action, chords in bound
        if chords
    ]
    single = [row for row in rows if "Ctrl+" not in row[0]]
    commands = [row for row in rows if "Ctrl+" in row[0]]
    mouse = [(gesture, told.partition(";")[0]) for gesture, told in _MOUSE.items()]
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
    imgui.text_disabled("mouse")
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
