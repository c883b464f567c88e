"""Reading scene files: every mistake becomes one paragraph that says what to do."""

import datetime
import math
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from glrt.core.errors import SceneError
from glrt.scene.scenefile.toml import parse_scene, read_scene
from tests.support.bad_lamps import BAD_LAMPS
from tests.support.bad_media import BAD_MEDIA
from tests.support.bad_scenes import BAD_SCENES, GOOD_SCENE, BadScene

JARGON = (
    "Input should",
    "union_tag",
    "http",
    "pydantic",
    "validation",
    "Traceback",
    "Extra inputs",
)


def assert_is_one_paragraph(message: str, source: str) -> None:
    assert message.startswith(f"{source}: ")
    assert message.endswith((".", "?"))
    assert message.isprintable()
    assert not [word for word in JARGON if word in message]
    assert len(message) < 1500


def test_a_mark_of_the_byte_order_and_windows_lines_are_read(tmp_path: Path) -> None:
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD_SCENE.replace("\n", "\r\n").encode())
    assert read_scene(path) == parse_scene(tomllib.loads(GOOD_SCENE), "test")


@pytest.mark.parametrize("bad", [*BAD_SCENES, *BAD_LAMPS, *BAD_MEDIA], ids=lambda bad: bad.name)
def test_bad_scene_is_refused_with_advice(bad: BadScene, tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_bytes(bad.content if isinstance(bad.content, bytes) else bad.content.encode())
    with pytest.raises(SceneError) as caught:
        read_scene(path)
    message = str(caught.value)
    assert_is_one_paragraph(message, str(path))
    advice = message.removeprefix(f"{path}: ")
    assert [words for words in bad.says if words not in advice] == []


def test_bad_scenes_are_many_and_have_names_of_their_own() -> None:
    names = [bad.name for bad in [*BAD_SCENES, *BAD_LAMPS, *BAD_MEDIA]]
    assert len(set(names)) == len(names) >= 45


def test_missing_file_is_named_with_its_neighbour(tmp_path: Path) -> None:
    (tmp_path / "cornell.toml").write_text(GOOD_SCENE)
    with pytest.raises(SceneError, match=r"cornel\.toml: no such file; did you mean 'cornell"):
        read_scene(tmp_path / "cornel.toml")
    with pytest.raises(SceneError, match=r"nowhere/box\.toml: no such file; check the path\.$"):
        read_scene(tmp_path / "nowhere" / "box.toml")


def test_keys_of_a_table_in_a_table_are_its_own() -> None:
    sky = {"background": {"sky": {"turbidty": 3}}, "sun": {"elevation": 30, "azimuth": 0}}
    with pytest.raises(
        SceneError, match=r"background\.sky: .* 'turbidity'\? Keys of \[background\.sky\]: "
    ):
        parse_scene({"camera": {"position": [0, 0, 1], "look_at": [0, 0, 0]}, **sky}, "a")


def test_a_name_of_two_lines_does_not_break_the_paragraph() -> None:
    with pytest.raises(SceneError, match=r"^a\\nb\.toml: camera is missing") as caught:
        parse_scene({}, "a\nb.toml")
    assert str(caught.value).isprintable()


def test_folder_is_no_scene(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"is a folder; name a scene file in it\.$"):
        read_scene(tmp_path)


def test_unreadable_file_says_why(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> bytes:
        raise PermissionError(13, "Permission denied")

    (tmp_path / "box.toml").touch()
    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(SceneError, match=r"box\.toml: cannot be read: Permission denied; check"):
        read_scene(tmp_path / "box.toml")


def _places(value: Any, place: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    steps = value.keys() if isinstance(value, dict) else range(len(value))
    for step in steps:
        yield (*place, step)
        if isinstance(value[step], dict | list):
            yield from _places(value[step], (*place, step))


ODD_VALUES: list[Any] = [
    None,
    True,
    7,
    -1,
    1e300,
    math.nan,
    10**400,
    10**5000,
    "",
    "a\nb\x00",
    "left ball" * 99,
    [],
    [[[[[[1]]]]]],
    {},
    {"a b": {"type": {}}},
    datetime.date(2020, 1, 1),
]


@pytest.mark.parametrize("odd", ODD_VALUES, ids=range(len(ODD_VALUES)))
def test_any_value_in_any_place_gives_a_scene_or_a_paragraph(odd: Any) -> None:
    refused = 0
    for place in _places(tomllib.loads(GOOD_SCENE)):
        data = tomllib.loads(GOOD_SCENE)
        table: Any = data
        for step in place[:-1]:
            table = table[step]
        table[place[-1]] = odd
        try:
            parse_scene(data, "test")
        except SceneError as error:
            assert_is_one_paragraph(str(error), "test")
            refused += 1
    assert refused > 20


def test_an_unknown_key_may_be_called_as_pydantic_calls_places() -> None:
    """A place that ends in [key] stands for a key of a table, unless there is such a key."""
    with pytest.raises(SceneError, match=r"unknown key '\[key\]'"):
        parse_scene({"[key]": {}, "camera": {"position": [0, 0, 1], "look_at": [0, 0, 0]}}, "test")
