"""Renderers take turns, one process at a time, and a rate that this changes is reported."""

import sys
import time
from pathlib import Path

import numpy as np
import pytest

from bench.peer import Peer, Request
from bench.turns import (
    LEAST_SECONDS,
    Contender,
    Entry,
    Pace,
    Picture,
    complaints,
    installed,
    interleaved,
    pace,
    rate_alone,
    samples_for,
    started,
    verdict,
)
from glrt.core.errors import RenderError
from tests.bench.painter import painter
from tests.support.builders import MATTE, scene_of, sphere

SCENE = scene_of([sphere([0, 0, -3], 1, "matte")], {"matte": MATTE})


class Stage:
    """Contenders that know who was before them; time is only claimed."""

    def __init__(self) -> None:
        """Nobody was there yet."""
        self.calls: list[tuple[str, int, int]] = []

    def contender(
        self, name: str, cost: float, block: int = 1, slower_after_others: float = 1.0
    ) -> Contender:
        def render(samples: int, seed: int) -> tuple[Picture, float]:
            after_other = self.calls and self.calls[-1][0] != name
            self.calls.append((name, samples, seed))
            factor = slower_after_others if after_other else 1.0
            return np.full((2, 2, 3), seed, np.float32), cost * samples * factor

        return Contender(name, render, block)


def test_contenders_take_turns_with_seeds_of_their_own() -> None:
    stage = Stage()
    both = [stage.contender("a", 0.001), stage.contender("b", 0.002, 16)]
    found = interleaved(both, 3, 0.1)
    assert [each.samples for each in found] == [100, 48]
    expected = [
        (name, count, seed) for seed in (1, 2, 3) for name, count in (("a", 100), ("b", 48))
    ]
    assert stage.calls[-6:] == expected
    assert found[1].pictures[:, 0, 0, 0].tolist() == [1, 2, 3]
    assert found[1].seconds.tolist() == pytest.approx([0.096] * 3)


def test_samples_come_in_whole_blocks_and_are_rendered_once_before_they_count() -> None:
    stage = Stage()
    contender = stage.contender("a", 0.001, 16)
    assert samples_for(contender, 0.5) == 496
    assert stage.calls[-1] == ("a", 496, 0)
    assert samples_for(contender, 0.5, multiple=4) == 512
    assert samples_for(contender, 1e-6, multiple=4) == 64


def test_a_rate_that_halves_in_turns_is_reported_and_no_other() -> None:
    stage = Stage()
    steady = stage.contender("steady", 1e-3)
    shy = stage.contender("shy", 1e-3, slower_after_others=2.0)
    alone = [rate_alone(each, 1.0) for each in (steady, shy)]
    runs = interleaved([steady, shy], 5, 1.0)
    paces = [pace(each, rate) for each, rate in zip(runs, alone, strict=True)]
    assert [found.ratio for found in paces] == pytest.approx([1.0, 0.5])
    said = list(complaints(["steady", "shy"], paces, 1.0))
    assert len(said) == 1
    assert said[0].startswith("shy: ")
    assert "0.50 times as many" in said[0]
    assert verdict(said).startswith("NOT TO BE QUOTED")
    assert [str(found) for found in paces] == ["1.00", "0.50 (!)"]


@pytest.mark.parametrize(
    ("in_turns", "is_kept"), [(0.91, True), (0.89, False), (1.09, True), (1.11, False)]
)
def test_a_rate_is_kept_within_a_tenth(in_turns: float, is_kept: bool) -> None:
    assert Pace(in_turns * 4e6, 4e6).is_kept == is_kept


def test_short_turns_are_reported_whatever_the_rates() -> None:
    assert list(complaints(["a"], [Pace(1.0, 1.0)], LEAST_SECONDS)) == []
    assert verdict([]) == "Every rate in turns is within 10% of the rate alone."
    (said,) = complaints(["a"], [Pace(1.0, 1.0)], 0.16)
    assert "0.16 s are too short" in said


BUSY = """
import os, threading
from glrt.core.errors import SceneError
from bench.peer import serve

def spin():
    while True:
        pass

threading.Thread(target=spin, daemon=True).start()

def render(request):
    with open(f"/proc/{os.getpid()}/stat") as file:
        raise SceneError(file.read())

serve("Busy 1", render)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_a_process_is_stopped_between_its_turns() -> None:
    """All of its threads stop, also one that never waits."""

    def turn(peer: Peer) -> list[str]:
        with pytest.raises(RenderError) as said:
            peer.render(Request.of(SCENE, width=1, height=1, bounces=1, samples=1, seed=0))
        return str(said.value).split()

    with started({"busy": [sys.executable, "-c", BUSY]}) as peers:
        pid, _, state, *_ = turn(peers["busy"])
        assert state == "R"
        while Path(f"/proc/{pid}/stat").read_text().split()[2] != "T":
            time.sleep(0.001)  # for ever, if it is not stopped: pytest ends the test
        assert turn(peers["busy"])[2] == "R"
    assert not Path(f"/proc/{pid}").exists()


def test_entries_are_rendered_by_the_process_of_their_program(tmp_path: Path) -> None:
    asked = Request.of(SCENE, width=4, height=3, bounces=1, samples=1, seed=0)
    entry = Entry("name", "painter", asked)
    with started({"painter": painter("Painter 2", 0.5, tmp_path / "turns")}) as peers:
        picture, seconds = entry.contender(peers).render(8, 3)
        again, _ = entry.contender(peers).render(8, 3)
        other, _ = entry.contender(peers).render(8, 4)
    assert picture.shape == (3, 4, 3)
    assert seconds == 4.0
    assert np.array_equal(picture, again)
    assert not np.array_equal(picture, other)


def test_programs_that_do_not_start_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    absent = [sys.executable, "-c", "raise SystemExit('no adapter')"]
    commands = {"a": painter("Painter 2", 1.0, tmp_path / "turns"), "b": absent}
    assert installed(commands) == {"a": "Painter 2"}
    assert capsys.readouterr().err == "Without b: no adapter\n"
