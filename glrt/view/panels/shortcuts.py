"""Commands and camera moves by keys, also in frames slower than a key press."""

import time
from collections.abc import Callable

from imgui_bundle import imgui

from glrt.view.app import App
from glrt.view.edits.keyframes import with_key
from glrt.view.outliner.listing import OUTLINER
from glrt.view.panels.key_table import is_choosing, key_named
from glrt.view.panels.navigation import leaves, navigate
from glrt.view.state.keys import MOST_VIEWS, Action, Move

_AXES: dict[Move, tuple[int, int, int]] = {  # right, up, forward
    "forward": (0, 0, 1),
    "back": (0, 0, -1),
    "left": (-1, 0, 0),
    "right": (1, 0, 0),
    "up": (0, 1, 0),
    "down": (0, -1, 0),
}
COMMANDS: dict[Action, Callable[[App], object]] = {  # command of each action
    "home": lambda app: app.home(),
    "frame": lambda app: app.frame_selected(),
    "handles": lambda app: app.toggle_handles(),
    "pause": lambda app: app.pause(),
    "fit": lambda app: app.zoom_to(None),
    "one_to_one": lambda app: app.zoom_to(1.0),
    "inspect": lambda app: app.inspect(),
    "paths": lambda app: app.choose_paths(),
    "keys": lambda app: app.toggle_keys(),
    "palette": lambda app: app.toggle_palette(),
    "find_object": lambda app: OUTLINER.find(app),
    "brighter": lambda app: app.expose(_STOP),
    "darker": lambda app: app.expose(-_STOP),
    "picture_alone": lambda app: app.toggle_panels(),
    "full_screen": lambda app: app.fill_screen(),
    "start": lambda app: app.toggle_start(),
    "panel": lambda app: navigate(app, not app.navigates),
    "undo": lambda app: app.undo(),
    "redo": lambda app: app.redo(),
    "duplicate": lambda app: app.duplicate(),
    "delete": lambda app: app.delete(),
    "open": lambda app: app.files.browse_open(),
    "save_scene": lambda app: app.files.save_again(),
    "save_scene_as": lambda app: app.files.browse_scene(),
    "save": lambda app: app.files.save_picture(),
    "export": lambda app: app.exports.toggle(),
    "copy_picture": lambda app: app.exports.copy_picture(),
    "timeline": lambda app: app.timeline.toggle(),
    "play": lambda app: app.timeline.play(time.perf_counter()),
    "set_key": lambda app: _set_key(app),
    "quit": lambda app: app.exports.unless_under_way(lambda: app.files.close(app.leave)),
}
ANYWHERE: tuple[Action, ...] = (  # also on the start screen, which hides what others change
    *("keys", "palette", "full_screen", "start", "open", "quit"),
)
_STOP = 0.5  # exposure values of one press of a key
_LONGEST_STEP = 0.1  # seconds: a slow frame must not throw the camera out of the room
_ANY_POPUP = int(imgui.PopupFlags_.any_popup)
_MODIFIERS = {
    "ctrl": (imgui.Key.left_ctrl, imgui.Key.right_ctrl),
    "shift": (imgui.Key.left_shift, imgui.Key.right_shift),
    "alt": (imgui.Key.left_alt, imgui.Key.right_alt),
}


def draw_keys(app: App) -> None:
    """Act on the keys, except while a text is typed, a list is open, or a key is being chosen.

    Keys do not move the camera while they move in the panel.
    """
    io = imgui.get_io()
    is_open = imgui.is_popup_open("", _ANY_POPUP)
    if is_open and imgui.is_key_pressed(imgui.Key.escape):
        imgui.internal.close_popup_to_level(0, restore_focus_to_window_under_popup=True)
    is_free = not app.was_busy  # else Dear ImGui has used Escape
    is_left = leaves(app)
    if io.want_text_input or is_open or is_choosing(app):
        return
    if is_left:
        navigate(app, False)
    elif is_free and imgui.is_key_pressed(imgui.Key.escape, False):
        app.escape()
    seconds = min(io.delta_time, _LONGEST_STEP)
    moves = {} if app.navigates or app.shows_start else _AXES
    held = [axis for action, axis in moves.items() if _is_held(app, action)]
    if held:
        right, up, forward = (float(sum(parts)) for parts in zip(*held, strict=True))
        app.walk(right, up, forward, seconds)
    for action, act in COMMANDS.items():
        if _is_pressed(app, action) and (action in ANYWHERE or not app.shows_start):
            act(app)
            app.is_deaf = "ctrl" in modifiers()  # keys released after Ctrl move nothing
    _views(app)
    if not held and not imgui.is_any_item_active() and not _may_click_again():
        app.session.history.settle()


def _set_key(app: App) -> None:
    """Set a key for the value chosen in the timeline, at the frame that is shown."""
    line = app.timeline
    if line.chosen:
        keys, frame, selected = line.chosen, line.frame, app.selected
        app.edit_scene("", lambda scene: with_key(scene, keys, frame, selected))
    else:
        app.messages.report("Choose a value in the timeline below the picture: it gets the key")


def _views(app: App) -> None:
    """Keep views by Ctrl and a digit, and go back to them by Alt; keys of actions come first."""
    taken = {chord for chords in app.preferences.bindings.values() for chord in chords}
    for number in range(1, MOST_VIEWS + 1):
        for modifier, act in (("ctrl", app.keep_view), ("alt", app.recall_view)):
            chord = f"{modifier}+{number}"
            if chord not in taken and _comes(chord) and not app.shows_start:
                act(number)


def _may_click_again() -> bool:
    """Whether the mouse is down, or another click would be a double one, of the same gesture."""
    io = imgui.get_io()
    since = imgui.get_time() - io.mouse_clicked_time[0]
    return bool(imgui.is_mouse_down(0) or 0 <= since < io.mouse_double_click_time)


def modifiers() -> list[str]:
    """Return the modifiers held or released in this frame: a slow frame may hold a whole chord."""
    io = imgui.get_io()
    down = {"ctrl": io.key_ctrl, "shift": io.key_shift, "alt": io.key_alt}
    return [
        name
        for name, keys in _MODIFIERS.items()
        if down[name] or any(imgui.is_key_released(key) for key in keys)
    ]


def _is_held(app: App, action: Action) -> bool:
    """Whether a key of an action is down, without Ctrl; arrow keys may move in the list."""
    if "ctrl" in modifiers():
        return False
    names = app.preferences.bindings[action]
    if app.has_list_keys:
        names = tuple(name for name in names if not name.endswith("_arrow"))
    return any(imgui.is_key_down(key_named(name)) for name in names)


def _is_pressed(app: App, action: Action) -> bool:
    """Whether an action's key was pressed; in the panel, keys without Ctrl are for widgets."""
    chords = app.preferences.bindings[action]
    if app.navigates and action != "panel":
        chords = tuple(name for name in chords if name.startswith("ctrl+"))
    return any(_comes(name) for name in chords)


def _comes(text: str) -> bool:
    """Whether the key of a chord such as "ctrl+shift+z" was pressed now, with its modifiers."""
    *wanted, key = text.split("+")
    return modifiers() == wanted and imgui.is_key_pressed(key_named(key), repeat=False)
