"""Files of unsaved edits: where they lie, and the scene and time in their first line."""

import os
from datetime import datetime
from pathlib import Path

import pytest

from glrt.view.recovery.headers import Header, header_of, key_of, recovery_folder
from glrt.view.recovery.offers import offers_for

NOON = datetime(2026, 3, 4, 12, 5).timestamp()


def test_a_scene_is_known_by_its_path_whatever_the_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("deep").mkdir()
    Path("mine.toml").touch()
    whole = str(tmp_path.resolve() / "mine.toml")
    assert [key_of(name) for name in ("mine.toml", "deep/../mine.toml", whole)] == [whole] * 3
    assert [key_of(name) for name in ("cornell", "-", "unknown")] == ["cornell", "", ""]


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
        (None, 60, "Edits of 12:05 were not saved."),
        (1, 60, "1 edit of 12:05 was not saved."),
        (5, 60, "5 edits of 12:05 were not saved."),
        (5, 86_400, "5 edits of 4 March 2026, 12:05 were not saved."),
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
