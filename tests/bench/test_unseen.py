"""Leads over scenes that nobody has seen, from renders made up so that the truth is known."""

import json
import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from bench import unseen
from bench.contest import (
    Array,
    Redrawn,
    Runs,
    Slope,
    distance,
    lead_of,
    over_scenes,
    slope_of,
    time_lead_of,
)
from bench.unseen import Result, main, report, result, seed_of
from tests.bench.painter import painter
from tests.support.alarms import book

LEVEL = np.linspace(0.5, 2, 24 * 24 * 3).reshape(24, 24, 3)
ROUNDS = 16


def runs(variance: float, samples: int, rate: float, seed: int, bias: float = 1.0) -> Runs:
    """Renders whose samples have the variance, relative to the level, in every pixel."""
    draw = np.random.default_rng(seed)
    scale = np.square(LEVEL) + 0.01 * LEVEL.mean() ** 2
    noise = draw.normal(0, np.sqrt(variance * scale / samples), (ROUNDS, *LEVEL.shape))
    seconds = LEVEL[..., 0].size * samples / rate * draw.uniform(0.99, 1.01, ROUNDS)
    return Runs("made up", samples, seconds, (bias * LEVEL + noise).astype(np.float32))


def made_up(seed: int, ours: float, theirs: float, slope: float = -0.5) -> Result:
    """A scene of these variances, in which glrt is said to have the slope."""
    few = [runs(ours, 16, 2e6, seed), runs(theirs, 64, 1e6, seed + 1)]
    many = [runs(ours, 64, 2e6, seed + 2), runs(theirs, 256, 1e6, seed + 3)]
    found = result(seed, "a scene", few, many, (2e6, 1e6), LEVEL)
    slopes = [Slope(value, value - 0.1, value + 0.1) for value in (slope, -0.5)]
    return found._replace(slopes=(slopes[0], slopes[1]))


def test_known_variances_and_rates_give_the_lead_and_the_seconds() -> None:
    found = made_up(0, 0.5, 1.5)
    value, low, high = found.lead.factor
    assert value == pytest.approx(6, rel=0.08)  # twice the rate, a third of the variance
    assert low < value < high
    assert 1.01 < high / low < 1.15  # 1.3 % is the standard error of a ratio of variances
    pixels = LEVEL[..., 0].size
    expected = 0.5 / 0.02**2 * pixels / 2e6, 1.5 / 0.02**2 * pixels / 1e6
    assert found.seconds == pytest.approx(expected, rel=0.08)
    assert [pace.is_kept for pace in found.paces] == [True, True]
    book(3)


def test_the_lead_in_time_is_that_of_a_contest() -> None:
    ours, theirs = runs(0.5, 64, 2e6, 0), runs(1.5, 64, 1e6, 1)
    assert time_lead_of(ours, theirs, LEVEL).factor == lead_of(ours, theirs, LEVEL).time


def test_independent_samples_have_the_slope_and_spread_ones_do_not() -> None:
    """Among 40 scenes at 99 %, a dozen without it are hardly chance."""
    slopes = [slope_of(runs(1, 16, 1e6, n), runs(1, 64, 1e6, n + 99), LEVEL) for n in range(40)]
    assert sum(not slope.is_half for slope in slopes) < 12
    assert slopes[0].value == pytest.approx(-0.5, abs=0.03)
    steep = slope_of(runs(2, 16, 1e6, 0), runs(1, 64, 1e6, 1), LEVEL)
    assert not steep.is_half
    assert steep.value == pytest.approx(-0.75, abs=0.03)
    book(3)


def test_means_apart_are_distinguished_from_noise() -> None:
    first = runs(1.0, 64, 1e6, 0)
    assert distance(first, runs(1.0, 64, 1e6, 1), LEVEL) < 0.025
    assert distance(first, runs(1.0, 64, 1e6, 1, bias=1.1), LEVEL) == pytest.approx(0.1, abs=0.01)
    book(2)


def redrawn(value: float, spread: float, seed: int) -> Redrawn:
    values: Array = value * np.random.default_rng(seed).lognormal(0, spread, 2000)
    return Redrawn(value, values)


def test_over_scenes_the_mean_is_geometric_and_its_interval_is_of_the_scenes() -> None:
    mean = over_scenes([redrawn(1, 0.01, 0), redrawn(4, 0.01, 1)])
    assert mean.value == pytest.approx(2)
    assert mean.low == pytest.approx(1, rel=0.05)  # the first scene twice
    assert mean.high == pytest.approx(4, rel=0.05)
    many = over_scenes([redrawn(math.exp(n % 2), 0.01, n) for n in range(64)])
    assert many.low < math.sqrt(math.e) < many.high
    assert many.high / many.low == pytest.approx(math.exp(2 * 1.96 * 0.5 / 8), rel=0.1)


def test_over_scenes_the_noise_of_each_counts() -> None:
    mean = over_scenes([redrawn(2, 0.3, n) for n in range(9)])
    assert mean.high / mean.low == pytest.approx(math.exp(2 * 1.96 * 0.3 / 3), rel=0.15)


def test_scenes_without_the_slope_stand_apart() -> None:
    lines = list(report([made_up(10, 0.5, 1.0), made_up(20, 0.5, 1.0, slope=-0.7)]))
    apart = next(n for n, line in enumerate(lines) if "does not fall as t^-1/2" in line)
    assert ["| 10 |" in line for line in lines[:apart]].count(True) == 1
    assert ["| 20 |" in line for line in lines[apart:]].count(True) == 1
    assert "t^-1/2: 1; lead of glrt over Mitsuba, geometric mean" in lines[-2]
    assert "All scenes: 2; " in lines[-1]
    book(3)
    whole = list(report([made_up(10, 0.5, 1.0)]))
    assert not any("does not fall" in line or "All scenes" in line for line in whole)


def test_worst_and_best_are_named() -> None:
    last = list(report([made_up(10 * n, 0.5, theirs) for n, theirs in enumerate((1, 3, 2))]))[-1]
    for name, value in (("mean", 4 * 6 ** (1 / 3)), ("worst", 4), ("best", 12)):
        found = re.search(rf"{name} ([\d.]+) \(", last)
        assert found
        assert float(found[1]) == pytest.approx(value, rel=0.08)
    book(3)


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A checkout in small."""
    for name in ("glrt/error/estimate.py", "shaders_glsl/trace.glsl", "docs/README.md"):
        path = tmp_path / name
        path.parent.mkdir(parents=True)
        path.write_text("first")
    return tmp_path


@pytest.mark.parametrize("name", ["glrt/error/estimate.py", "shaders_glsl/trace.glsl"])
def test_another_program_has_another_seed(tree: Path, name: str) -> None:
    before = seed_of(tree)
    (tree / name).write_text("other")
    changed = seed_of(tree)
    assert len({before, changed}) == 2
    (tree / name).rename((tree / name).with_name("renamed"))
    assert seed_of(tree) not in {before, changed}


def test_what_is_no_part_of_the_program_leaves_the_seed(tree: Path) -> None:
    before = seed_of(tree)
    (tree / "docs/README.md").write_text("other")
    (tree / "glrt/__pycache__").mkdir()
    (tree / "glrt/__pycache__/estimate.pyc").write_text("compiled")
    assert seed_of(tree) == before
    assert 0 <= before < 1 << 32


@pytest.fixture
def _painters(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both renderers are painters; the variance of glrt is a quarter of that of Mitsuba."""
    turns = tmp_path / "turns"
    peers = {"glrt": painter("Own 1", 1e-3, turns), "Mitsuba": painter("Other 2", 4e-3, turns)}
    monkeypatch.setattr(unseen, "PEERS", peers)


@pytest.mark.slow
@pytest.mark.usefixtures("_painters")
def test_the_command_measures_scenes_as_long_as_there_is_time(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "unseen.json"
    line = "--scenes 2 --minutes 0 --size 16 --rounds 4 --seconds 1 --json"
    assert main([*line.split(), str(file)]) == 0
    printed = capsys.readouterr()
    assert f"seeds from {seed_of()} on" in printed.out
    assert "Own 1, Other 2, " in printed.out
    assert "Every rate in turns is within 10% of the rate alone." in printed.out
    assert "1 scenes of 2: no time for more" in printed.err
    (scene,) = json.loads(file.read_text())["scenes"]
    assert scene["lead"]["value"] == pytest.approx(4, rel=0.3)
    book()
    assert scene["seed"] == seed_of()


@pytest.mark.slow
@pytest.mark.usefixtures("_painters")
def test_a_seed_of_a_table_renders_its_scene_again(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    seeds: list[int] = []

    def measure(commands: object, seed: int, *rest: object) -> Result:
        seeds.append(seed)
        return made_up(seed, 0.5, 1.0)

    monkeypatch.setattr(unseen, "measure", measure)
    assert main(["--seed", "7", "--scenes", "2"]) == 0
    assert seeds == [7, 8]
    assert "seeds from 7 on" in capsys.readouterr().out


@pytest.mark.usefixtures("_painters")
def test_a_black_scene_is_left_out(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The generator leaves out lamps for which there is no room; 0 / 0 would be no lead."""
    monkeypatch.setattr(unseen, "level_of", lambda *_: np.zeros((8, 8, 3)))
    assert main(["--scenes", "1", "--seed", "7", "--size", "8"]) == 4
    told = capsys.readouterr().err
    assert "seed 7 is left out: its picture is black: no light reaches the camera." in told


def test_without_mitsuba_there_is_no_comparison(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    absent = [sys.executable, "-c", "raise SystemExit('no wheel')"]
    peers = {"glrt": painter("Own 1", 1e-3, tmp_path / "turns"), "Mitsuba": absent}
    monkeypatch.setattr(unseen, "PEERS", peers)
    assert main([]) == 4
    printed = capsys.readouterr().err
    assert "Without Mitsuba: no wheel" in printed
    assert "it needs both" in printed
