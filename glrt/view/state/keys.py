"""Names of keys, default keys of the actions, and checks of key bindings."""

from collections.abc import Mapping
from string import ascii_lowercase, digits
from typing import Literal, get_args

Move = Literal["forward", "back", "left", "right", "up", "down"]
Action = (
    Move
    | Literal["home", "frame", "handles", "pause", "undo", "redo"]
    | Literal["fit", "one_to_one", "inspect", "paths", "panel", "keys", "palette", "find_object"]
    | Literal["brighter", "darker", "picture_alone", "full_screen", "start"]
    | Literal["duplicate", "delete", "open", "save_scene", "save_scene_as", "save", "quit"]
    | Literal["export", "copy_picture", "timeline", "play", "set_key"]
)
MOST_VIEWS = 9  # that are kept, each by a digit: Ctrl keeps it, Alt goes back to it
Bindings = dict[Action, tuple[str, ...]]

DEFAULTS: Bindings = {
    "forward": ("w", "up_arrow"),
    "back": ("s", "down_arrow"),
    "left": ("a", "left_arrow"),
    "right": ("d", "right_arrow"),
    "up": ("e",),
    "down": ("q",),
    "home": ("home",),
    "frame": ("f",),
    "handles": ("r",),
    "pause": ("space",),
    "fit": ("0",),
    "one_to_one": ("1",),
    "inspect": ("i",),
    "paths": ("p",),
    "brighter": ("right_bracket",),
    "darker": ("left_bracket",),
    "picture_alone": ("n",),
    "full_screen": ("f11",),
    "start": ("f2",),
    "panel": ("f6",),
    "keys": ("f1",),
    "palette": ("ctrl+k",),
    "find_object": ("ctrl+f",),
    "undo": ("ctrl+z",),
    "redo": ("ctrl+y", "ctrl+shift+z"),
    "duplicate": ("ctrl+d",),
    "delete": ("delete",),
    "open": ("ctrl+o",),
    "save_scene": ("ctrl+s",),
    "save_scene_as": ("ctrl+shift+s",),
    "save": ("ctrl+e",),
    "export": ("ctrl+shift+e",),
    "copy_picture": ("ctrl+shift+c",),
    "timeline": ("t",),
    "play": ("shift+space",),
    "set_key": ("k",),
    "quit": ("ctrl+q",),
}
MEANING: dict[Action, str] = {
    "forward": "walk forward",
    "back": "walk back",
    "left": "walk left",
    "right": "walk right",
    "up": "rise",
    "down": "sink",
    "home": "go to the first view",
    "frame": "frame the selection",
    "handles": "let handles turn, or move again",
    "pause": "pause, continue",
    "fit": "show the whole picture",
    "one_to_one": "zoom to 1:1",
    "inspect": "show pixel values",
    "paths": "choose a pixel for its paths",
    "brighter": "expose half a stop more",
    "darker": "expose half a stop less",
    "picture_alone": "hide the panels, and show them",
    "full_screen": "show the window in full screen, and back",
    "start": "show scenes to open, and back",
    "panel": "move in the panel by keys, and back",
    "keys": "show these keys",
    "palette": "find a control or a command",
    "find_object": "find an object in the list",
    "undo": "undo",
    "redo": "redo",
    "duplicate": "duplicate the selection",
    "delete": "delete the selection",
    "open": "open a file",
    "save_scene": "save the scene",
    "save_scene_as": "save the scene as",
    "save": "save the picture",
    "export": "export a picture of any size, or a film",
    "copy_picture": "copy the picture to the clipboard",
    "timeline": "show the timeline of a scene without animation",
    "play": "play the animation, stop it",
    "set_key": "set a key of the value chosen in the timeline",
    "quit": "close the window",
}


def with_defaults(given: Mapping[Action, tuple[str, ...]]) -> Bindings:
    """Return the keys of all actions: as given, else the defaults that no given action uses."""
    chosen = {text for chords in given.values() for text in chords}
    free = {
        action: tuple(text for text in chords if text not in chosen)
        for action, chords in DEFAULTS.items()
    }
    return {**free, **given}


MODIFIERS = ("ctrl", "shift", "alt")
NAMES = (  # as in Dear ImGui; without Escape, which cancels
    *ascii_lowercase,
    *digits,
    *(f"f{number}" for number in range(1, 13)),
    *(f"{side}_arrow" for side in ("up", "down", "left", "right")),
    *("home", "end", "page_up", "page_down", "insert", "delete", "space", "tab", "enter"),
    *("backspace", "minus", "equal", "comma", "period", "slash", "semicolon", "apostrophe"),
    *("left_bracket", "right_bracket", "backslash", "grave_accent", "oem102"),
    *(f"keypad{number}" for number in range(10)),
    *(f"keypad_{name}" for name in ("add", "subtract", "multiply", "divide", "decimal", "enter")),
)


def chord(key: str, held: Mapping[str, bool]) -> str:
    """Return the name of a key with the modifiers that are held, such as "ctrl+shift+z"."""
    return "+".join([*(name for name in MODIFIERS if held[name]), key])


def label(text: str) -> str:
    """Return a chord as it is shown to users: "Ctrl+Shift+Z", "Up arrow"."""
    *modifiers, key = text.split("+")
    name = key.replace("_", " ").replace("keypad", "keypad ").replace("  ", " ")
    return "+".join(part[:1].upper() + part[1:] for part in (*modifiers, name))


def problem(bindings: Mapping[Action, tuple[str, ...]]) -> str:
    """Return what is wrong with key bindings: an unknown key, or one used twice; "" if nothing."""
    owners: dict[str, Action] = {}
    for action, chords in bindings.items():
        for text in chords:
            if advice := _problem_of(action, text):
                return advice
            other = owners.setdefault(text, action)
            if other != action or chords.count(text) > 1:
                return f"{label(text)} already means: {MEANING[other]}. Choose another key"
    return ""


def _problem_of(action: Action, text: str) -> str:
    *modifiers, key = text.split("+")
    if key not in NAMES or modifiers != [name for name in MODIFIERS if name in modifiers]:
        return f"there is no key {text!r}; keys are named as in 'w', 'up_arrow' or 'ctrl+shift+z'"
    if modifiers and action in get_args(Move):
        return f"{label(text)} cannot mean: {MEANING[action]}. Keys for moving take no Ctrl"
    return ""
