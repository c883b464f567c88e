"""Images that are dropped or opened and become the background; no window, no OpenGL."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from glrt.image.sources import load
from glrt.scene.scene import Scene
from glrt.settings import Settings
from glrt.view.edits import sky_images
from glrt.view.files import Files
from glrt.view.messages import Messages
from tests.support.image_bytes import flat_hdr
from tests.support.sky_images import random_sky, write_exr

DUSK = flat_hdr(np.full((2, 4, 4), 128, np.uint8))


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Files:
    monkeypatch.chdir(tmp_path)

    def edit(scene: Scene, **_: Any) -> None:
        session.scene = scene

    session: Any = SimpleNamespace(
        scene=load("cornell"), problem="", settings=Settings(), edit=edit
    )
    session.opened = SimpleNamespace(scene=session.scene)
    recent = tmp_path / "recent.json"
    return Files(session, Messages(session), "cornell", recent, lambda _: None, lambda _: None)


@pytest.mark.parametrize("name", ["dusk.hdr", "DUSK.HDR"])
def test_an_image_that_is_dropped_becomes_the_background(files: Files, name: str) -> None:
    file = Path.cwd() / "skies" / name
    file.parent.mkdir()
    file.write_bytes(DUSK)
    before = files.session.scene
    files.drop(str(file))
    scene = files.session.scene
    image = scene.background.image
    assert image
    assert (image.file, image.origin) == (name, file.resolve())
    assert image.pixels is not None
    assert image.pixels.shape == (2, 4, 3)
    assert scene.objects == before.objects
    assert files.messages.question is None, "undo brings edits back: nothing is lost"
    assert f"{name} is the background" in files.messages.last


def test_a_save_copies_the_image_next_to_the_scene(files: Files) -> None:
    file = Path("skies") / "dusk.hdr"
    file.parent.mkdir()
    file.write_bytes(DUSK)
    files.drop(str(file))
    assert files.save_scene("mine.toml")
    assert Path("dusk.hdr").read_bytes() == DUSK
    assert load("mine.toml").background.image == files.session.scene.background.image


def test_an_exr_is_a_background_unless_it_is_a_picture_with_a_recipe(
    files: Files, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_exr(Path("sky.exr"), random_sky(4, 2))
    opened: list[str] = []
    monkeypatch.setattr(files, "open", opened.append)
    files.ask_open("sky.exr")
    image = files.session.scene.background.image
    assert image
    assert image.file == "sky.exr"
    files._mark_saved(files.session.scene)
    monkeypatch.setattr(sky_images, "read_recipe", lambda _: None)
    files.ask_open("sky.exr")
    files.ask_open("scene.toml")
    assert opened == ["sky.exr", "scene.toml"]


@pytest.mark.parametrize("content", [b"", b"#?RADIANCE", b"no image"])
def test_what_is_no_image_is_reported_and_changes_nothing(files: Files, content: bytes) -> None:
    before = files.session.scene
    Path("dusk.hdr").write_bytes(content)
    files.drop("dusk.hdr")
    assert files.session.scene is before
    assert "dusk.hdr" in files.session.problem
