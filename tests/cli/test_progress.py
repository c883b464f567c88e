"""The bar of a render: seconds that are left to the first of its limits."""

import json
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import pytest

from glrt.cli.reports import progress
from glrt.cli.reports.progress import Forecast, film_lines, progress_lines
from glrt.rendering.stopping import Limits
from glrt.settings import MAX_SAMPLES


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> dict[str, float]:
    """The time, which stands until it is set."""
    now = {"seconds": 100.0}
    monkeypatch.setattr(progress, "time", SimpleNamespace(perf_counter=lambda: now["seconds"]))
    return now


def renderer(samples: int, error: float) -> Any:
    image = SimpleNamespace(error=error)
    settings = SimpleNamespace(division=SimpleNamespace(least_known=32))
    work = float(samples)
    return SimpleNamespace(samples=samples, work=work, settings=settings, plain_image=lambda: image)


def told(clock: dict[str, float], limits: Limits, samples: int, begun: int = 0) -> dict[str, Any]:
    """After 4 seconds, with an error of 20 %."""
    forecast = Forecast(limits, begun)
    clock["seconds"] += 4
    return forecast.after(renderer(samples, 0.2))


@pytest.mark.parametrize(
    ("limits", "begun", "total"),
    [
        (Limits(400), 0, 16),  # at 25 samples a second
        (Limits(1000, deadline=110.0), 0, 10),
        (Limits(1000, deadline=187.0), 0, 40),
        (Limits(1 << 20, error=0.1), 0, 16),  # four times the samples
        (Limits(350, error=0.1), 0, 14),
        (Limits(1 << 20, error=0.5), 0, 4),  # reached, and seen at 64
        (Limits(1 << 20, deadline=106.0, error=0.1), 0, 6),
        (Limits(400), 50, 28),  # at 12.5 a second
        (Limits(1 << 20, error=0.1), 50, 28),
    ],
    ids=[
        *("samples", "time", "samples before time", "error", "samples before error", "reached"),
        *("time before error", *"ab"),
    ],
)
def test_the_first_limit_reports_how_long_it_takes(
    clock: dict[str, float], limits: Limits, begun: int, total: float
) -> None:
    state = told(clock, limits, 100, begun)
    assert state["completed"] == pytest.approx(min(4 / total, 1))
    assert state["rest"].endswith(f"4 s, {total - 4:.0f} s to go")
    most = "" if limits.samples == MAX_SAMPLES else f" of {limits.samples}"
    assert state["done"] == f"100{most} samples", "nobody asked for 2^20"


def test_the_error_is_reported_once_it_was_looked_at(clock: dict[str, float]) -> None:
    assert told(clock, Limits(400), 100)["rest"].startswith("error 20 %  4 s")
    forecast = Forecast(Limits(400))
    clock["seconds"] += progress.LOOK / 2
    assert "error" not in forecast.after(renderer(31, 0.2))["rest"], "not before the second block"
    assert forecast.after(renderer(32, 0.2))["rest"].startswith("error 20 %")


def test_before_the_error_is_known_nobody_knows_how_long_it_takes(clock: dict[str, float]) -> None:
    forecast = Forecast(Limits(MAX_SAMPLES, error=0.03))
    clock["seconds"] += progress.LOOK / 2
    state = forecast.after(renderer(20, 0.2))
    assert state == {
        "completed": 0.0,
        "done": "20 samples",
        "rest": "1 s, how long is not known yet",
    }


def test_looks_at_the_error_take_a_twentieth_of_the_time(clock: dict[str, float]) -> None:
    """A large film takes seconds to read back."""
    looks: list[float] = []

    def plain_image() -> Any:
        looks.append(clock["seconds"])
        clock["seconds"] += 3.0
        return SimpleNamespace(error=0.2)

    large: Any = SimpleNamespace(
        samples=1,
        work=1.0,
        plain_image=plain_image,
        settings=SimpleNamespace(division=SimpleNamespace(least_known=32)),
    )
    forecast = Forecast(Limits(400))
    for _ in range(1000):
        clock["seconds"] += 0.25
        forecast.after(large)
    assert len(looks) > 3
    assert all(after - before > 3.0 / 0.05 for before, after in pairwise(looks))


def test_what_takes_longer_than_foretold_is_all_but_done(clock: dict[str, float]) -> None:
    state = told(clock, Limits(400, deadline=101.0), 100)
    assert state["completed"] == 1
    assert state["rest"].endswith(" 0 s to go")


def test_progress_for_programs_is_two_lines_of_json_a_second(
    clock: dict[str, float], capsys: pytest.CaptureFixture[str]
) -> None:
    with progress_lines(Limits(400)) as watch:
        for samples in (50, 51, 52, 100):
            clock["seconds"] += 0.25
            watch(renderer(samples, 0.2))
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    first = {"progress": 0.125, "seconds_left": 1.8, "samples": 50, "error": 0.2}
    assert lines == [first, {**first, "progress": 0.13, "seconds_left": 5.0, "samples": 52}]


def test_progress_of_a_film_counts_frames_and_no_time_for_those_that_were_kept(
    clock: dict[str, float], capsys: pytest.CaptureFixture[str]
) -> None:
    with film_lines(10) as watch:
        for number, done in ((4, 4), (5, 5), (7, 7)):
            clock["seconds"] += 3
            watch(number, done, Limits(400), renderer(0, 0.2))
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [line["seconds_left"] for line in lines] == [None, 15.0, 6.0]
    assert [line["progress"] for line in lines] == [0.4, 0.5, 0.7]
    assert lines[0] == {"progress": 0.4, "seconds_left": None, "frame": 4, "frames": 10, "done": 4}
