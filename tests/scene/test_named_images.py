"""Scenes that name an image: read, checked, saved next to its file."""

from pathlib import Path

import numpy as np
import pytest

import glrt
from glrt.core.errors import SceneError, UsageError
from glrt.image.sources import load
from glrt.scene.loading.scene_files import files_of, hashes_of
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene, scene_to_dict
from glrt.scene.scenefile.toml_writer import write_scene
from tests.support.sky_images import random_sky, write_exr

SCENE = """
[camera]
position = [0, 0, 1]
look_at = [0, 0, 0]

[background]
image = "images/sky.exr"
rotation = 40
"""
CAMERA = {"position": [0, 0, 1], "look_at": [0, 0, 0]}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A scene and its image."""
    (tmp_path / "images").mkdir()
    write_exr(tmp_path / "images/sky.exr", random_sky(4, 2))
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path


def test_a_scene_is_read_with_its_image(folder: Path) -> None:
    scene = load(folder / "scene.toml")
    image = scene.background.image
    assert image is not None
    assert image.pixels is not None
    assert np.array_equal(image.pixels, random_sky(4, 2))
    assert scene.background.gradient == ((1, 1, 1), (1, 1, 1)), "a factor of the image"
    assert files_of(scene) == ["images/sky.exr"]
    assert list(hashes_of(scene)) == ["images/sky.exr"]


def test_scenes_are_equal_if_paths_and_contents_are(folder: Path) -> None:
    scene = load(folder / "scene.toml")
    assert scene == load(folder / "scene.toml")
    assert hash(scene.background.image) == hash(load(folder / "scene.toml").background.image)
    write_exr(folder / "images/sky.exr", random_sky(4, 2, seed=2))
    assert scene != load(folder / "scene.toml")


def test_a_scene_file_reports_the_path_alone(folder: Path) -> None:
    table = scene_to_dict(load(folder / "scene.toml"))["background"]
    assert table == {"image": "images/sky.exr", "rotation": 40.0}


@pytest.mark.parametrize(
    ("background", "words"),
    [
        (
            {"image": "a.hdr", "bottom": [1, 1, 1], "top": [1, 1, 1]},
            "image excludes bottom and top",
        ),
        ({"rotation": 3}, "rotation turns an image; give image"),
        ({"image": ""}, "background.image"),
        ({"image": 3}, "background.image"),
        ({"image": {"file": "a.hdr", "sha256": "0"}}, "background.image"),
        ({"image": "a" * 4097}, "background.image"),
    ],
)
def test_what_is_no_background_is_refused(background: object, words: str) -> None:
    with pytest.raises(SceneError, match=words.replace(".", r"\.")):
        parse_scene({"camera": CAMERA, "background": background}, "test")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "there is no file 'images/sky.exr'"),
        (b"text", "none of PNG, JPEG"),
    ],
)
def test_a_file_that_is_no_image_is_named_with_its_key(
    folder: Path, content: bytes | None, words: str
) -> None:
    file = folder / "images/sky.exr"
    file.unlink()
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(SceneError, match=words) as error:
        load(folder / "scene.toml")
    assert "background.image" in str(error.value)


def test_an_image_that_is_too_bright_is_refused(folder: Path) -> None:
    write_exr(folder / "images/sky.exr", np.full((2, 4, 3), 2e15))
    with pytest.raises(SceneError, match=r"brighter than 1e\+15"):
        load(folder / "scene.toml")


@pytest.mark.parametrize("mode", ["L", "LA", "RGB", "RGBA"])
def test_images_of_all_channels_are_colours(folder: Path, mode: str) -> None:
    from PIL import Image as Pillow

    Pillow.new("RGB", (4, 2), (188, 188, 188)).convert(mode).save(folder / "images/sky.png")
    (folder / "scene.toml").write_text(SCENE.replace("sky.exr", "sky.png"))
    image = load(folder / "scene.toml").background.image
    assert image is not None
    assert image.pixels is not None
    assert image.pixels.shape == (2, 4, 3)
    assert image.pixels == pytest.approx(0.5029, abs=1e-3), "decoded from sRGB"


def test_python_names_a_folder(folder: Path) -> None:
    sky = {"image": "images/sky.exr", "rotation": 40}
    built = glrt.Scene.build(CAMERA, background=sky, folder=folder)
    assert built == load(folder / "scene.toml")
    with pytest.raises(SceneError, match=r"^Scene.build: background.image: there is no file"):
        glrt.Scene.build(CAMERA, background=sky, folder=folder / "images")


def saved(folder: Path, to: Path) -> Scene:
    load(folder / "scene.toml").save(to)
    return load(to)


def test_saved_elsewhere_the_file_goes_along(folder: Path, tmp_path: Path) -> None:
    elsewhere = tmp_path / "other"
    elsewhere.mkdir()
    assert saved(folder, elsewhere / "scene.toml") == load(folder / "scene.toml")
    assert saved(folder, elsewhere / "again.toml") == load(folder / "scene.toml"), "it is there"
    assert saved(folder, folder / "beside.toml") == load(folder / "scene.toml")


def test_no_other_file_is_replaced(folder: Path, tmp_path: Path) -> None:
    elsewhere = tmp_path / "other"
    (elsewhere / "images").mkdir(parents=True)
    (elsewhere / "images/sky.exr").write_bytes(b"mine")
    with pytest.raises(UsageError, match="other content is there"):
        load(folder / "scene.toml").save(elsewhere / "scene.toml")
    assert (elsewhere / "images/sky.exr").read_bytes() == b"mine"
    assert not (elsewhere / "scene.toml").exists()


def test_what_was_read_is_what_is_saved(folder: Path, tmp_path: Path) -> None:
    scene = load(folder / "scene.toml")
    write_exr(folder / "images/sky.exr", random_sky(4, 2, seed=2))
    elsewhere = tmp_path / "other"
    elsewhere.mkdir()
    with pytest.raises(UsageError, match="has changed since it was read"):
        scene.save(elsewhere / "scene.toml")
    assert not (elsewhere / "scene.toml").exists()


def test_comments_stay_where_a_scene_with_an_image_is_saved(folder: Path, tmp_path: Path) -> None:
    file = folder / "scene.toml"
    file.write_text("# my sky\n" + SCENE)
    turned = load(file).model_copy(
        update={"background": load(file).background.model_copy(update={"rotation": 50.0})}
    )
    elsewhere = tmp_path / "other"
    elsewhere.mkdir()
    assert write_scene(turned, elsewhere / "scene.toml", file)
    assert (elsewhere / "scene.toml").read_text().startswith("# my sky\n")
    assert load(elsewhere / "scene.toml") == turned
