"""Edits that are kept although a close does not ask for them, or no file holds the scene."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from glrt.image.sources import load
from glrt.scene.loading.scene_files import check_loaded
from glrt.scene.scene import Scene
from glrt.view.edits.sky_images import with_sky_image
from glrt.view.edits.texture_images import with_texture_image
from tests.support.image_bytes import COLOR, flat_hdr, png
from tests.support.kept_windows import Opened, let_all_die, next_to


@pytest.fixture
def opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Opened]:
    monkeypatch.chdir(tmp_path)
    yield Opened(tmp_path)
    let_all_die()


def test_an_image_of_the_sky_comes_back(opened: Opened) -> None:
    elsewhere = Path("skies")
    elsewhere.mkdir()
    (elsewhere / "dusk.hdr").write_bytes(flat_hdr(np.full((2, 4, 4), 128, np.uint8)))
    opened.edit(partial(with_sky_image, path=elsewhere / "dusk.hdr"))
    image = opened.session.scene.background.image
    assert image
    opened.die()
    later = next_to(opened)
    later.recovery.restore()
    assert later.session.problem == ""
    found = later.session.scene.background.image
    assert found == image
    assert found.pixels is not None


def test_an_image_on_an_object_comes_back(opened: Opened) -> None:
    elsewhere = Path("images")
    elsewhere.mkdir()
    (elsewhere / "red.png").write_bytes(png(np.full((2, 2, 3), 255, np.uint8), COLOR))
    opened.edit(partial(with_texture_image, index=0, path=elsewhere / "red.png"))
    scene = opened.session.scene
    opened.die()
    later = next_to(opened)
    later.recovery.restore()
    assert later.session.problem == ""
    assert later.session.scene.materials == scene.materials
    check_loaded(later.session.scene)


def moved(scene: Scene) -> Scene:
    return scene.model_copy(update={"camera": load("lamps").camera})


@pytest.mark.parametrize("makes", ["camera", "settings"])
def test_camera_and_settings_alone_are_restored_too(opened: Opened, makes: str) -> None:
    if makes == "camera":
        opened.edit(moved)
    else:
        opened.session.edit(bounces=3)
        opened.look()
    assert not opened.files.is_changed, "a close does not ask"
    opened.die()
    later = next_to(opened)
    assert len(later.recovery.offers) == 1
    later.recovery.restore()
    assert later.session.scene.camera == opened.session.scene.camera
    assert later.session.settings == opened.session.settings
    opened.recovery.end(is_interrupted=False)


def test_edits_of_a_scene_from_standard_input_are_restored_in_the_same_scene(
    opened: Opened,
) -> None:
    piped = next_to(opened, "-", load("cornell"))
    piped.edit()
    assert "`glrt view -` with the same scene offers" in piped.recovery.last_words()
    piped.die()
    assert next_to(opened).recovery.offers == []
    assert next_to(opened, "-", load("lamps")).recovery.offers == []
    later = next_to(opened, "-", load("cornell"))
    later.recovery.restore()
    assert later.session.scene.objects == piped.session.scene.objects
    assert not later.session.problem
