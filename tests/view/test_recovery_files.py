"""Files of unsaved edits: where they lie, and the scene and time in their first line."""

import os
from datetime import datetime
from pathlib import Path

import pytest

from glrt.image.sources import load
from glrt.view.recovery.claims import Claim
from glrt.view.recovery.headers import Header, header_of, key_of, recovery_folder
from glrt.view.recovery.offers import KEPT, lock_of, offers_for, prune

NOON = datetime(2026, 3, 4, 12, 5).timestamp()
ROOM = load("cornell")


def test_a_scene_is_known_by_its_path_whatever_the_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("deep").mkdir()
    Path("mine.toml").touch()
    whole = str(tmp_path.resolve() / "mine.toml")
    names = "mine.toml", "deep/../mine.toml", whole
    assert [key_of(name, ROOM) for name in names] == [whole] * 3
    assert [key_of(name, ROOM) for name in ("cornell", "", "unknown")] == ["cornell", "", ""]


def test_a_scene_from_standard_input_is_known_by_its_content() -> None:
    again, other = load("cornell"), load("lamps")
    assert key_of("-", ROOM) == key_of("-", again) != key_of("-", other)


OLD = NOON - KEPT - 1


@pytest.mark.parametrize(
    ("source", "saved", "is_kept"),
    [
        ("gone.toml", OLD, False),
        ("gone.toml", OLD + 2, True),
        ("there.toml", OLD, True),
        ("nowhere/gone.toml", OLD, True),
        ("cornell", OLD, True),
        ("-", OLD, False),
        ("-", OLD + 2, True),
    ],
)
def test_old_edits_of_scenes_that_are_gone_are_removed(
    tmp_path: Path, source: str, saved: float, is_kept: bool
) -> None:
    (tmp_path / "there.toml").touch()
    (tmp_path / "kept").mkdir()
    file = tmp_path / "kept" / "other.toml"
    is_path = source.endswith(".toml")
    key = str(tmp_path / source) if is_path else key_of(source, ROOM)
    file.write_text(Header(key, saved).line())
    claim = Claim(lock_of(file))
    prune(file.parent, NOON)
    assert file.exists(), "its window is open"
    claim.release()
    prune(file.parent, NOON)
    assert file.exists() == is_kept
    assert lock_of(file).exists() == is_kept


@pytest.mark.parametrize(
    "line",
    [
        "",
        "title = 'a scene'",
        "# glrt recovery",
        "# glrt recovery []",
        '# glrt recovery {"source": "cornell"}',
        '# glrt recovery {"source": "cornell", "saved": 1e300, "edits": 1, "models": []}',
        '# glrt recovery {"source": "cornell", "saved": "now", "edits": 1, "models": []}',
        "# glrt recovery " + 9999 * "[",
    ],
)
def test_a_damaged_file_is_not_offered_and_stays(tmp_path: Path, line: str) -> None:
    file = tmp_path / "other.toml"
    file.write_text(line + "\n")
    assert header_of(file) is None
    assert offers_for("cornell", tmp_path) == []
    assert file.exists()


def test_a_pipe_in_the_folder_is_not_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.toml")
    assert offers_for("cornell", tmp_path) == []


@pytest.mark.parametrize(
    ("edits", "later", "told"),
    [
        (None, 60, "Edits, made until 12:05, were not saved."),
        (1, 60, "1 edit, made until 12:05, was not saved."),
        (5, 60, "5 edits, made until 12:05, were not saved."),
        (5, 86_400, "5 edits, made until 4 March 2026, 12:05, were not saved."),
    ],
)
def test_the_question_names_time_and_number(edits: int | None, later: float, told: str) -> None:
    assert Header("cornell", NOON, edits).told(NOON + later) == told


def test_the_folder_is_that_of_the_system(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert recovery_folder() == tmp_path / "glrt" / "recovery"
    monkeypatch.delenv("XDG_STATE_HOME")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    assert recovery_folder() == tmp_path / "home" / ".local" / "state" / "glrt" / "recovery"
