"""`glrt inspect --error`: the method and the bounces that it names suffice, and no cheaper do."""

import math
import re
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from glrt.analysis import reference as references
from glrt.analysis.method_choice import search, trial
from glrt.analysis.method_choice.advice import advice, conclusion
from glrt.analysis.method_choice.search import Verdict, what_suffices
from glrt.analysis.method_choice.trial import Bias, Candidate, OutOfTimeError
from glrt.analysis.reference import Reference
from glrt.cli.main import main
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.methods.table import CLASSIC
from glrt.resources import folder
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.support.builders import MATTE, box_of_quads, lamp, plane, scene_of, sphere
from tests.support.method_judge import Judge, random_scene
from tests.support.processes import glrt
from tests.support.renders import rendered

SIZE, SLOW_SIZE = 16, 24  # pixels of a frame
SCENES = sorted(file.stem for file in (folder("scenes") / "methods").glob("*.toml"))
QUICK = ["diffuse", "glass", "open"]  # of these, whose references are cheap


@pytest.fixture(autouse=True)
def small_and_cached(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
    context: Context,
) -> None:
    """Small frames, a cache for all tests of this file, and time that other programs do not take.

    That is processor time, where processors render.
    """
    if context.is_software:
        for module in (references, trial):
            monkeypatch.setattr(module, "time", SimpleNamespace(perf_counter=time.process_time))
    size = SLOW_SIZE if request.node.get_closest_marker("slow") else SIZE
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "suffices"))
    monkeypatch.setattr(search, "HEIGHT", size)
    monkeypatch.setattr(search, "REFERENCE_SECONDS", 1.0)


def verdict_on(scene: Scene, error: float, context: Context, **more: Any) -> Verdict:
    size = {"width": search.HEIGHT, "height": search.HEIGHT}
    settings = settings_for(scene.render, **size)
    return what_suffices(scene, settings, error, context, **more)


def candidate(verdict: Verdict, method: str) -> Candidate:
    return next(c for c in verdict.candidates if method in c.name.split(" = "))


def furnace(albedo: float = 0.5, bounces: int = 10) -> Scene:
    """A closed box that glows: paths longer than B carry albedo^(B+1) of the light."""
    box = scene_of(box_of_quads("wall", 2.0), {"wall": lamp(1 - albedo, albedo)})
    return box.model_copy(update={"render": box.render.model_copy(update={"bounces": bounces})})


class Clock:
    """Stands for the module `time`: each look at it takes a second."""

    def __init__(self) -> None:
        self.now = 0.0

    def perf_counter(self) -> float:
        self.now += 1.0
        return self.now


# --- bounces -------------------------------------------------------------------------------


def test_the_light_of_longer_paths_is_the_closed_form(context: Context) -> None:
    verdict = verdict_on(furnace(), 0.02, context)
    for limit, bias in verdict.beyond.items():
        if limit <= 6:
            truth = 0.25 ** (limit + 1) / 1.01
            assert bias.squared == pytest.approx(truth, rel=0.03, abs=4 * bias.stderr), limit
            assert bias.stderr < 0.2 * truth
    assert verdict.least_bounces == 5  # 0.5^6 = 1.6 %


def test_a_limit_that_is_given_is_kept(context: Context) -> None:
    verdict = verdict_on(furnace(), 0.3, context, bounces=2)
    assert list(verdict.beyond) == [2]
    assert verdict.best is not None
    assert {candidate.settings.bounces for candidate in verdict.candidates} == {2}


def test_a_scene_that_reflects_nothing_needs_one_bounce_and_the_cheapest_method(
    context: Context,
) -> None:
    """Black surfaces: every method shows the truth."""
    black = {"black": {"type": "lambertian", "color": [0, 0, 0]}, "lamp": lamp()}
    scene = scene_of([sphere([0, 0, -3], 1, "lamp"), sphere([1, 0, -2], 0.5, "black")], black)
    verdict = verdict_on(scene, 0.2, context)
    assert verdict.least_bounces == 1
    assert all(abs(c.bias.squared) <= 4 * c.bias.stderr for c in verdict.candidates)
    assert verdict.best is not None


# --- crops ---------------------------------------------------------------------------------


def half_lit() -> Scene:
    """A glowing plane fills the lower half of the picture; the sky above it is black."""
    return scene_of([plane([0, -1, 0], [0, 1, 0], "lamp")], {"lamp": lamp()})


@pytest.mark.parametrize(
    ("crop", "mean"), [((0, 0, 40, 10), 0.0), ((0, 30, 40, 10), 1.0), ((3, 31, 2, 1), 1.0)]
)
def test_what_is_measured_of_a_crop_is_the_crop(
    context: Context, crop: tuple[int, int, int, int], mean: float
) -> None:
    """In a frame where it has about as many pixels as a whole one has; the time is its own."""
    wanted = settings_for(half_lit().render, width=40, height=40, crop=crop)
    verdict = what_suffices(half_lit(), wanted, 0.5, context)
    assert np.unique(verdict.reference.radiance) == mean
    rows, columns, _ = verdict.reference.radiance.shape
    assert rows * columns == pytest.approx(SIZE**2, rel=0.25)
    assert columns / rows == pytest.approx(crop[2] / crop[3], rel=0.25)
    found = candidate(verdict, "mis")
    assert found.settings.crop == crop
    assert f"at {crop[2]} x {crop[3]}." in conclusion(verdict)


def test_the_time_of_a_crop_is_its_share_of_the_frame(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By a clock that goes on by one at each look, all pictures take the same time."""
    monkeypatch.setattr(trial, "time", Clock())
    monkeypatch.setattr(search, "time", Clock())
    scene = furnace()
    whole = settings_for(scene.render, width=64, height=64)
    part = settings_for(whole, crop=(8, 8, 16, 16))
    seconds = [
        candidate(what_suffices(scene, wanted, 0.5, context), "mis").seconds_per_sample
        for wanted in (whole, part)
    ]
    assert seconds[1] == pytest.approx(seconds[0] / 16, rel=0.5)


# --- biases --------------------------------------------------------------------------------


def test_the_bias_of_a_model_is_what_an_independent_measurement_finds(context: Context) -> None:
    """Direct light alone in a diffuse room: against 2048 samples of other random numbers."""
    scene = load("methods/diffuse")
    verdict = verdict_on(scene, 0.1, context)
    found = candidate(verdict, "cook").bias
    size = {"width": SIZE, "height": SIZE}
    truth = rendered(scene, context, 2048, seed=77, bounces=64, **size).radiance.astype(float)
    model = rendered(scene, context, 2048, seed=78, method="cook", **size).radiance.astype(float)
    scale = np.square(truth) + 0.01 * truth.mean() ** 2
    measured = math.sqrt(np.mean(np.square(model - truth) / scale))
    assert found.value == pytest.approx(measured, rel=0.05)
    assert 0.2 < found.value < 0.8


def test_noise_is_no_bias(context: Context) -> None:
    """A ball alone under the sky: the models are exact, and their few samples noisy at its rim."""
    scene = scene_of(
        [sphere([0, 0, -3], 1, "matte")],
        {"matte": MATTE},
        {"fov": 30},
        background={"color": [1, 1, 1]},
    )
    verdict = verdict_on(scene, 0.05, context)
    for method in CLASSIC:
        bias = candidate(verdict, method).bias
        assert bias.squared == pytest.approx(0, abs=4 * bias.stderr + 1e-12)
        assert bias.most < 0.01


def of_bias(bias: float, variance: float = 1.0, seconds: float = 1.0) -> Candidate:
    settings = settings_for(furnace().render, sampler="independent")
    return Candidate("mis", settings, Bias(bias**2, 0.0), variance, seconds)


def test_samples_make_up_for_the_bias() -> None:
    assert of_bias(0.0).samples_to(0.1) == pytest.approx(100, abs=1)
    assert of_bias(0.06).samples_to(0.1) == pytest.approx(1 / 0.0064, abs=1)
    assert of_bias(0.1).samples_to(0.1) is None
    assert of_bias(0.0, variance=1e-9).samples_to(0.1) == 1
    assert of_bias(0.2).seconds_to(0.1) == math.inf
    few = of_bias(0.0)
    blocks = replace(few, settings=settings_for(few.settings, sampler="sobol"))
    assert (blocks.samples_to(0.5), blocks.samples_to(0.2)) == (16, 32)


# --- the choice ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", QUICK)
def test_the_choice_reaches_the_error_on_scenes_that_separate_methods(
    context: Context, name: str
) -> None:
    """The slow test that follows asks it of all of them."""
    scene = load(f"methods/{name}")
    assert Judge(scene, verdict_on(scene, 0.25, context), context).choice_reaches()


@pytest.mark.slow
@pytest.mark.parametrize("error", [0.5, 0.2])
@pytest.mark.parametrize("name", SCENES)
def test_no_cheaper_rung_reaches_the_error_on_scenes_that_separate_methods(
    context: Context, name: str, error: float
) -> None:
    scene = load(f"methods/{name}")
    judge = Judge(scene, verdict_on(scene, error, context), context)
    assert judge.choice_reaches()
    assert judge.cheaper_ones() == []


def test_the_judge_finds_what_is_cheaper_than_a_wasteful_choice(context: Context) -> None:
    scene = load("methods/diffuse")
    judge = Judge(scene, verdict_on(scene, 0.5, context), context)
    judge.best = candidate(judge.verdict, "naive")
    assert "mis" in " ".join(found.name for found in judge.cheaper_ones())


# --- words ---------------------------------------------------------------------------------


def test_advice_names_bounces_with_their_proof_and_every_method_with_its_reason(
    context: Context,
) -> None:
    scene = load("methods/glass")
    verdict = verdict_on(scene, 0.2, context)
    text = "\n".join(advice(scene, verdict))
    start = f"For an error of 20 % (relative RMS) by sampler {settings_for(scene.render).sampler}, "
    assert text.startswith(f"{start}measured on {SIZE} x {SIZE} pixels")
    assert text.count("the fewest that keep it below") == 1
    for words in ("whitted", "no indirect light", "glass is black", "light beyond"):
        assert words in text
    assert text.endswith(conclusion(verdict))
    assert conclusion(verdict).startswith("Enough: `")


def test_nothing_is_said_to_be_left_out_where_nothing_is(context: Context) -> None:
    sky = scene_of([], {}, background={"color": [1, 0.5, 0.2]})
    text = "\n".join(advice(sky, verdict_on(sky, 0.2, context)))
    assert "nothing was seen beyond 1 bounce" in text
    assert "light beyond" not in text
    cut = furnace()
    text = "\n".join(advice(cut, verdict_on(cut, 0.2, context)))
    assert "light beyond" in text


def test_an_error_beyond_reach_is_told(context: Context) -> None:
    verdict = verdict_on(furnace(), 0.02, context, bounces=1)
    assert verdict.best is None
    assert candidate(verdict, "mis").bias.value == pytest.approx(0.25, rel=0.05)
    assert re.fullmatch(
        r"Nothing reaches 2 %: `\w+` with 1 bounce misses the least, and that is \d\d %. Allow "
        "more bounces, or ask for a larger error.",
        conclusion(verdict),
    )


def test_a_bias_that_may_be_chance_is_told_as_noise() -> None:
    """1 % in the mean, with a standard error of 1 %, for an error of 0.9 %."""
    noisy = replace(of_bias(0.0), bias=Bias(0.01**2, 0.01**2))
    verdict = Verdict(0.009, Reference(np.ones((1, 1, 3)), np.ones((1, 1, 3)), 1, 1), (noisy,), {})
    assert verdict.best is None
    assert conclusion(verdict).startswith("Nothing is known to reach 0.9 %: what a measurement of")


def test_more_samples_than_a_picture_holds_are_not_enough() -> None:
    noisy = replace(of_bias(0.0), variance=2e6)
    verdict = Verdict(1.0, Reference(np.ones((1, 1, 3)), np.ones((1, 1, 3)), 1, 1), (noisy,), {})
    assert verdict.best is None
    assert conclusion(verdict) == (
        "Nothing reaches 100 %: `mis` would take 2,000,000 samples, and a picture holds 1,048,576. "
        "Ask for a larger error."
    )
    one = replace(verdict, candidates=(replace(noisy, variance=1.0, seconds_per_sample=1e-5),))
    assert "with 1 sample, in about 0.001 s at" in conclusion(one)


def test_inspect_and_auto_take_the_same_way(tmp_path: Path) -> None:
    size = ("--width", "16", "--height", "16")
    said = glrt("inspect", "methods/open", *size, "--error", "0.5").stdout.splitlines()
    assert said[-1].startswith("Enough: `")
    picture = tmp_path / "a.png"
    done = glrt(
        "render", "methods/open", "-o", picture, *size, "--method", "auto", "--error", "0.5"
    )
    assert done.returncode == 0
    measuring, told = done.stderr.splitlines()[:2]
    assert measuring == "Measuring which method suffices ..."
    assert told.startswith("Enough: `")
    chosen = told.split("`")[1]
    again = glrt("inspect", picture)
    assert f"method {chosen}," in again.stdout, "the recipe names the method that was chosen"


# --- time ----------------------------------------------------------------------------------


def verdict_within(seconds: float, context: Context, monkeypatch: pytest.MonkeyPatch) -> Verdict:
    clock = Clock()
    monkeypatch.setattr(search, "time", clock)
    monkeypatch.setattr(trial, "time", clock)
    return verdict_on(load("methods/glass"), 0.3, context, seconds=seconds)


def test_a_measurement_ends_with_its_time_and_tells_what_it_did_not_try(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The longer, the more methods; without one that is known to suffice there is no verdict."""
    whole = {c.name for c in verdict_on(load("methods/glass"), 0.3, context).candidates}
    tried = []
    for looks in (5, 80, 120, 160, 1e6):
        try:
            verdict = verdict_within(looks, context, monkeypatch)
        except OutOfTimeError:
            tried.append(0)
            continue
        names = {c.name for c in verdict.candidates}
        assert names.isdisjoint(verdict.untried)
        assert names.union(verdict.untried) == whole
        assert all(f"`{name}`" in conclusion(verdict) for name in verdict.untried)
        assert ("too short" in conclusion(verdict)) == bool(verdict.untried)
        assert verdict.best is not None
        tried.append(len(names))
    assert tried == sorted(tried)
    assert (tried[0], tried[-1]) == (0, len(whole))
    assert set(tried) - {0, len(whole)}, f"none of {tried} was cut short"


def test_auto_without_time_to_measure_renders_and_says_so(tmp_path: Path) -> None:
    """A second goes by before the first picture that could tell anything."""
    picture = tmp_path / "a.png"
    line = ("render", "methods/glass", "-o", picture, "--width", "16", "--height", "16")
    done = glrt(*line, "--method", "auto", "--error", "0.9", "--time", "0.001")
    assert "Not decided: half of --time is too short to measure. Taken: `mis` with" in done.stderr
    assert picture.exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["render", "sky", "-o", "a.png", "--method", "auto"], "give --error E"),
        (["inspect", "sky", "--error", "0"], "--error must be a number above 0"),
        (["inspect", "sky", "--error", "nan"], "--error must be a number above 0"),
        (["inspect", "sky", "--method", "auto"], "invalid choice"),
    ],
)
def test_a_bad_command_is_refused_in_a_paragraph(
    arguments: list[str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    assert message in capsys.readouterr().err


# --- twenty random scenes ------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_the_choice_is_right_in_nineteen_of_twenty_random_scenes(context: Context) -> None:
    wrong = []
    for seed in range(20):
        scene, error = random_scene(seed), (0.1, 0.2, 0.4)[seed % 3]
        judge = Judge(scene, verdict_on(scene, error, context), context)
        if not judge.choice_reaches() or judge.cheaper_ones():
            wrong.append((seed, judge.choice, judge.cheaper_ones()))
    assert len(wrong) <= 1, wrong


def test_the_reference_is_another_than_the_one_that_the_choice_was_made_by() -> None:
    assert not set(references.SEEDS) & set(trial.SEEDS)
