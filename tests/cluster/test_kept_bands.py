"""`glrt render --cluster`: bands that have arrived are kept until the picture is written."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from glrt.cli.commands import run
from glrt.cluster import worker
from glrt.core import files
from glrt.core.errors import RenderError
from tests.support.clusters import small_cluster

BANDS = 3
SMALL = ("--width", "16", "--height", str(8 * BANDS), "--samples", "16", "--bounces", "4")


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """A cluster of one worker."""
    with small_cluster() as found:
        yield found


@pytest.fixture
def done(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The numbers of the bands that the worker renders; the last one fails the first time."""
    result, numbers = worker.result, list[int]()

    def counted(parcel: bytes, digest: str, number: int | None, *rest: str) -> dict[str, Any]:
        if number is not None:
            numbers.append(number)
        if number == BANDS - 1 and numbers.count(number) == 1:
            return {"renderer": rest[0], "problem": ("the driver gave up.", 4)}
        return result(parcel, digest, number, *rest)

    monkeypatch.setattr(worker, "result", counted)
    return numbers


def render(out: Path, *more: str) -> int:
    return run(["render", "cornell", "-o", str(out), *SMALL, "--quiet", *more])


def test_a_command_that_failed_continues_with_its_bands(
    cluster: Any, done: list[int], tmp_path: Path
) -> None:
    here, there = tmp_path / "here.exr", tmp_path / "there.exr"
    where = ("--cluster", cluster.scheduler_address)
    assert render(here) == 0
    with pytest.raises(RenderError, match="gave up"):
        render(there, *where)
    kept = tmp_path / "there.exr.bands"
    assert sorted(done) == [0, 1, 2]
    assert len(list(kept.iterdir())) == BANDS - 1
    (kept / "mine.txt").write_text("stays")
    damaged = sorted(kept.glob("*-0.exr"))[0]
    damaged.write_bytes(damaged.read_bytes()[:-40])
    assert render(there, *where) == 0
    assert sorted(done[BANDS:]) == [0, 2]
    assert there.read_bytes() == here.read_bytes()
    assert [path.name for path in kept.iterdir()] == ["mine.txt"]


def test_bands_of_another_picture_do_not_count(
    cluster: Any, done: list[int], tmp_path: Path
) -> None:
    """Another seed; the folder goes with all bands when the picture is written."""
    out, where = tmp_path / "out.exr", ("--cluster", cluster.scheduler_address)
    with pytest.raises(RenderError, match="gave up"):
        render(out, *where)
    assert render(out, *where, "--seed", "1") == 0
    assert sorted(done[BANDS:]) == [0, 1, 2]
    assert [path.name for path in tmp_path.iterdir()] == ["out.exr"]


def test_a_full_disk_keeps_no_band_and_the_render_goes_on(
    cluster: Any,
    done: list[int],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    done.append(BANDS - 1)  # it does not fail
    rename = files._rename

    def full(old: Path, new: Path) -> None:
        if new.parent.name == "out.exr.bands":
            raise OSError(28, os.strerror(28))
        rename(old, new)

    monkeypatch.setattr(files, "_rename", full)
    out = tmp_path / "out.exr"
    assert render(out, "--cluster", cluster.scheduler_address) == 0
    printed = capsys.readouterr().err
    assert printed.count("a band is not kept: ") == 1
    assert "No space left on device" in printed
    assert [path.name for path in tmp_path.iterdir()] == ["out.exr"]
