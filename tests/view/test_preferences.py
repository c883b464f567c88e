"""Preferences are kept whole, and a broken file is reported."""

from pathlib import Path

import pytest

from glrt.view.state import keys
from glrt.view.state.preferences import (
    Preferences,
    load_preferences,
    preferences_file,
    save_preferences,
)


def test_what_is_kept_comes_back(tmp_path: Path) -> None:
    file = tmp_path / "new" / "view.json"
    wanted = Preferences(mode="fly", turn_speed=90.0, bindings={"home": ("h",)})
    assert save_preferences(wanted, file) == ""
    assert load_preferences(file) == (wanted, "")
    assert list(file.parent.iterdir()) == [file]


def test_no_file_means_defaults(tmp_path: Path) -> None:
    assert load_preferences(tmp_path / "none.json") == (Preferences(), "")


BROKEN = ["{", '{"mode": "swim"}', "[]", '{"nose": 1}', "\ud800", "", "null", "[" * 100_000]
BINDINGS = [
    '{"home": ["w"], "forward": ["w"]}',
    '{"home": ["nose"]}',
    '{"dance": ["x"]}',
    '{"home": "h"}',
    "3",
]


@pytest.mark.parametrize("text", [*BROKEN, *(f'{{"bindings": {text}}}' for text in BINDINGS)])
def test_a_broken_file_is_reported_and_not_used(tmp_path: Path, text: str) -> None:
    file = tmp_path / "view.json"
    file.write_bytes(text.encode("utf-8", "surrogatepass"))
    preferences, problem = load_preferences(file)
    assert preferences == Preferences()
    assert str(file) in problem


def test_what_is_right_in_a_file_is_used(tmp_path: Path) -> None:
    file = tmp_path / "view.json"
    file.write_text('{"theme": "light", "scale": -1, "bindings": {"home": ["nose"]}}')
    preferences, problem = load_preferences(file)
    assert preferences == Preferences(theme="light")
    assert "scale" in problem
    assert "nose" in problem
    assert "\n" not in problem


def test_keys_that_a_file_does_not_name_are_the_usual_ones() -> None:
    bindings = Preferences(bindings={"home": ("h",), "frame": ()}).bindings
    assert bindings == {**keys.DEFAULTS, "home": ("h",), "frame": ()}


def test_a_usual_key_that_was_chosen_for_something_else_leaves_its_action() -> None:
    """Ctrl-S is such a key: old files of preferences use it to save pictures."""
    bindings = Preferences(bindings={"save": ("ctrl+s",), "home": ("w",)}).bindings
    assert (bindings["save"], bindings["save_scene"]) == (("ctrl+s",), ())
    assert (bindings["home"], bindings["forward"]) == (("w",), ("up_arrow",))


def test_a_folder_that_cannot_be_made_is_reported(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert "cannot be kept" in save_preferences(Preferences(), tmp_path / "file" / "view.json")


def test_the_place_is_the_users(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    assert preferences_file() == tmp_path / "glrt" / "view.json"
