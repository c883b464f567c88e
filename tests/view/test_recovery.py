"""Unsaved edits are kept in a file, and offered to the next window of the scene; none is opened."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest

from glrt.core.resources import folder
from glrt.image.sources import load
from glrt.scene.scenefile.toml import read_scene
from glrt.scene.scenefile.toml_writer import scene_with
from glrt.view.edits.new_objects import with_model
from glrt.view.edits.scene_edits import without_objects
from glrt.view.recovery import keeper
from glrt.view.recovery.headers import header_of
from glrt.view.recovery.keeper import AGAIN
from tests.support.kept_windows import Opened, files_of, let_all_die, next_to

CUBE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


@pytest.fixture
def opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Opened]:
    monkeypatch.chdir(tmp_path)
    yield Opened(tmp_path)
    let_all_die()


def test_an_edit_is_written_as_a_save_writes_it(opened: Opened) -> None:
    opened.edit()
    session = opened.session
    assert read_scene(opened.file) == scene_with(session.scene, session.settings)
    header = header_of(opened.file)
    assert header
    assert (header.source, header.edits, header.models) == ("cornell", 1, ())


def test_without_edits_nothing_is_written(opened: Opened) -> None:
    opened.look()
    assert files_of(opened) == []


def test_edits_are_written_at_most_once_in_a_few_seconds(opened: Opened) -> None:
    opened.edit()
    written = opened.file.read_text()
    ball = opened.session.scene.objects[-1].model_copy(update={"radius": 0.2})
    opened.session.edit(opened.session.scene.model_copy(update={"objects": (ball,)}))
    opened.look(0.1)
    assert opened.file.read_text() == written
    opened.look()
    assert opened.file.read_text() != written


def test_what_takes_long_to_write_is_written_less_often(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[Path] = []

    def slow(file: Path, _text: str) -> None:
        opened.clock.now += 2.0
        written.append(file)

    monkeypatch.setattr(keeper, "write_text", slow)
    opened.edit()
    opened.edit()
    assert len(written) == 1
    opened.look(2.0 / keeper.SHARE)
    assert len(written) == 2


@pytest.mark.parametrize("end", ["undo", "save", "close", "open"])
def test_nothing_is_left_once_nothing_is_unsaved(opened: Opened, end: str) -> None:
    opened.edit()
    assert len(files_of(opened)) == 2
    ends: dict[str, Callable[[], object]] = {
        "undo": opened.session.undo,
        "save": partial(opened.files.save_scene, "mine.toml"),
        "close": partial(opened.recovery.end, is_interrupted=False),
        "open": partial(opened.files.open, "lamps"),
    }
    ends[end]()
    if end != "close":
        opened.look()
    assert files_of(opened) == []


def test_a_signal_leaves_the_last_edit(opened: Opened) -> None:
    opened.edit()
    ball = opened.session.scene.objects[-1]
    opened.session.edit(opened.session.scene.model_copy(update={"objects": (ball,)}))
    opened.recovery.end(is_interrupted=True)
    assert opened.file.exists()
    assert read_scene(opened.file).objects == (ball,)


def test_a_signal_without_edits_leaves_nothing(opened: Opened) -> None:
    opened.recovery.end(is_interrupted=True)
    assert files_of(opened) == []


def test_edits_of_a_window_that_died_are_restored_as_one_step(opened: Opened) -> None:
    opened.edit()
    opened.edit(lambda scene: without_objects(scene, {0}))
    opened.session.edit(bounces=2, samples=7)
    opened.look()
    opened.die()
    later = next_to(opened)
    assert later.recovery.offers[0].header.edits == 3
    before = later.session.state
    later.recovery.restore()
    assert later.session.scene.objects == opened.session.scene.objects
    assert (later.session.settings.bounces, later.session.settings.samples) == (2, 7)
    assert later.shown == [later.session.scene]
    assert files_of(later) == [later.file.with_suffix(".lock").name, later.file.name]
    later.session.undo()
    assert later.session.state == before


def test_discarded_edits_are_gone(opened: Opened) -> None:
    opened.edit()
    opened.die()
    later = next_to(opened)
    later.recovery.discard()
    assert (later.recovery.offers, files_of(opened)) == ([], [])


@pytest.mark.parametrize("answer", ["put_off", "end"])
def test_edits_without_an_answer_are_offered_again(opened: Opened, answer: str) -> None:
    opened.edit()
    opened.die()
    later = next_to(opened).recovery
    (later.put_off if answer == "put_off" else partial(later.end, is_interrupted=False))()
    assert len(next_to(opened).recovery.offers) == 1


def test_the_edits_of_an_open_window_are_not_offered(opened: Opened) -> None:
    opened.edit()
    other = next_to(opened)
    assert other.recovery.offers == []
    other.edit()
    assert opened.file.exists()
    assert other.file.exists()
    opened.recovery.end(is_interrupted=False)
    assert other.file.exists()


def test_one_window_alone_offers_them(opened: Opened) -> None:
    opened.edit()
    opened.die()
    first = next_to(opened)
    assert (len(first.recovery.offers), len(next_to(opened).recovery.offers)) == (1, 0)


def test_the_newest_come_first(opened: Opened) -> None:
    opened.edit()
    other = next_to(opened)
    other.edit()
    opened.edit()
    for window in (opened, other):
        window.die()
    assert [offer.file for offer in next_to(opened).recovery.offers] == [opened.file, other.file]


def test_they_belong_to_their_scene(opened: Opened) -> None:
    opened.edit()
    opened.die()
    Path("cornell.toml").write_text((folder("scenes") / "cornell.toml").read_text())
    assert next_to(opened, "cornell.toml").recovery.offers == []
    later = next_to(opened, "lamps")
    assert later.recovery.offers == []
    later.files.open("cornell")
    later.look()
    assert len(later.recovery.offers) == 1


def test_a_model_from_another_folder_comes_back(opened: Opened) -> None:
    elsewhere = Path("models")
    elsewhere.mkdir()
    (elsewhere / "cube.obj").write_text(CUBE)
    opened.edit(partial(with_model, path=elsewhere / "cube.obj", place=(0.0, 0.0, 0.0), size=0.1))
    opened.die()
    later = next_to(opened)
    later.recovery.restore()
    assert later.session.problem == ""
    assert later.session.scene.objects == opened.session.scene.objects


def test_what_cannot_be_restored_is_reported_and_stays(opened: Opened) -> None:
    opened.edit()
    opened.file.write_text(opened.file.read_text() + "nonsense")
    opened.die()
    later = next_to(opened)
    later.recovery.restore()
    assert opened.file.name in later.session.problem
    assert not later.session.history.can_undo
    assert opened.file.exists()


def test_a_full_disk_is_reported_once(opened: Opened) -> None:
    opened.file.parent.write_text("a file where the folder should be")
    opened.edit()
    assert "Edits are not kept" in opened.session.problem
    opened.session.problem = ""
    opened.look(AGAIN)
    assert opened.session.problem == ""
    opened.file.parent.unlink()
    opened.look(AGAIN)
    assert opened.file.exists()


def test_a_file_that_was_tidied_up_is_written_again(opened: Opened) -> None:
    opened.edit()
    opened.file.unlink()
    opened.look()
    assert not opened.file.exists()
    opened.look(AGAIN)
    assert opened.file.exists()


def test_edits_after_an_undo_of_saved_ones_have_no_number(opened: Opened) -> None:
    opened.edit()
    opened.files.save_scene("mine.toml")
    opened.look()
    opened.session.undo()
    opened.look()
    assert '"edits": null' in opened.file.read_text()


def test_the_last_words_name_the_file(opened: Opened) -> None:
    assert "No edits were unsaved" in opened.recovery.last_words()
    opened.edit(lambda scene: without_objects(scene, {0}))
    words = opened.recovery.last_words()
    assert str(opened.file) in words
    assert "`glrt view cornell`" in words
    assert "\n" not in words


def test_edits_of_media_are_edits_to_be_saved(opened: Opened) -> None:
    medium = load("fog").media
    opened.edit(lambda scene: scene.model_copy(update={"media": medium}))
    assert opened.files.is_changed
