"""Drivers end loops early: frames that lost samples are done again, or what is lost is counted."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.cli.main import main
from glrt.cli.reports.render_report import Done
from glrt.core.resources import folder
from glrt.gpu import driver_checks
from glrt.gpu.context import Context
from glrt.gpu.driver_checks import usable_rounds
from glrt.image.sources import load
from glrt.plan import facts
from glrt.rendering import schedule
from glrt.rendering.renderer import Renderer
from tests.support.builders import MATTE, plane, scene_of, sphere
from tests.support.media import EVEN, MU
from tests.support.renders import rendered, rendering, same
from tests.truths.test_grids import smoke, with_smoke


@pytest.fixture
def hopeful(monkeypatch: pytest.MonkeyPatch) -> None:
    """The renderer believes that rays run through any tree in no time."""
    monkeypatch.setattr(schedule.iterations_per_sample, "__defaults__", (0.0,))  # of `tree_rounds`


def test_kernels_report_losses_by_the_same_rule() -> None:
    """Or always, as paths of a pixel do."""
    reports = {
        file.name: line
        for file in folder("shaders_glsl").rglob("*.comp")
        for line in file.read_text().splitlines()
        if "atomicAdd(lost_samples" in line
    }
    assert {"trace.comp", "adaptive.comp", "aov.comp", "particles.comp"} <= {*reports}
    del reports["paths.comp"]
    assert all("if (MAY_LOSE && " in line for line in reports.values()), reports


@pytest.mark.slow
@pytest.mark.usefixtures("hopeful")
def test_a_frame_that_lost_samples_is_done_again_with_fewer_at_once(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Bit for bit: 300 samples a dispatch of rays that meet 300 nodes each are too many."""
    if usable_rounds(context) is None:
        pytest.skip("this driver has no loop limit")
    balls = [sphere([0, 0, 0], 1 + k / 2**20, "m") for k in range(300)]
    scene = scene_of(balls, {"m": MATTE}, background={"color": [1, 1, 1]})
    settings = {"width": 8, "height": 8, "bounces": 3}
    with rendering(scene, context, **settings) as renderer:
        before = renderer.most_samples
        renderer.step(300)
        assert renderer.most_samples <= 300 // 2 < before
        assert renderer.nonfinite() == 0
        image = renderer.image()
    for name in ("TREE_FROM", "SPHERES_FROM"):
        monkeypatch.setattr(facts, name, 1 << 30)
    assert same(image, rendered(scene, context, 300, **settings))


@pytest.mark.slow
@pytest.mark.usefixtures("hopeful")
@pytest.mark.parametrize("method", ["mis", "march"])
def test_a_frame_that_lost_samples_in_a_grid_is_done_again(
    context: Context, monkeypatch: pytest.MonkeyPatch, method: str
) -> None:
    """A ray has 1,000 steps or null collisions: 300 samples a dispatch are too many."""
    if usable_rounds(context) is None:
        pytest.skip("this driver has no loop limit")
    grid = np.full((8, 8, 8), 0.3, np.float32)
    grid[0, 0, 0] = 250.0  # in a corner that no ray meets; its brick holds all voxels
    scene = with_smoke(smoke(grid, absorption=MU), background=EVEN)
    settings: dict[str, Any] = {"width": 8, "height": 8, "bounces": 0, "method": method}
    settings["march_step"] = 0.002
    with rendering(scene, context, **settings) as renderer:
        before = renderer.most_samples
        renderer.step(300)
        assert renderer.most_samples <= 300 // 2 < before
        assert renderer.nonfinite() == 0
        image = renderer.image()
    monkeypatch.undo()
    assert same(image, rendered(scene, context, 300, **settings))


def test_a_limit_that_is_measured_late_leaves_the_context_as_it_was(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Paths so long that the known limit may not do have it measured on the way."""
    monkeypatch.setattr(driver_checks, "_limits", {})
    assert rendered(load("weekend"), context, 1, bounces=1000).samples == 1


@pytest.mark.slow
def test_a_sample_beyond_the_loop_limit_is_dropped_and_counted(context: Context) -> None:
    """Rays to the left meet 40,000 spheres, twice, and are lost; those to the right none."""
    pile_of = [sphere([-3, 0, -5], 2 + k / 2**20, "white") for k in range(40_000)]
    white = {"white": {"type": "lambertian", "color": [1, 1, 1]}}
    scene = scene_of(pile_of, white, background={"color": [0.5, 0.5, 0.5]})
    renderer = Renderer(scene, context=context, width=64, height=16, method="naive")
    image = renderer.render(2).image()
    dropped = renderer.nonfinite()
    if usable_rounds(context) is None:
        assert dropped == 0
        assert set(np.unique(image.radiance)) == {0.5}, "white balls vanish under an even sky"
        renderer.release()
        return
    assert 2 * 64 * 16 / 8 < dropped < 2 * 64 * 16
    assert set(np.unique(image.radiance)) <= {0.0, 0.5}, "no sample is wrong"
    renderer.step(2)
    assert (renderer.samples, renderer.most_samples) == (4, 1)
    renderer.release()


def test_dropped_samples_are_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Done, "dropped", 1234)
    small = ["--width", "8", "--height", "8", "--samples", "1"]
    assert main(["render", "sky", "-o", str(tmp_path / "a.npy"), *small]) == 0
    assert "1,234 samples were dropped" in capsys.readouterr().err


@pytest.mark.slow
def test_65_536_spheres_are_rendered_without_losing_a_sample(context: Context) -> None:
    rng = np.random.default_rng(4)
    center = rng.uniform(-1, 1, (65_535, 3)).round(4).tolist()
    many = [sphere(c, 0.01, "m") for c in center]
    scene = scene_of(
        [*many, plane([0, -1, 0], [0, 1, 0], "m")],
        {"m": MATTE},
        {"position": [0, 0, 4]},
        background={"color": [1, 1, 1]},
    )
    image = rendered(scene, context, 4, width=64, height=64)
    assert 0.05 < image.radiance.mean() < 1
