"""Where `load` looks for a scene: a path, a name, a picture."""

from pathlib import Path

import numpy as np
import pytest

from glrt.core.errors import SceneError, UsageError
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.image.sources import load, load_recipe
from glrt.scene.scenefile import catalog
from glrt.scene.scenefile.catalog import scene_names
from glrt.scene.scenefile.toml import parse_scene
from glrt.settings import Settings

TOML = """
title = "{title}"
[camera]
position = [0.0, 0.0, 1.0]
look_at = [0.0, 0.0, 0.0]
[background]
color = [1.0, 1.0, 1.0]
"""


@pytest.fixture(autouse=True)
def scenes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A library of two scenes; the current folder is another, empty one."""
    folder = tmp_path / "scenes"
    folder.mkdir()
    for name in ("furnace", "cornell"):
        (folder / f"{name}.toml").write_text(TOML.format(title=f"the library's {name}"))
    (folder / "notes.txt").write_text("not a scene")
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setattr(catalog, "folder", lambda _: folder)
    return folder


@pytest.mark.parametrize("name", ["cornell", Path("cornell")])
def test_a_name_finds_a_scene_of_the_library(name: str | Path) -> None:
    assert load(name).title == "the library's cornell"


@pytest.mark.parametrize("name", ["cornell", "cornell.toml"])
def test_a_path_comes_before_a_name(name: str) -> None:
    Path(name).write_text(TOML.format(title="mine"))
    assert load(name).title == "mine"


@pytest.mark.parametrize("path", ["cornell.toml", "cornell.TOML", "more/glass.toml", "nosuch.toml"])
def test_a_path_is_never_a_name(path: str, scenes: Path) -> None:
    """This holds even for a file that was there a moment ago."""
    (scenes / "more").mkdir()
    (scenes / "more" / "glass.toml").write_text(TOML.format(title="deeper"))
    with pytest.raises(SceneError, match=f"^{path}: no such file; "):
        load(path)


def test_a_missing_path_is_answered_with_the_name_that_was_meant() -> None:
    with pytest.raises(SceneError, match=r"the scene that comes with glrt is called 'cornell'\.$"):
        load("cornell.toml")


def test_a_folder_in_place_of_a_scene_is_named() -> None:
    Path("room").mkdir()
    with pytest.raises(SceneError, match=r"^room: is a folder"):
        load("room")


def test_a_folder_with_the_name_of_a_scene_does_not_hide_it() -> None:
    Path("cornell").mkdir()
    assert load("cornell").title == "the library's cornell"


def test_a_name_leads_into_folders_of_the_library_but_not_out_of_it(scenes: Path) -> None:
    (scenes / "more").mkdir()
    (scenes / "more" / "glass.toml").write_text(TOML.format(title="deeper"))
    assert load("more/glass").title == "deeper"
    with pytest.raises(SceneError):
        load("more/../cornell")
    with pytest.raises(SceneError):
        load("more/cornell")


def test_a_path_leads_anywhere(scenes: Path) -> None:
    assert load(scenes / "furnace.toml").title == "the library's furnace"
    assert load("../scenes/furnace.toml").title == "the library's furnace"


def test_scene_names_are_the_toml_files_in_order() -> None:
    assert scene_names() == ["cornell", "furnace"]


def test_a_scene_file_brings_no_settings() -> None:
    scene, settings = load_recipe("cornell")
    assert scene.title == "the library's cornell"
    assert settings is None


@pytest.mark.parametrize("name", ["x.exr", "x.png", "x.PNG"])
@pytest.mark.parametrize(("taken", "samples"), [(48, 48), (0, 256)])
def test_a_picture_brings_its_scene_and_settings_with_the_samples_taken(
    name: str, taken: int, samples: int
) -> None:
    table = {
        "camera": {"position": [0.0, 0.0, 1.0], "look_at": [0.0, 0.0, 0.0]},
        "background": {"color": [1.0, 1.0, 1.0]},
    }
    scene = parse_scene(table, "test")
    asked = Settings(width=2, height=2, samples=256, seed=5)
    recipe = Recipe(scene=scene, settings=asked, samples=taken, version="0", renderer="none")
    pixels = np.zeros((2, 2, 3), np.float32)
    Image(pixels, pixels, taken, recipe).save(name)
    assert load(name) == scene
    assert load_recipe(name) == (scene, asked.model_copy(update={"samples": samples}))


def test_an_unknown_name_is_answered_with_the_nearest_and_the_list() -> None:
    with pytest.raises(SceneError) as caught:
        load("cornel")
    text = str(caught.value)
    assert "'cornel'; did you mean 'cornell'?" in text
    assert "cornell, furnace." in text


def test_a_name_like_no_other_gets_the_list_alone() -> None:
    with pytest.raises(SceneError, match=r"^Unknown scene 'zzz'\. .*cornell, furnace\."):
        load("zzz")


def test_an_empty_library_is_no_reason_to_crash(scenes: Path) -> None:
    for path in scenes.iterdir():
        path.unlink()
    with pytest.raises(SceneError, match="Unknown scene 'cornell'"):
        load("cornell")


@pytest.mark.parametrize("source", ["missing/cornell", "missing/cornell.toml", "/"])
def test_a_path_that_leads_nowhere_is_named(source: str) -> None:
    with pytest.raises(SceneError) as caught:
        load(source)
    assert str(caught.value).startswith(source)


@pytest.mark.parametrize("source", ["missing.exr", "cornell.png"])
def test_a_missing_picture_is_named(source: str) -> None:
    with pytest.raises(UsageError, match=f"{source}: cannot read"):
        load(source)


@pytest.mark.parametrize("source", [TOML, "x" * 5000, "x" * 5000 + ".toml", "", "a\0b", "\0.toml"])
def test_what_is_neither_path_nor_name_gets_one_paragraph(source: str) -> None:
    with pytest.raises(SceneError) as caught:
        load(source)
    assert "\n" not in str(caught.value)
