"""The scene file that is open in the window: deleted, replaced and moved by others."""

import os
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from PIL import Image

from glrt.core.resources import folder
from glrt.image.sources import STRICT, FileRules, load
from glrt.scene.loading.scene_files import files_of
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import read_scene
from glrt.settings import Settings
from glrt.view.file_watch import INTERVAL
from glrt.view.files import Files
from glrt.view.messages import Messages

SCENE = (folder("scenes") / "cornell.toml").read_text()
MINE = "the user's own"


class Opened:
    """A scene file of the user's in the window, under the name of a scene that comes with glrt."""

    def __init__(self, place: Path, name: str) -> None:
        self.file = Path(name)
        self.file.write_text(SCENE.replace("title = ", f'title = "{MINE}" #'))
        self.session = self._session(load(name))
        messages = Messages(self.session)
        recent = place / "recent.json"
        self.files = Files(self.session, messages, name, recent, lambda _: None, lambda _: None)
        self.times = count(step=2 * INTERVAL)
        self.look()

    def _session(self, scene: Scene) -> Any:
        """A stand-in for a session: it renders nothing."""
        opened = SimpleNamespace(scene=scene)
        return SimpleNamespace(
            scene=scene, problem="", settings=Settings(), edit=self._edit, opened=opened
        )

    def _edit(self, scene: Scene) -> None:
        self.session.scene = scene

    def look(self) -> str:
        """Let time pass; what the window complains of then."""
        self.files.follow(next(self.times) + 2 * INTERVAL)
        told: str = self.session.problem
        return told

    @property
    def title(self) -> str:
        told: str = self.session.scene.title
        return told


@pytest.fixture
def opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Opened:
    place = tmp_path / "place"
    place.mkdir()
    monkeypatch.chdir(place)
    return Opened(tmp_path, "cornell.toml")


def test_a_deleted_scene_stays_open_and_is_saved_where_it_was(opened: Opened) -> None:
    opened.file.unlink()
    assert "cornell.toml is no longer there" in opened.look()
    assert opened.title == MINE
    assert opened.files.is_changed
    assert "*" in opened.files.title
    opened.session.problem = ""
    assert opened.look() == "", "it is reported once"
    opened.files.save_again()
    assert read_scene(opened.file).title == MINE
    assert not opened.files.is_changed
    assert opened.look() == ""


def test_a_deleted_scene_that_was_saved_is_no_longer_complained_of(opened: Opened) -> None:
    opened.file.unlink()
    opened.look()
    opened.files.save_again()
    assert opened.session.problem == ""


def test_a_scene_that_comes_back_is_read_again(opened: Opened) -> None:
    text = opened.file.read_text()
    opened.file.unlink()
    opened.look()
    opened.file.write_text(text.replace(MINE, "back"))
    assert opened.look() == ""
    assert opened.title == "back"
    assert not opened.files.is_changed


def test_a_scene_that_another_file_is_renamed_over_is_read_again(opened: Opened) -> None:
    Path("new").write_text(opened.file.read_text().replace(MINE, "replaced"))
    os.replace("new", opened.file)
    assert opened.look() == ""
    assert opened.title == "replaced"


def test_a_reload_allows_the_files_that_the_user_allowed(opened: Opened, tmp_path: Path) -> None:
    Image.new("RGB", (2, 2), (9, 9, 9)).save(tmp_path / "wood.png")
    painted = 'type = "lambertian"\ncolor = { image = "../wood.png" }'
    text = opened.file.read_text()
    head, _, rest = text.partition('type = "lambertian"\ncolor = ')
    opened.files.rules = FileRules(allow_outside=True, variant="of a model saved as this scene")
    opened.file.write_text(head + painted + rest[rest.index("\n") :])
    assert opened.look() == ""
    assert files_of(opened.session.scene) == ["../wood.png"]
    opened.files.rules = STRICT
    opened.file.write_text(opened.file.read_text() + "\n")
    assert "--allow-outside" in opened.look()


def test_a_folder_in_place_of_the_scene_loses_nothing(opened: Opened) -> None:
    opened.file.unlink()
    opened.file.mkdir()
    assert "no longer there" in opened.look()
    opened.files.save_again()
    assert "Cannot write cornell.toml" in opened.session.problem
    assert opened.title == MINE
    assert opened.files.is_changed


def test_a_scene_whose_folder_was_renamed_stays_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "methods").mkdir()
    monkeypatch.chdir(tmp_path)
    opened = Opened(tmp_path, "methods/glass.toml")
    os.rename("methods", "moved")
    assert "methods/glass.toml is no longer there" in opened.look()
    opened.files.save_again()
    assert "Cannot write methods/glass.toml" in opened.session.problem
    assert opened.title == MINE
    opened.files.save_scene("moved/glass.toml")
    assert opened.session.problem == ""
    assert read_scene(Path("moved/glass.toml")).title == MINE


def test_the_working_folder_may_be_renamed(opened: Opened, tmp_path: Path) -> None:
    os.rename(tmp_path / "place", tmp_path / "moved")
    assert opened.look() == ""
    opened.files.save_again()
    assert read_scene(tmp_path / "moved/cornell.toml").title == MINE
