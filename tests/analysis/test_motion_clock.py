"""Milliseconds of frames while something moves: what is timed, and where it is reported."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.analysis.chart.curves import Interval
from glrt.analysis.motion import clock
from glrt.analysis.motion.playing import Played, play
from glrt.analysis.motion.report import rows, save_page, section_of
from glrt.analysis.motion.sequences import Sequence, orbit
from glrt.cli.commands import run
from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.history.temporal import Way
from glrt.settings import Settings, settings_for
from tests.analysis.test_motion import TRACKS


def test_frames_are_timed_in_rounds_that_play_each_mode_once(
    monkeypatch: pytest.MonkeyPatch, context: Context
) -> None:
    """The still frames before a step do not count; neither does the first frame of an orbit."""
    played: list[str] = []
    settings = Settings()
    ways = {name: Played(settings, Way(name)) for name in ("reset", "taa", "wrls")}
    names = {way: name for name, way in ways.items()}

    def plays(frames: Sequence, way: Played, *rest: Any, seconds: list[float]) -> Iterator[None]:
        played.append(names[way])
        for number in range(4):
            seconds.append(
                {0: 50.0, 1: 9.0 * frames.first}.get(number, number + played.count("taa"))
            )
            yield

    monkeypatch.setattr(clock, "play", plays)
    rounds: list[int] = []
    orbiting, step = (Sequence("any", (load("cornell"),) * 4, first) for first in (0, 2))
    found = clock.milliseconds_of(step, ways, context, 1, 3, rounds.append)
    assert rounds == [0, 1, 2]
    assert [sorted(played[3 * n : 3 * n + 3]) for n in range(3)] == [sorted(ways)] * 3
    assert played[:3] != played[3:6]
    assert found["taa"] == (4500, 4000, 5000), "of 3, 4, 4, 5, 5 and 6 seconds"
    assert clock.milliseconds_of(orbiting, ways, context, 1, 2, rounds.append)["taa"].low < 3000


def test_a_clock_changes_no_picture(context: Context) -> None:
    scene = load("cornell")
    settings = settings_for(scene.render, width=24, height=24, bounces=2, sampler="independent")
    frames, way = orbit(scene, 3, 1.0), Played(settings, Way("reset"))
    spent: list[float] = []
    timed = [*play(frames, way, context, seconds=spent)]
    np.testing.assert_array_equal(timed, [*play(frames, way, context)])
    assert len(spent) == 3
    assert min(spent) > 0


def test_milliseconds_are_charted_where_something_moves(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"--milliseconds times frames .* give --temporal"):
        run(["chart", "cornell", "-o", str(tmp_path), "--milliseconds"])


def test_only_timed_tracks_have_a_column_and_a_chart_of_milliseconds(tmp_path: Path) -> None:
    timed = [track._replace(milliseconds=Interval(12.345, 9.0, 20.0)) for track in TRACKS]
    page = save_page(timed, "Small.", tmp_path).read_text()
    assert "| times lower than reset | milliseconds a frame |" in page
    assert "| reproject | 5.7 | 0.500 | 1.33 | 12.3 (9-20) |" in page
    assert next(iter(rows(timed)))[-1] == "12.35"
    section = section_of("room", "A room", timed)
    assert [axes.x_label for axes in section.charts][2:] == ["milliseconds a frame, median"] * 2
    [dot] = section.charts[2].lines[1].dots
    assert (dot.x, dot.y) == (12.345, 0.5)
    assert len(section_of("room", "A room", TRACKS).charts) == 2
    assert "millisecond" not in save_page(TRACKS, "Small.", tmp_path).read_text()
