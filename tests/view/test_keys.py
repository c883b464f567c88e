"""Keys by name: what may mean what, and how a clash is reported."""

import pytest

from glrt.view.panels.key_table import key_named
from glrt.view.state import keys
from glrt.view.state.keys import Action


def test_the_usual_keys_do_not_clash() -> None:
    assert keys.problem(keys.DEFAULTS) == ""
    assert keys.DEFAULTS.keys() == keys.MEANING.keys()


@pytest.mark.parametrize(
    ("action", "chords", "told"),
    [
        ("home", ("w",), "W already means: walk forward"),
        ("home", ("h", "h"), "H already means"),
        ("save", ("ctrl+z",), "Ctrl+Z already means: undo"),
        ("home", ("nose",), "no key 'nose'"),
        ("home", ("",), "no key"),
        ("home", ("shift+ctrl+h",), "no key"),
        ("home", ("hyper+h",), "no key"),
        ("forward", ("ctrl+h",), "cannot mean: walk forward"),
    ],
)
def test_keys_that_cannot_be_are_refused(
    action: Action, chords: tuple[str, ...], told: str
) -> None:
    assert told in keys.problem({**keys.DEFAULTS, action: chords})


def test_chords_are_named_and_labelled() -> None:
    assert keys.chord("z", {"alt": False, "shift": True, "ctrl": True}) == "ctrl+shift+z"
    labels = {"ctrl+shift+z": "Ctrl+Shift+Z", "up_arrow": "Up arrow", "keypad_add": "Keypad add"}
    labels |= {"keypad7": "Keypad 7", "7": "7", "f12": "F12"}
    assert {text: keys.label(text) for text in labels} == labels


def test_each_name_is_a_key_of_the_window() -> None:
    assert len({key_named(name) for name in keys.NAMES}) == len(keys.NAMES)
