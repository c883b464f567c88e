"""Methods are chosen by counted work: by no clock unless one is given, and recipes say so."""

import argparse
import math
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from glrt.analysis.chart.rays import SAMPLES, counting_variant, rays_of
from glrt.analysis.method_choice import advice, search, work
from glrt.analysis.method_choice.search import Verdict
from glrt.analysis.method_choice.trial import OutOfTimeError
from glrt.analysis.method_choice.work import busy_pixels, counting, work_per_sample
from glrt.analysis.reference import Reference
from glrt.cli.commands import run
from glrt.gpu.context import Context
from glrt.image.image import Image, read_recipe
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Limits
from glrt.scene.scene import Scene, with_lights
from glrt.setting_options import SettingOptions
from glrt.settings import Settings, settings_for
from tests.support.builders import scene_of
from tests.support.processes import glrt
from tests.support.renders import same
from tests.support.verdicts import of_bias

SIZE = ("--width", "16", "--height", "16")
AUTO = ("--method", "auto", "--error", "0.5")
BY_WORK = {"method": "auto: counted work", "bounces": "auto: counted work"}


def work_of(scene: Scene, context: Context, method: str, *bounces: int) -> list[float]:
    settings = settings_for(scene.render, width=32, height=32, method=method)
    with counting(scene, settings, context) as counter:
        return [work_per_sample(counter, limit, lambda _: True) for limit in bounces]


# --- work ----------------------------------------------------------------------------------


@pytest.mark.slow
def test_camera_rays_into_an_empty_sky_are_all_the_work(context: Context) -> None:
    sky = scene_of([], {}, background={"color": [1, 1, 1]})
    for method in ("naive", "cook"):
        assert work_of(sky, context, method, 4) == [work.SURFACE - work.CAMERA]


@pytest.mark.slow
def test_shadow_rays_are_weighed_apart_from_others(context: Context) -> None:
    scene = load("methods/diffuse")
    settings = settings_for(scene.render, width=32, height=32, method="cook")
    means = []
    for weights in ((1, 0), (0, 1)):
        variant = counting_variant(*weights)
        counter = Renderer(scene, settings, context, tier="complete", variant=variant)
        means.append(float(counter.render(SAMPLES).image().radiance.mean(dtype=float)))
        counter.release()
    assert means[0] == 1.0, "direct light alone, and no mirror"
    assert 0 < means[1] < 1
    assert sum(means) == pytest.approx(rays_of(scene, settings, context).sample)


@pytest.mark.slow
def test_work_grows_with_paths_and_with_what_is_looked_for(context: Context) -> None:
    """Times on llvmpipe, in this order: 1, 2.2 to 2.6, and 1.1 times that."""
    scene = load("lamps")
    (naive,), (nee,) = (work_of(scene, context, method, 4) for method in ("naive", "nee"))
    shorter, short, mis = work_of(scene, context, "mis", 1, 2, 4)
    assert 1.5 * naive < mis < 3 * naive
    assert mis < nee < 1.5 * mis
    assert shorter < short < mis


@pytest.mark.slow
def test_rays_of_particles_are_counted_whatever_the_lamps_shine(context: Context) -> None:
    """Where light is added up, units are those of the brightest lamp, and too much is cut."""
    scene = load("cornell")
    settings = settings_for(scene.render, width=16, height=16, caustics="on", linked=0.0)
    found = {
        rays_of(with_lights(scene, {"lamp": factor}), settings, context).sample
        for factor in (1e-6, 1.0, 1e6)
    }
    assert len(found) == 1
    without = rays_of(scene, settings_for(settings, caustics="off"), context).sample
    assert found.pop() > 1.05 * without


def test_idle_pixels_of_tiles_are_busy() -> None:
    assert [busy_pixels(Settings(width=n, height=1)) for n in (1, 8, 9)] == [64, 64, 128]


# --- the measured frame --------------------------------------------------------------------


@pytest.mark.parametrize(
    ("size", "small"),
    [((600, 400), (72, 48)), ((20, 20), (48, 48)), ((10, 100), (5, 48)), ((4000, 10), (1920, 5))],
)
def test_the_whole_frame_is_measured_in_its_own_shape(
    size: tuple[int, int], small: tuple[int, int]
) -> None:
    settings = Settings(width=size[0], height=size[1], aov=("depth",))
    found = search.small_frame(settings)
    assert (found.width, found.height) == small
    assert found.aov == ()


# --- clocks --------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which commands run, with a small frame to measure and caches of its own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(search, "HEIGHT", 16)
    monkeypatch.setattr(search, "REFERENCE_WORK", 1e8)
    return tmp_path


@contextmanager
def slow_clock(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The clock goes as on a machine that is 30 times as slow."""
    real = time.perf_counter
    with monkeypatch.context() as patch:
        patch.setattr(time, "perf_counter", lambda: 30 * real())
        yield


def chosen(name: str, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A picture by a method that is chosen without a cached reference."""
    monkeypatch.setenv("XDG_CACHE_HOME", f"cache of {name}")
    path = Path(f"{name}.exr")
    assert run(["render", "methods/open", *SIZE, *AUTO, "-o", str(path), "--quiet"]) == 0
    return path


@pytest.mark.slow
def test_no_clock_decides_and_the_recipe_reports_what_did(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two runs, one of them slow, write the same bytes; a picture of the picture keeps the word."""
    picture = chosen("fast", monkeypatch)
    with slow_clock(monkeypatch):
        assert chosen("slow", monkeypatch).read_bytes() == picture.read_bytes()
    assert read_recipe(picture).decisions == BY_WORK
    assert len(list(folder.glob("cache of */glrt/references/*.npz"))) == 2

    def again(*words: str) -> Image:
        assert run(["render", *words, "-o", "again.exr", "--quiet"]) == 0
        return Image.load("again.exr")

    def decisions(image: Image) -> dict[str, str]:
        assert image.recipe
        return image.recipe.decisions

    monkeypatch.setattr(advice, "choose", None)
    copy = again(str(picture))
    assert same(copy, Image.load(picture))
    assert decisions(copy) == BY_WORK
    assert decisions(again("--resume", str(picture), "--samples", "96")) == BY_WORK
    method = read_recipe(picture).settings.method
    assert [*decisions(again(str(picture), "--method", method))] == ["bounces"]


@pytest.mark.slow
def test_processes_at_different_load_write_the_same_bytes(tmp_path: Path) -> None:
    def render(name: str) -> bytes:
        path = tmp_path / f"{name}.exr"
        cache = str(tmp_path / name)
        done = glrt("render", "methods/open", *SIZE, *AUTO, "-o", path, XDG_CACHE_HOME=cache)
        assert done.returncode == 0, done.stderr
        return path.read_bytes()

    alone = render("alone")
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    try:
        assert render("beside others") == alone
    finally:
        for process in busy:
            process.kill()
            process.wait()


# --- decisions in recipes ------------------------------------------------------------------


def choice_by(
    monkeypatch: pytest.MonkeyPatch, deadline: float | None, **given: int
) -> advice.Choice:
    """The choice where a measurement finds `mis`, or where it has no time."""
    ones = Reference(np.ones((1, 1, 3)), np.ones((1, 1, 3)), 1, 1)

    def measure(
        arguments: object, scene: Scene, settings: Settings, asked: search.Question
    ) -> Verdict:
        del arguments, scene, settings
        if asked.seconds == -math.inf:
            raise OutOfTimeError
        return Verdict(0.5, ones, (of_bias(0.0),), {})

    monkeypatch.setattr(advice, "_verdict", measure)
    arguments = argparse.Namespace(quiet=True, **given)
    limits = Limits(1 << 20, deadline, 0.5)
    return advice.choose(arguments, load("sky"), Settings(), limits)


def test_a_decision_names_what_it_was_made_by(monkeypatch: pytest.MonkeyPatch) -> None:
    assert choice_by(monkeypatch, None).decisions == BY_WORK
    assert choice_by(monkeypatch, None, bounces=3).decisions.keys() == {"method"}
    late = choice_by(monkeypatch, math.inf)
    assert late.decisions["method"] == "auto: counted work, within half of --time"
    none = choice_by(monkeypatch, -math.inf)
    assert none.settings.method == "mis"
    assert [*none.decisions] == ["method"]
    assert "too short" in none.decisions["method"]


def test_a_renderer_reports_no_more_of_a_setting_that_changes(context: Context) -> None:
    settings = Settings(width=8, height=8)
    renderer = Renderer(load("sky"), settings, context, decisions=BY_WORK)
    told = []
    changes: list[SettingOptions] = [{"seed": 3}, {"bounces": 2}]
    for change in changes:
        renderer.update(**change)
        recipe = renderer.render(1).image().recipe
        assert recipe
        told.append([*recipe.decisions])
    assert told == [["method", "bounces"], ["method"]]
    renderer.release()
