"""`glrt inspect --error`: the method and the bounces that it names suffice, and no cheaper do."""

import math
from dataclasses import replace

import numpy as np
import pytest

from glrt.analysis import reference as references
from glrt.analysis.method_choice import search, trial
from glrt.analysis.method_choice.advice import conclusion
from glrt.analysis.method_choice.search import Question, what_suffices
from glrt.core.resources import folder
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.plan.methods import CLASSIC
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.support.builders import MATTE, lamp, plane, scene_of, sphere
from tests.support.method_judge import Judge, random_scene
from tests.support.renders import rendered
from tests.support.verdicts import SIZE, Clock, candidate, furnace, of_bias, verdict_on

pytestmark = pytest.mark.usefixtures("small_and_cached")
WITH_MEDIA = {"foggy", "smoky"}  # whose references take minutes
SCENES = sorted({file.stem for file in (folder("scenes") / "methods").glob("*.toml")} - WITH_MEDIA)
QUICK = ["diffuse", "glass", "open"]  # of these, whose references are cheap


# --- bounces -------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_light_of_longer_paths_is_the_closed_form(context: Context) -> None:
    verdict = verdict_on(furnace(), 0.02, context)
    for limit, bias in verdict.beyond.items():
        if limit <= 6:
            truth = 0.25 ** (limit + 1) / 1.01
            assert bias.squared == pytest.approx(truth, rel=0.03, abs=4 * bias.stderr), limit
            assert bias.stderr < 0.2 * truth
    assert verdict.least_bounces == 5  # 0.5^6 = 1.6 %


@pytest.mark.slow
def test_a_limit_that_is_given_is_kept(context: Context) -> None:
    verdict = verdict_on(furnace(), 0.3, context, bounces=2)
    assert list(verdict.beyond) == [2]
    assert verdict.best is not None
    assert {candidate.settings.bounces for candidate in verdict.candidates} == {2}


@pytest.mark.slow
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


@pytest.mark.slow
@pytest.mark.parametrize(
    ("crop", "mean"), [((0, 0, 40, 10), 0.0), ((0, 30, 40, 10), 1.0), ((3, 31, 2, 1), 1.0)]
)
def test_what_is_measured_of_a_crop_is_the_crop(
    context: Context, crop: tuple[int, int, int, int], mean: float
) -> None:
    """In a frame where it has about as many pixels as a whole one has; the time is its own."""
    wanted = settings_for(half_lit().render, width=40, height=40, crop=crop)
    verdict = what_suffices(half_lit(), wanted, Question(0.5), context)
    assert np.unique(verdict.reference.radiance) == mean
    rows, columns, _ = verdict.reference.radiance.shape
    assert rows * columns == pytest.approx(SIZE**2, rel=0.25)
    assert columns / rows == pytest.approx(crop[2] / crop[3], rel=0.25)
    found = candidate(verdict, "mis")
    assert found.settings.crop == crop
    assert f"at {crop[2]} x {crop[3]}, as" in conclusion(verdict)


@pytest.mark.slow
def test_the_time_of_a_crop_is_its_share_of_the_frame(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The clock goes on by one at each look: all pictures take the same time."""
    monkeypatch.setattr(trial, "time", Clock())
    monkeypatch.setattr(search, "time", Clock())
    scene = furnace()
    whole = settings_for(scene.render, width=64, height=64)
    part = settings_for(whole, crop=(8, 8, 16, 16))
    seconds = [
        candidate(what_suffices(scene, wanted, Question(0.5), context), "mis").seconds_per_sample
        for wanted in (whole, part)
    ]
    assert seconds[1] == pytest.approx(seconds[0] / 16, rel=0.5)


# --- biases --------------------------------------------------------------------------------


@pytest.mark.slow
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


@pytest.mark.slow
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


def test_samples_make_up_for_the_bias() -> None:
    assert of_bias(0.0).samples_to(0.1) == pytest.approx(100, abs=1)
    assert of_bias(0.06).samples_to(0.1) == pytest.approx(1 / 0.0064, abs=1)
    assert of_bias(0.1).samples_to(0.1) is None
    assert of_bias(0.0, variance=1e-9).samples_to(0.1) == 1
    assert of_bias(0.2).work_to(0.1) == math.inf
    few = of_bias(0.0)
    blocks = replace(few, settings=settings_for(few.settings, sampler="sobol"))
    assert (blocks.samples_to(0.5), blocks.samples_to(0.2)) == (16, 32)


# --- the choice ----------------------------------------------------------------------------


@pytest.mark.slow_cases("diffuse")
@pytest.mark.slow_cases("glass")
@pytest.mark.parametrize("name", QUICK)
def test_the_choice_reaches_the_error_on_scenes_that_separate_methods(
    context: Context, name: str
) -> None:
    """The slow test that follows asks it of all of them."""
    scene = load(f"methods/{name}")
    assert Judge(scene, verdict_on(scene, 0.25, context), context).choice_reaches()


@pytest.mark.larger
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


@pytest.mark.slow
def test_the_judge_finds_what_is_cheaper_than_a_wasteful_choice(context: Context) -> None:
    scene = load("methods/diffuse")
    judge = Judge(scene, verdict_on(scene, 0.5, context), context)
    judge.best = candidate(judge.verdict, "naive")
    assert "mis" in " ".join(found.name for found in judge.cheaper_ones())


# --- twenty random scenes ------------------------------------------------------------------


@pytest.mark.larger
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
