"""FLIP next to the error of the contract: of the shown picture, and only where installed."""

import csv
import json
import sys
from pathlib import Path

import numpy as np
import pytest

from glrt.analysis.chart import experiment, flip
from glrt.analysis.chart.experiment import Experiment, Plan, measure_scene
from glrt.analysis.chart.files import save_chart, save_page
from glrt.analysis.variants import Variant, variants_of
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.image.tonemap import expose_and_encode
from glrt.scene.scene import Scene
from glrt.settings import Settings

STAND_IN = """
def evaluate(reference, test, kind, applyMagma):
    assert kind == "LDR" and not applyMagma
    assert reference.dtype == test.dtype == "float32"
    return None, abs(test - reference).mean(), {}
"""


@pytest.fixture
def evaluator(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A package of that name which takes the mean difference of two pictures."""
    (tmp_path / "packages").mkdir()
    (tmp_path / "packages" / "flip_evaluator.py").write_text(STAND_IN)
    monkeypatch.syspath_prepend(tmp_path / "packages")
    monkeypatch.delitem(sys.modules, "flip_evaluator", raising=False)


@pytest.fixture
def no_evaluator(monkeypatch: pytest.MonkeyPatch) -> None:
    """A Python without the package."""
    monkeypatch.setattr(flip, "find_spec", lambda _name: None)


def measured(context: Context, folder: Path, rounds: int = 2) -> Experiment:
    """An experiment with two methods."""

    def two(scene: Scene, settings: Settings) -> list[Variant]:
        return variants_of(scene, settings, ["mis", "whitted"], leads=False)

    plan = Plan(8, rounds, 0.1)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(experiment, "variants_of", two)
        return measure_scene("sky", load("sky"), plan, context, folder / "r", lambda *_: None)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where a chart goes, and a cache of the test's own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path


@pytest.mark.usefixtures("evaluator")
def test_pictures_are_compared_as_they_are_shown() -> None:
    truth, picture = np.full((4, 4, 3), 0.5), np.full((4, 4, 3), 0.7)
    codes = [expose_and_encode(each, 0.0, "neutral").astype(float) for each in (truth, picture)]
    assert flip.flip(picture, truth) == pytest.approx((codes[1] - codes[0]).mean() / 255, rel=1e-5)
    assert flip.flip(1e6 * truth, 2e6 * truth) == 0, "both are white"


@pytest.mark.slow
@pytest.mark.usefixtures("evaluator")
def test_every_point_of_a_chart_has_it(context: Context, folder: Path) -> None:
    result = measured(context, folder)
    save_chart(result, folder)
    with (folder / "sky.csv").open(newline="") as file:
        flips = {
            (row["variant"], row["samples"]): float(row["flip"]) for row in csv.DictReader(file)
        }
    points = json.loads((folder / "sky.json").read_text())["points"]
    assert [point["flip"] for point in points] == list(flips.values())
    assert flips["whitted", "1"] > flips["mis", "32"] > 0
    page = save_page([result], folder).read_text()
    assert "| FLIP at the end |" in page
    assert "FLIP is the perceived difference" in page


@pytest.mark.usefixtures("evaluator")
def test_it_is_asked_once_and_kept(context: Context, folder: Path) -> None:
    first = measured(context, folder)
    (folder / "packages" / "flip_evaluator.py").write_text("")  # would fail if it were asked
    sys.modules.pop("flip_evaluator")
    more = measured(context, folder, rounds=3)
    assert [c.points[0].flip for c in more.curves] == [c.points[0].flip for c in first.curves]


@pytest.mark.slow
@pytest.mark.usefixtures("no_evaluator")
def test_without_the_package_a_chart_does_without(context: Context, folder: Path) -> None:
    result = measured(context, folder)
    save_chart(result, folder)
    assert {point["flip"] for point in json.loads((folder / "sky.json").read_text())["points"]} == {
        None
    }
    assert "FLIP" not in save_page([result], folder).read_text()


def test_rounds_that_were_not_asked_are_measured_again_once_it_is_installed(
    context: Context, folder: Path, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as without:
        without.setattr(flip, "find_spec", lambda _name: None)
        assert measured(context, folder).curves[0].points[0].flip is None
    request.getfixturevalue("evaluator")
    assert measured(context, folder).curves[0].points[0].flip is not None


def test_the_package_itself_knows_same_from_different() -> None:
    """0 for one picture twice, and little less than 1 for black against white."""
    pytest.importorskip("flip_evaluator")
    black, white = np.zeros((32, 32, 3)), np.full((32, 32, 3), 1e6)
    assert flip.flip(white, white) == 0
    assert 0.9 < flip.flip(white, black) <= 1
    assert 0 < flip.flip(black + 0.2, black + 0.21) < 0.1
