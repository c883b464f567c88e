"""Scenes written as TOML are read back as they were; files that change are noticed."""

import sys
from pathlib import Path

import pytest

from glrt.core.errors import RenderError, UsageError
from glrt.core.resources import folder
from glrt.image.sources import load
from glrt.scene.scene import Scene, with_lights
from glrt.scene.scenefile import toml_writer
from glrt.scene.scenefile.catalog import scene_names
from glrt.scene.scenefile.toml import read_scene
from glrt.scene.scenefile.toml_writer import scene_with, write_scene
from glrt.settings import settings_for
from glrt.view.controls import replaced
from glrt.view.file_watch import INTERVAL, Watch, watch_for
from tests.support.builders import lamp, scene_of, sphere
from tests.support.scene_texts import changed_lines, saved


@pytest.mark.parametrize("name", scene_names())
def test_what_is_written_is_read_back(name: str, tmp_path: Path) -> None:
    scene = load(name)
    write_scene(scene, tmp_path / "scene.toml")
    assert load(tmp_path / "scene.toml") == scene


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


def test_a_place_that_cannot_be_written_is_reported() -> None:
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


# --- comments ---------------------------------------------------------------------------

COMMENTED = """\
# A room for two.
title = 'Single quotes'   # stay

[camera] # where we stand
look_at  = [0, 0, 0]
position = [ 0.0,  1.5,   # eye height
             8 ]

[lights]
lamp = 1.0 # bright

[materials.white]
type="lambertian"
color=[0.5,0.5,0.5]   # grey, in truth

# the only lamp
[materials.lamp]
type = "light"
emission = [4, 4, 4]

[[objects]] # the ball
shape = "sphere"
center = [0, 0, 0]
radius = 1        # unit
material = "white"

# ----------------
[[objects]]
shape = "sphere"
center = [0, 3, 0]
radius = 0.5
material = "lamp"
# the end
"""


@pytest.mark.parametrize("name", scene_names())
def test_a_scene_that_was_not_changed_is_written_as_it_was(name: str, tmp_path: Path) -> None:
    text = (folder("scenes") / f"{name}.toml").read_text()
    assert saved(text, tmp_path, lambda scene: scene)[1] == text


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_only_what_was_changed_is_written_again(tmp_path: Path, ending: str) -> None:
    def change(scene: Scene) -> Scene:
        ball = replaced(scene.objects[0], center=(0.0, 0.25, 0.0), radius=1.5)
        camera = replaced(scene.camera, position=(0.0, 1.5, 7.0), fov=30.0)
        lit = with_lights(scene, {"lamp": 0.25})
        return replaced(lit, objects=(ball, scene.objects[1]), camera=camera)

    text = COMMENTED.replace("\n", ending)
    assert changed_lines(COMMENTED, saved(text, tmp_path, change)[1]) == [
        "-              8 ]",
        "+              7.0 ]",
        "+ fov = 30.0",
        "- lamp = 1.0 # bright",
        "+ lamp = 0.25 # bright",
        "- center = [0, 0, 0]",
        "+ center = [0, 0.25, 0]",
        "- radius = 1        # unit",
        "+ radius = 1.5        # unit",
    ]


def test_new_tables_and_keys_that_go_leave_the_comments(tmp_path: Path) -> None:
    def change(scene: Scene) -> Scene:
        camera = replaced(scene.camera, focus_distance=None)
        sky = replaced(scene.background, bottom=(0.5, 0.5, 0.5), top=(0.1, 0.2, 0.3), color=None)
        lit = with_lights(replaced(scene, camera=camera, background=sky), {"background": 2.0})
        return scene_with(lit, settings_for(lit.render, bounces=4))

    text = COMMENTED.replace("[lights]\nlamp = 1.0 # bright\n", "[background]\ncolor = [1, 1, 1]\n")
    text = text.replace("look_at  =", "focus_distance = 3.0\nlook_at  =")
    _, new = saved(text, tmp_path, change)
    gone = [line[2:] for line in changed_lines(text, new) if line[0] == "-"]
    assert gone == ["focus_distance = 3.0", "color = [1, 1, 1]"]
    assert "[lights]\nbackground = 2.0\n" in new
    assert "[render]\nbounces = 4\n" in new


@pytest.mark.parametrize(
    "text",
    [
        "camera = {position = [0, 0, 4], look_at = [0, 0, 0]} # inline\n"
        'materials.a = {type = "light", emission = [1, 1, 1]}\n'
        'objects = [{shape = "sphere", center = [0, 0, 0], radius = 1, '
        'material = "a"}] # one\n',
        "camera.position = [0, 0, 4] # dotted\ncamera.look_at = [0, 0, 0]\n[[objects]]\n"
        'shape = "sphere"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = "a b"\n[materials."a b"]\n'
        'type = "light"\nemission = [1, 1, 1] # last\n',
    ],
)
def test_other_ways_to_write_a_scene_keep_their_comments(tmp_path: Path, text: str) -> None:
    def change(scene: Scene) -> Scene:
        ball = replaced(scene.objects[0], radius=0.25)
        camera = replaced(scene.camera, fov=20.0)
        lit = with_lights(scene, {next(iter(scene.light_groups)): 3.0})
        return replaced(lit, objects=(ball,), camera=camera)

    _, new = saved(text, tmp_path, change)
    for comment in (line.partition("# ")[2] for line in text.splitlines()):
        assert comment in new


def test_another_material_is_written_next_to_the_others(tmp_path: Path) -> None:
    def change(scene: Scene) -> Scene:
        green = replaced(scene.materials["white"], color=(0.1, 0.5, 0.2))
        return replaced(scene, materials={**scene.materials, "green": green})

    _, new = saved(COMMENTED, tmp_path, change)
    added = [line for line in changed_lines(COMMENTED, new) if line.strip("+- ")]
    color = "+ color = [0.1, 0.5, 0.2]"
    assert added == ["+ [materials.green]", '+ type = "lambertian"', color]


def test_another_number_of_objects_is_written(tmp_path: Path) -> None:
    def change(scene: Scene) -> Scene:
        return replaced(scene, objects=scene.objects[1:])

    _, new = saved(COMMENTED, tmp_path, change)
    assert "# eye height" in new


@pytest.mark.parametrize("model", ["", "nonsense", "\udcff", None])
def test_without_a_model_that_is_a_scene_it_is_written_plainly(
    tmp_path: Path, model: str | None
) -> None:
    file = tmp_path / "model.toml"
    if model is not None:
        file.write_bytes(model.encode("utf-8", "surrogateescape"))
    scene = load("lamps")
    assert not write_scene(scene, tmp_path / "scene.toml", file)
    assert read_scene(tmp_path / "scene.toml") == scene


def test_a_file_too_long_to_be_revised_is_written_plainly(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(toml_writer, "MOST_LETTERS", len(COMMENTED) - 1)
    file = tmp_path / "scene.toml"
    file.write_text(COMMENTED)
    scene = read_scene(file)
    assert not write_scene(scene, file, file)
    assert read_scene(file) == scene


def test_without_tomlkit_the_advice_is_to_install_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "tomlkit", None)
    file = tmp_path / "scene.toml"
    file.write_text(COMMENTED)
    with pytest.raises(UsageError, match=r"pip install .*\[view\]'"):
        write_scene(read_scene(file), file, file)
    assert file.read_text() == COMMENTED
