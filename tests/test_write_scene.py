"""Scenes written as TOML are read back as they were; files that change are noticed."""

from pathlib import Path

import pytest

from glrt.errors import RenderError
from glrt.library import load, scene_names
from glrt.scene import with_lights
from glrt.scene_file import read_scene
from glrt.settings import settings_for
from glrt.ui.watch import INTERVAL, Watch, watch_for
from glrt.ui.write_scene import scene_with, write_scene
from tests.builders import lamp, scene_of, sphere


@pytest.mark.parametrize("name", scene_names())
def test_what_is_written_is_read_back(name: str, tmp_path: Path) -> None:
    scene = load(name)
    write_scene(scene, tmp_path / "scene.toml")
    assert read_scene(tmp_path / "scene.toml") == scene


def test_odd_names_and_numbers_survive(tmp_path: Path) -> None:
    name = 'a "b" \\ ü \U0001f4a1.c = d'
    scene = scene_of([sphere([1e-7, -1e15, 0.1], 1e-15, name)], {name: lamp(1e15)}, title=name)
    write_scene(scene, tmp_path / "scene.toml")
    assert read_scene(tmp_path / "scene.toml") == scene


def test_intensities_stand_in_the_table_of_lights(tmp_path: Path) -> None:
    scene = with_lights(load("lamps"), {"blue": 0.25})
    settings = settings_for(scene.render, bounces=3, exposure=1.0)
    write_scene(scene_with(scene, settings), tmp_path / "scene.toml")
    text = (tmp_path / "scene.toml").read_text()
    assert "[lights]" in text
    assert "blue = 0.25" in text
    assert read_scene(tmp_path / "scene.toml").render.bounces == 3


def test_a_place_that_cannot_be_written_is_told() -> None:
    with pytest.raises(RenderError, match="/nowhere"):
        write_scene(load("cornell"), Path("/nowhere/scene.toml"))


def test_a_changed_file_is_noticed_once(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text("a")
    watch = watch_for(str(file))
    assert watch
    assert not watch.has_changed(10.0)
    file.write_text("bc")
    assert not watch.has_changed(10.0 + INTERVAL / 2)
    assert watch.has_changed(10.0 + INTERVAL)
    assert not watch.has_changed(10.0 + 2 * INTERVAL)
    file.unlink()
    assert watch.has_changed(20.0)


def test_scenes_by_name_and_pictures_are_not_watched(tmp_path: Path) -> None:
    picture = tmp_path / "a.png"
    picture.write_text("")
    assert watch_for("cornell") is None
    assert watch_for(str(picture)) is None
    assert not Watch([]).has_changed(1e9)
