"""Figures of a contest, on renders made up so that the truth is known; and the command."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from bench import rivals
from bench.cold_start import starts
from bench.contest import Factor, Runs, lead_of, seconds_to
from bench.rivals import Row, main
from bench.turns import Pace
from tests.bench.painter import painter
from tests.support.alarms import book

LEVEL = np.linspace(0.5, 2, 12 * 12 * 3).reshape(12, 12, 3)
ROUNDS = 40


def runs(variance: float, samples: int, seconds: float, seed: int, bias: float = 1.0) -> Runs:
    """Renders whose samples have the variance, relative to the level, in every pixel."""
    draw = np.random.default_rng(seed)
    scale = np.square(LEVEL) + 0.01 * LEVEL.mean() ** 2
    noise = draw.normal(0, np.sqrt(variance * scale / samples), (ROUNDS, *LEVEL.shape))
    times = seconds * draw.uniform(0.9, 1.1, ROUNDS)
    return Runs("made up", samples, times, (bias * LEVEL + noise).astype(np.float32))


def test_variance_of_a_sample_is_what_was_put_in_whatever_the_samples_and_the_mean() -> None:
    for seed, (samples, bias) in enumerate([(1, 1.0), (16, 1.0), (16, 1.5), (256, 0.9)]):
        found = runs(3.0, samples, 0.1, seed, bias).variances(LEVEL)
        assert found.shape == (ROUNDS,)
        assert found.mean() == pytest.approx(3.0, rel=0.06)  # 5.5 sigmas
        book()


def test_time_to_an_error_is_variance_times_seconds_a_sample() -> None:
    seconds = seconds_to(0.1, runs(2.0, 8, 0.4, 0), LEVEL)
    assert seconds == pytest.approx(2.0 / 0.1**2 * 0.4 / 8, rel=0.1)
    book()


def test_a_lead_is_the_product_of_rate_and_variance() -> None:
    lead = lead_of(runs(2.0, 32, 0.2, 0), runs(3.0, 8, 0.1, 1), LEVEL)
    assert lead.rate.value == pytest.approx(2.0, rel=0.1)
    assert lead.variance.value == pytest.approx(1.5, rel=0.1)
    book(2)
    assert lead.time.value == pytest.approx(lead.rate.value * lead.variance.value)
    for factor in lead:
        assert factor.low < factor.value < factor.high
        assert factor.high / factor.low < 1.2


def test_intervals_hold_the_truth() -> None:
    """95 % of them are promised, and 60 rounds give 93: fewer than 42 of 60 do by chance hardly."""
    held = 0
    for seed in range(60):
        lead = lead_of(runs(2.0, 8, 0.1, seed), runs(2.0, 8, 0.1, seed + 1000), LEVEL)
        held += lead.variance.low <= 1 <= lead.variance.high
    assert held >= 42
    book()


def test_a_factor_is_written_with_its_interval() -> None:
    assert str(Factor(3.456, 3.0, 4.0)) == "3.46 (3.00-4.00)"


PAINTER = """
import sys, time
assert sys.argv[1] == "cornell"
hoard = bytearray(200 << 20)
time.sleep(0.1)
open(sys.argv[-1], "w").close()
"""


@pytest.mark.slow
def test_a_start_is_timed_whole_with_its_memory() -> None:
    mine = np.ones(400 << 20, np.uint8)  # memory of the process that starts it does not count
    programs = {
        "painter": [sys.executable, "-c", PAINTER],
        "broken": [sys.executable, "-c", "raise SystemExit(3)"],
        "idle": [sys.executable, "-c", ""],
    }
    found = starts(programs, 2)
    assert list(found) == ["painter"]
    assert mine.all()
    assert found["painter"].seconds > 0.1
    assert 200 << 20 < found["painter"].peak < 300 << 20


@pytest.mark.slow
def test_figures_are_printed_and_saved_and_absent_peers_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    absent = [sys.executable, "-c", "raise SystemExit('no adapter')"]
    turns = tmp_path / "turns"
    own, other = painter("Own 1", 2e-4, turns), painter("Painter 2", 1e-3, turns)
    peers = {"glrt": own, "Mitsuba": other, "WGSL": absent}
    monkeypatch.setattr(rivals, "PEERS", peers)
    monkeypatch.setattr(rivals, "PROGRAMS", {"glrt": [sys.executable, "-c", PAINTER]})
    file = tmp_path / "rivals.json"
    line = "--scenes sky --size 16 --rounds 3 --seconds 1 --json"
    assert main([*line.split(), str(file)]) == 0
    printed = capsys.readouterr()
    assert "Without WGSL: no adapter" in printed.err
    assert "Own 1, Painter 2" in printed.out
    assert "Every rate in turns is within 10% of the rate alone." in printed.out
    saved = json.loads(file.read_text())
    rows = saved["rows"]
    assert f"| glrt | {saved['first pictures']['glrt']['seconds']:.2f} s |" in printed.out
    samplers = ("sobol", "sobol64", "shared", "independent")
    ours = [f"glrt mis, {sampler}" for sampler in samplers]
    names = [*ours, "Mitsuba", "glrt naive"]
    assert [row["renderer"].partition(", r")[0].partition(", no r")[0] for row in rows] == names
    assert printed.out.count("| sky |") == len(rows)
    for row in rows[:4]:
        assert row["rival"] == rows[4]["renderer"]
        factors = {name: row["lead"][name]["value"] for name in ("time", "rate", "variance")}
        assert factors["time"] == pytest.approx(factors["rate"] * factors["variance"])
        assert factors["rate"] == pytest.approx(5)
    assert rows[4]["lead"] is rows[5]["lead"] is None


def test_a_renderer_slowed_down_by_turns_ends_the_command_with_1(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    row = Row("sky", "Mitsuba", 64, 1e6, Pace(1e6, 2e6), 1.0, 1.0, None, None)
    monkeypatch.setattr(rivals, "installed", lambda commands: {})
    monkeypatch.setattr(rivals, "PROGRAMS", {})
    monkeypatch.setattr(rivals.Contest, "rows", lambda contest, name: [row])
    assert main(["--scenes", "sky"]) == 1
    printed = capsys.readouterr().out
    assert "| sky | Mitsuba | 64 | 1.00 | 0.50 (!) |" in printed
    assert "NOT TO BE QUOTED:\n- sky, Mitsuba: 1.00 million samples/s in turns" in printed
