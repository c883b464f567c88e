"""The table of load, with the figures of the thesis."""

import sys

import pytest

from bench import load
from bench.load import Row, main, measure, place, table
from bench.load_side import Work
from glrt.core.errors import RenderError

FOUND = {
    "renderer": "Painter",
    "size": [32, 24],
    "frames_per_second": 59.96,
    "cpu": 0.125,
    "gpu": 0.88,
    "gpu_unknown": "",
    "peak_bytes": 100 << 20,
}


def test_a_row_shows_the_figures_next_to_those_of_the_thesis() -> None:
    rows = [
        Row("cornell", "thesis", FOUND),
        Row("lens", "default", {**FOUND, "gpu": None, "gpu_unknown": "no driver"}),
    ]
    first, second = list(table(rows))[2:]
    assert first.startswith("| cornell | thesis | 60.0 | 12 % | 88 % | 100 MiB | 60, by v-sync; ")
    assert "88 % (Windows 11, DirectX 12)" in first
    assert second == "| lens | default | 60.0 | 12 % | not known | 100 MiB |  |"
    assert "Painter" in place(rows, 60.0)
    assert "32 x 24 pixels, at most 60 frames a second." in place(rows, 60.0)
    assert place(rows[1:], 0.0).endswith("without a limit of frames. GPU: no driver.")


def test_a_wrong_scene_is_refused_before_anything_is_measured(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(load, "measure", lambda _work: pytest.fail("measured"))
    assert main(["cornell", "cornel"]) == 2
    assert "did you mean 'cornell'" in capsys.readouterr().err


def test_a_process_that_fails_is_reported_by_its_last_line(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    work = Work("cornell", {"colour": 1}, 1.0, 0.0)
    with pytest.raises(RenderError, match="there is no setting 'colour'"):
        measure(work)
    program = "raise SystemExit('the driver is gone')"
    monkeypatch.setattr(load, "PROGRAM", (sys.executable, "-c", program))
    with pytest.raises(RenderError, match="cornell: no frames were drawn: the driver is gone"):
        measure(work)


@pytest.mark.slow
def test_each_scene_is_drawn_in_each_way_within_the_limit(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["cornell", "--seconds", "0.5", "--size", "16", "12", "--limit", "20"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "16 x 12 pixels, at most 20 frames a second" in lines[0]
    rows = [[cell.strip() for cell in line.split("|")] for line in lines[4:]]
    assert [row[1:3] for row in rows] == [["cornell", "thesis"], ["cornell", "default"]]
    for row in rows:
        assert 0 < float(row[3]) <= 20.5
        assert 0 < float(row[4].removesuffix(" %")) <= 100
        assert int(row[6].removesuffix(" MiB")) > 50
