"""Edits that are kept although a close does not ask for them, or no file holds the scene."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from glrt.image.sources import load
from glrt.scene.scene import Scene
from tests.support.kept_windows import Opened, let_all_die, next_to


@pytest.fixture
def opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Opened]:
    monkeypatch.chdir(tmp_path)
    yield Opened(tmp_path)
    let_all_die()


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
