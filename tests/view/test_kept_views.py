"""Views that the user keeps come back at the next start, for their scene alone."""

import json
from pathlib import Path

import pytest

from glrt.scene.camera import Camera
from glrt.view.kept_views import MOST_SCENES, KeptViews

HERE = Camera(position=(0, 1, 5), look_at=(0, 0, 0), fov=30, shutter=0.25)
THERE = Camera(position=(3, 1, 5), look_at=(0, 0.5, 0), focus_distance=2.5, defocus_angle=1)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "glrt" / "views.json"


def test_views_come_back_for_their_scene_alone(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own = file.parents[1] / "own.toml"
    own.touch()
    monkeypatch.chdir(own.parent)
    views = KeptViews(file)
    assert [views.keep("own.toml", 2, HERE), views.keep("cornell", 1, HERE)] == ["", ""]
    assert views.keep("cornell", 1, THERE) == ""
    again = KeptViews(file)
    assert again.of(str(own)) == again.of("own.toml") == {2: HERE}
    assert again.of("cornell") == {1: THERE}
    assert again.of("lamps") == {}


def test_views_of_a_scene_without_a_source_are_not_written(file: Path) -> None:
    views = KeptViews(file)
    views.keep("", 1, HERE)
    assert views.of("") == {1: HERE}
    assert KeptViews(file).of("") == {}


@pytest.mark.parametrize(
    "text", ["", "[]", "{", '{"a": 1}', '{"a": {"1": {"position": 3}}}', '{"a": {"x": null}}']
)
def test_a_file_that_is_wrong_holds_no_views(file: Path, text: str) -> None:
    file.parent.mkdir()
    file.write_text(text)
    views = KeptViews(file)
    assert views.of("a") == {}
    assert views.keep("a", 1, HERE) == ""
    assert KeptViews(file).of("a") == {1: HERE}


def test_a_wrong_view_takes_no_other_with_it(file: Path) -> None:
    KeptViews(file).keep("a", 1, HERE)
    table = json.loads(file.read_text())
    table["a"] |= {"2": {"fov": -1}, "10": table["a"]["1"], "zero": table["a"]["1"]}
    file.write_text(json.dumps(table))
    assert KeptViews(file).of("a") == {1: HERE}


def test_views_of_many_scenes_replace_those_of_the_first(file: Path) -> None:
    views = KeptViews(file)
    for number in range(MOST_SCENES + 2):
        views.keep(f"scene {number}", 1, HERE)
    assert len(json.loads(file.read_text())) == MOST_SCENES
    assert KeptViews(file).of("scene 1") == {}
    assert KeptViews(file).of("scene 2") == {1: HERE}


def test_a_file_that_cannot_be_written_is_reported(file: Path) -> None:
    file.parent.write_text("no folder")
    views = KeptViews(file)
    assert "cannot be written" in views.keep("a", 1, HERE)
    assert views.of("a") == {1: HERE}
