"""A thread writes pictures: the window goes on, and the file is whole or not there."""

from pathlib import Path
from threading import Event
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import UsageError
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.settings import Settings
from glrt.view.files import Files
from glrt.view.messages import Messages


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Files:
    """The files of a session with a small picture."""
    monkeypatch.chdir(tmp_path)
    image = Image(np.full((2, 3, 3), 0.25, np.float32), np.zeros((2, 3, 3), np.float32), 16)
    session: Any = SimpleNamespace(
        scene=load("cornell"), problem="", settings=Settings(), samples=16, image=lambda: image
    )
    recent = tmp_path / "recent.json"
    return Files(session, Messages(session), "cornell", recent, lambda _: None, lambda _: None)


def test_a_picture_is_written_while_the_window_goes_on(
    files: Files, monkeypatch: pytest.MonkeyPatch
) -> None:
    may, save = Event(), Image.save
    monkeypatch.setattr(Image, "save", lambda *given: may.wait(60) and save(*given))
    files.save_picture()
    files.follow_picture()
    assert files.writer
    assert files.messages.last == ""
    assert not Path("picture.png").exists()
    may.set()
    files.finish_picture()
    assert files.messages.last.startswith("Saved picture.png in ")
    assert Path("picture.png").exists()
    assert files.picture_path == "picture-2.png"


def test_pictures_that_are_saved_in_a_row_get_names_of_their_own(files: Files) -> None:
    for _ in range(3):
        files.save_picture()
    files.finish_picture()
    assert sorted(path.name for path in Path().glob("*.png")) == [
        "picture-2.png",
        "picture-3.png",
        "picture.png",
    ]
    files.save_picture("other.exr")
    files.finish_picture()
    assert Image.load("other.exr").radiance.shape == (2, 3, 3)
    assert files.picture_path == "other-2.exr"


def test_a_picture_that_cannot_be_written_is_reported_when_that_is_known(
    files: Files, monkeypatch: pytest.MonkeyPatch
) -> None:
    files.save_picture("nowhere/picture.png")
    files.finish_picture()
    assert "nowhere" in files.session.problem
    assert files.picture_path == "picture.png"

    def refuse(*_: object) -> None:
        raise UsageError("There is no room.")

    monkeypatch.setattr(Image, "save", refuse)
    files.save_picture()
    files.finish_picture()
    assert files.session.problem == "There is no room."
