"""Every way to render, each in a process of its own, against the first that works."""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bench import gpu
from bench.gpu import Row, difference, main, measure, summary, table, tried, ways
from bench.gpu_way import Work, _repeat
from glrt.doctor.report import Examination
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer

MUCH = {"size": 4, "samples": 2, "seconds": 0.0}
FOUND = {
    "renderer": "Painter",
    "version": "4.5",
    "tier": "generic",
    "compile_seconds": 0.25,
    "longest_dispatch": 0.012,
    "samples_per_second": 2.5e6,
    "peak_bytes": 100 << 20,
}
DRIVER = f"""
import json, os, sys, time
import numpy as np
work, found = json.loads(sys.argv[1]), {FOUND!r}
pictures = np.zeros((2, 4, 4, 3), np.float32)
pictures[1] = 1
way = work["pipeline"], work["tier"]
if way == ("compute", "generic"):
    print("out of registers", file=sys.stderr)
    sys.stderr.flush()
    os.abort()
if way == ("fragment", "generic"):
    pictures += work["device"] * 1e-3
if way == ("fragment", "complete"):
    pictures += 0.125
found["tier"] = work["tier"]
if work["scene"] == "hangs":
    time.sleep(100)
if work["scene"] == "refused":
    found = {{"error": "RenderError: no such shader"}}
np.save(sys.argv[2], pictures)
print("noise of a driver")
print(json.dumps(found))
"""


@pytest.fixture
def driver(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A stand-in for a way: it crashes with the first, and paints by the others."""
    program = tmp_path / "driver.py"
    program.write_text(DRIVER)
    monkeypatch.setattr(gpu, "PROGRAM", (sys.executable, str(program)))


def work(**changes: Any) -> Work:
    way: dict[str, Any] = {"route": "auto", "device": 0, "pipeline": "compute", "tier": "complete"}
    return Work(**{**way, "scene": "sky", **MUCH, **changes})


@pytest.mark.slow
@pytest.mark.usefixtures("driver")
def test_ways_are_held_against_the_first_that_works() -> None:
    rows = list(measure(list(ways([("egl", 0), ("egl", 1)], ["sky"], **MUCH))))
    verdicts = ["fails", "first", "same bits", "WRONG: 12 %", "fails", "same bits", "0.1 %"]
    assert [row.verdict for row in rows] == [*verdicts, "WRONG: 12 %"]
    assert [row.is_right for row in rows] == [False, True, True, False, False, True, True, False]
    assert rows[0].found == {"error": "it crashed (SIGABRT): out of registers"}
    assert summary(rows) == (
        "8 renders: 1 first, 2 with the same bits, 1 within 1 % of the noise, 2 WRONG, 2 failed"
    )


@pytest.mark.usefixtures("driver")
def test_a_way_that_hangs_or_is_refused_says_so(tmp_path: Path) -> None:
    hung = tried(work(scene="hangs"), tmp_path / "pictures.npy", patience=0.1)
    assert hung == {"error": "no answer within 0.1 s; it was stopped"}
    refused = tried(work(scene="refused"), tmp_path / "pictures.npy")
    assert refused == {"error": "RenderError: no such shader"}


def test_a_difference_is_relative_to_that_of_the_seeds() -> None:
    rng = np.random.default_rng(0)
    first = rng.normal(1, 0.5, (2, 64, 64, 3)).astype(np.float32)
    assert difference(first, first.copy()) == 0
    assert difference(first, first[::-1]) == pytest.approx(1)
    assert difference(first, first + np.float32(0.5 * 2**0.5)) == pytest.approx(1, rel=0.05)
    broken = first.copy()
    broken[0, 0, 0] = np.nan
    assert not Row(work(), FOUND, difference(first, broken)).is_right


def test_the_table_reports_figures_and_errors() -> None:
    rows = [
        Row(work(), FOUND),
        Row(work(device=1), {**FOUND, "tier": "complete"}, 0.002),
        Row(work(pipeline="fragment"), {"error": "no such shader"}),
    ]
    _, _, first, near, failed, _, error = table(rows)
    figures = "0.25 s | 12 ms | 2.5 million samples/s | 100 MiB |"
    assert first == f"| sky | auto | compute | generic for complete | first | {figures}"
    assert near == f"| sky | auto 1 | compute | complete | 0.2 % | {figures}"
    assert failed == "| sky | auto | fragment | complete | fails | | | | |"
    assert error == "- sky, auto, fragment, complete: no such shader"


def test_a_picture_is_rendered_again_until_the_time_is_spent(context: Context) -> None:
    renderer = Renderer(load("sky"), context=context, width=8, height=8, samples=2)
    taken: list[float] = []
    _repeat(renderer, 0.0, taken)
    assert len(taken) == 1
    _repeat(renderer, sum(taken) + 1e-9, taken)
    assert len(taken) >= 2
    assert renderer.samples == 2
    renderer.release()


def test_an_interrupted_run_reports_what_it_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The time on a machine with a GPU may be short."""

    def interrupted(*_: Any) -> Iterator[Row]:
        yield Row(work(), {"error": "it hangs"})
        raise KeyboardInterrupt

    monkeypatch.setattr("bench.gpu.measure", interrupted)
    assert main(["--auto", "-o", str(tmp_path)]) == 130
    printed = capsys.readouterr()
    assert "it hangs" in printed.out
    assert printed.err.endswith("interrupted\n")
    assert "it hangs" in (tmp_path / "gpu.md").read_text()
    assert len(json.loads((tmp_path / "gpu.json").read_text())["rows"]) == 1


@pytest.mark.slow
def test_each_way_of_this_machine_is_tried(
    context: Context, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if not context.has_compute:
        pytest.skip("this machine has no compute shaders")
    line = ["--quick", "--scenes", "sky", "--size", "8", "--samples", "4", "-o", str(tmp_path)]
    assert main(line) == 0
    printed = capsys.readouterr()
    assert context.renderer in printed.out
    assert (tmp_path / "gpu.md").read_text() == printed.out
    rows = json.loads((tmp_path / "gpu.json").read_text())["rows"]
    assert [(row["pipeline"], row["tier"]) for row in rows] == [
        ("compute", "generic"),
        ("compute", "complete"),
        ("fragment", "generic"),
        ("fragment", "complete"),
    ]
    for row in rows:
        assert row["is_right"]
        assert row["found"]["longest_dispatch"] * row["found"]["samples_per_second"] > 0
        assert row["found"]["peak_bytes"] > 10 << 20


@pytest.mark.slow
def test_what_a_driver_refuses_is_a_finding(tmp_path: Path) -> None:
    found = tried(work(route="egl", device=15), tmp_path / "pictures.npy")
    assert found["error"].startswith("ContextError: egl: ")


@pytest.mark.slow
@pytest.mark.usefixtures("driver")
def test_routes_that_open_are_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    opened = {"open": {"renderer": "Painter", "version": "4.1"}}
    closed = {"open": {"error": "window: no display"}}
    found = [Examination("egl", 0, opened, ""), Examination("window", 0, closed, "")]
    monkeypatch.setattr(gpu, "examine_all", lambda: found)
    assert main(["--scenes", "sky", "-o", str(tmp_path / "new")]) == 1
    printed = capsys.readouterr().out
    assert "- egl: Painter, OpenGL 4.1\n  - the self-test needs compute shaders" in printed
    assert "- window does not open: no display\n" in printed
    assert printed.count("| sky | egl |") == 4
