"""Scenes to render: scenes of glrt, one on standard input, and what `inspect` says."""

import io
import json
import sys
from pathlib import Path

import pytest

from glrt.cli import chart
from glrt.cli.main import main
from glrt.core.errors import SceneError
from glrt.core.resources import folder
from glrt.image import sources
from glrt.image.image import read_recipe
from glrt.image.sources import STRICT, load, scene_file_of
from glrt.scene.scenefile import catalog, toml
from glrt.scene.scenefile.catalog import all_scene_names
from glrt.scene.summary import MOST_NAMED, summary
from tests.support.builders import MATTE, glass, lamp, plane, scene_of, sphere

SMALL = ("--width", "8", "--height", "8", "--samples", "1")
SKY = (folder("scenes") / "sky.toml").read_bytes()


# --- names -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("word", "meant"), [("glass", "methods/glass"), ("opne", "methods/open"), ("lamp", "lamps")]
)
def test_a_scene_in_a_folder_is_suggested_by_its_last_part(word: str, meant: str) -> None:
    with pytest.raises(SceneError, match=f"^Unknown scene '{word}'; did you mean '{meant}'"):
        load(word)


def test_the_list_names_every_scene_with_size_and_objects_in_columns(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["scenes"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == all_scene_names()
    assert "methods/glass" in all_scene_names()
    (sky,) = [line for line in lines if line.startswith("sky ")]
    assert sky.split()[1:6] == ["600", "x", "400", "7", "objects"]
    assert sky.endswith(str(load("sky").title))
    assert len({line.index(" object") for line in lines}) == 1


def test_the_list_as_json_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scenes", "--json"]) == 0
    told = capsys.readouterr().out
    assert told.count("\n") == 1
    found = {scene.pop("name"): scene for scene in json.loads(told)}
    assert list(found) == all_scene_names()
    title = load("weekend").title
    assert found["weekend"] == {"title": title, "width": 600, "height": 400, "objects": 488}


def test_a_file_in_the_folder_at_hand_does_not_take_the_place_of_a_scene_in_the_list(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("sky").write_text("not a scene")
    assert main(["scenes"]) == 0
    monkeypatch.setattr(catalog, "folder", lambda _: tmp_path)
    capsys.readouterr()
    assert main(["scenes"]) == 0, "a library without scenes"
    assert not capsys.readouterr().out.strip()


# --- what inspect says of a scene -------------------------------------------------------------


def test_a_summary_counts_objects_and_names_materials_and_lights() -> None:
    materials = {"m": MATTE, "g": glass(), "l": lamp(1, group="warm"), "n": MATTE}
    things = [plane([0, -1, 0], [0, 1, 0], "m"), *[sphere([0, 0, z], 1, "l") for z in (3, 6)]]
    scene = scene_of(things, materials, lights={"warm": 0.25})
    assert summary(scene) == [
        "objects    2 spheres, 1 plane",
        "materials  lambertian m, n; dielectric g; light l",
        "lights     warm=0.25",
    ]
    sky = scene_of([], {}, background={"color": [1, 1, 1]})
    assert summary(sky) == ["objects    none", "materials  none", "lights     background=1"]


def test_many_names_are_shortened() -> None:
    materials = {f"m{number}": MATTE for number in range(MOST_NAMED + 3)}
    (_, told, _) = summary(scene_of([sphere([0, 0, 3], 1, "m0")], materials))
    assert told.endswith("m6, m7 and 3 more")


def test_inspect_shows_it_and_counts_one_object_as_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene_of([sphere([0, 0, -3], 1, "l")], {"l": lamp(1)}).save(tmp_path / "ball.toml")
    assert main(["inspect", str(tmp_path / "ball.toml"), "--bounces", "1"]) == 0
    told = capsys.readouterr().out
    assert "1 bounce, 1 object\n\nobjects    1 sphere\nmaterials  light l\nlights     l=1\n" in told


# --- standard input ---------------------------------------------------------------------------


def given(content: bytes, monkeypatch: pytest.MonkeyPatch, is_terminal: bool = False) -> None:
    stream = io.TextIOWrapper(io.BytesIO(content))
    monkeypatch.setattr(stream.buffer, "isatty", lambda: is_terminal)
    monkeypatch.setattr(sys, "stdin", stream)


def test_a_scene_on_standard_input_is_rendered_and_kept_in_the_recipe(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    given(SKY, monkeypatch)
    picture = tmp_path / "a.png"
    assert main(["render", "-", "-o", str(picture), *SMALL, "--json"]) == 0
    told = capsys.readouterr()
    assert json.loads(told.out)["scene"] == "-"
    assert not told.err
    assert read_recipe(picture).scene == load("sky")


def test_inspect_and_chart_read_it_too(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    given(SKY, monkeypatch)
    assert main(["inspect", "-"]) == 0
    assert capsys.readouterr().out.startswith(f"standard input: {load('sky').title}\n")
    given(SKY, monkeypatch)
    assert chart._scenes(["-"], STRICT) == {"standard-input": load("sky")}
    assert scene_file_of("-") is None, "no file for the window to save in, or to watch"


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "standard input: it is empty"),
        (b"x =", "standard input: not valid TOML: "),
        (b"\xff", "standard input: not a text file in UTF-8"),
        (b"title = 'x'", "standard input: camera is missing"),
        (b"#" * 1025, "standard input: not a scene: it is longer than"),
    ],
)
def test_what_is_wrong_with_it_is_reported_in_one_paragraph(
    content: bytes, said: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for module in (sources, toml):
        monkeypatch.setattr(module, "LARGEST", 1024)
    given(content, monkeypatch)
    assert main(["inspect", "-"]) == 2
    told = capsys.readouterr()
    assert told.err.startswith(f"glrt: {said}")
    assert (told.err.count("\n"), told.out) == (1, "")


def test_no_standard_input_is_reported(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "stdin", None)
    assert main(["inspect", "-"]) == 2
    assert "standard input: it is closed" in capsys.readouterr().err


def test_a_terminal_is_read_with_a_caution(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    given(SKY, monkeypatch, is_terminal=True)
    assert main(["inspect", "-"]) == 0
    told = capsys.readouterr().err
    assert told.startswith("glrt: caution: reading the scene from standard input, which is a term")
    assert told.count("\n") == 1
