"""Curves of a chart: noise falls with the square root of the samples, and ends in the bias."""

from pathlib import Path

import numpy as np
import pytest

from glrt.analysis import reference
from glrt.analysis.chart import experiment, measure
from glrt.analysis.chart.curves import Curve, Interval
from glrt.analysis.chart.experiment import Experiment, Plan, measure_scene
from glrt.analysis.variants import Variant, variants_of
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.plan.methods import METHODS, traits_of
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.support.builders import box_of_quads, lamp, quad, scene_of
from tests.support.renders import rendered

NOISY = "5 bounces", "gather", "resampled"  # their noise is not small against their bias


@pytest.fixture
def unhurried(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Samples that no speed changes: 1024 of each run, at least, and 4096 of a reference's half.

    Of methods without probes, which take a hundred times as long with so few pixels.
    """
    measure_alone(monkeypatch, tmp_path, 1024, has_probes=False)


@pytest.fixture
def probes_unhurried(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The same of methods with probes alone, with 128 samples of each run."""
    measure_alone(monkeypatch, tmp_path, 128, has_probes=True)


def measure_alone(
    monkeypatch: pytest.MonkeyPatch, folder: Path, least: int, has_probes: bool
) -> None:
    def variants(scene: Scene, settings: Settings) -> list[Variant]:
        methods = [it for it in METHODS if traits_of(Settings(method=it)).has_probes == has_probes]
        return variants_of(scene, settings, methods, leads=not has_probes)

    monkeypatch.setenv("XDG_CACHE_HOME", str(folder))
    monkeypatch.setattr(measure, "LEAST_SAMPLES", least)
    monkeypatch.setattr(reference, "FIRST_LOOK", 4096)
    monkeypatch.setattr(experiment, "variants_of", variants)


def slopes_of(curves: tuple[Curve, ...]) -> list[Interval]:
    """The slopes of unbiased variants, independent numbers, not denoised, over three decades."""
    others = "sobol", "shared", "denoised"  # shared numbers are points of Sobol'
    plain = [c for c in curves if not c.is_biased and not any(o in c.name for o in others)]
    assert {c.points[-1].samples for c in plain} == {1024}
    slopes = [c.slope for c in plain if c.slope is not None]
    assert len(slopes) == len(plain) >= 5
    return slopes


def assert_halves(slopes: list[Interval]) -> None:
    """All are within 0.03 of -0.5. One interval in twenty misses -0.5 by chance."""
    assert all(abs(slope.value + 0.5) <= 0.03 for slope in slopes), slopes
    missed = [slope for slope in slopes if not slope.low <= -0.5 <= slope.high]
    assert len(missed) <= 1, missed


@pytest.mark.slow
@pytest.mark.usefixtures("unhurried")
def test_slopes_are_a_half_and_the_floor_is_the_bias(context: Context, tmp_path: Path) -> None:
    """In a glowing box of albedo 0.5, B bounces leave 0.5^(B+1) of the light: a closed form."""
    ceiling = quad([-1, 1.9, -1], [2, 0, 0], [0, 0, 2], "wall")
    box = scene_of([*box_of_quads("wall", 2.0), ceiling], {"wall": lamp(0.5, 0.5)})
    scene = box.model_copy(update={"render": box.render.model_copy(update={"bounces": 12})})
    plan = Plan(16, 8, 0.1)
    result = measure_scene("box", scene, plan, context, tmp_path / "r", lambda *_: None)
    for curve in result.curves:
        bounces = {"mis, 1 bounce": 1, "mis, 2 bounces": 2, "mis, 5 bounces": 5}.get(curve.name)
        if bounces:
            assert curve.bias.value == pytest.approx(0.5 ** (bounces + 1) / 1.01**0.5, abs=0.002)
            assert curve.points[-1].error.value == pytest.approx(curve.bias.value, rel=0.05)
    assert_halves(slopes_of(result.curves))


def long_room() -> Scene:
    """A room with paths so long that what they leave out is nothing."""
    room = load("methods/diffuse")
    return room.model_copy(update={"render": room.render.model_copy(update={"bounces": 64})})


def assert_floors(result: Experiment, context: Context, samples: int) -> set[str]:
    """Hold the floors of biased curves against pictures that have nothing to do with the chart.

    Those have so many samples, and the truth 16,384. Returns the names of the curves.
    """
    scene, size = long_room(), {"width": 24, "height": 24}
    truth = rendered(scene, context, 16384, **size, seed=71, bounces=128, method="nee")
    scale = np.square(truth.radiance, dtype=np.float64) + 0.01 * truth.radiance.mean() ** 2
    held = set()
    for variant, curve in zip(result.variants, result.curves, strict=True):
        if not curve.is_biased:
            continue
        ways = variant.settings.model_dump(include={"method", "bounces", "sampler"})
        other = rendered(scene, context, samples, **size, seed=72, **ways)
        difference = np.square(other.radiance - truth.radiance, dtype=np.float64)
        noise = np.square(other.stderr) + np.square(truth.stderr)
        floor = np.sqrt(np.mean((difference - noise) / scale))
        assert curve.bias.value == pytest.approx(floor, rel=0.03, abs=0.004), curve.name
        if not any(name in curve.name for name in NOISY):
            assert curve.points[-1].error.value == pytest.approx(floor, rel=0.03), curve.name
        held.add(curve.name)
    return held


@pytest.mark.slow
@pytest.mark.timeout(900)
@pytest.mark.usefixtures("unhurried")
def test_in_a_room_too_and_floors_are_what_other_pictures_differ_by(
    context: Context, tmp_path: Path
) -> None:
    plan = Plan(24, 24, 0.1)
    result = measure_scene("room", long_room(), plan, context, tmp_path / "r", lambda *_: None)
    assert_halves(slopes_of(result.curves))
    biased = assert_floors(result, context, 16384)
    assert {"whitted", "cook", "mis, 1 bounce", "mis, 2 bounces"} <= biased


@pytest.mark.slow
@pytest.mark.timeout(900)
@pytest.mark.usefixtures("probes_unhurried")
def test_so_are_floors_of_probes(context: Context, tmp_path: Path) -> None:
    plan = Plan(24, 8, 0.1)
    result = measure_scene("room", long_room(), plan, context, tmp_path / "r", lambda *_: None)
    biased = assert_floors(result, context, 512)
    assert biased == {"ddgi, sobol", "gather, sobol", "resampled, sobol"}
