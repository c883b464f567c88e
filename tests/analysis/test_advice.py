"""`glrt inspect --error` reports its reasons, failed or untried ways, and what it refuses."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from glrt.analysis.method_choice import search, trial
from glrt.analysis.method_choice.advice import advice, conclusion
from glrt.analysis.method_choice.candidate import Bias
from glrt.analysis.method_choice.search import TIE, Verdict
from glrt.analysis.method_choice.trial import OutOfTimeError
from glrt.analysis.reference import Reference
from glrt.cli.main import main
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.settings import settings_for
from tests.support.builders import disk, lamp, scene_of, sphere
from tests.support.processes import glrt
from tests.support.verdicts import SIZE, Clock, candidate, furnace, of_bias, verdict_on

pytestmark = pytest.mark.usefixtures("small_and_cached")


# --- words ---------------------------------------------------------------------------------


@pytest.mark.slow
def test_advice_names_bounces_with_their_proof_and_every_method_with_its_reason(
    context: Context,
) -> None:
    scene = load("methods/glass")
    verdict = verdict_on(scene, 0.2, context)
    text = "\n".join(advice(scene, verdict))
    sampler = settings_for(scene.render).sampler
    start = f"For an error of 20 % (relative RMS) with sampler {sampler}, "
    assert text.startswith(f"{start}measured on {SIZE} x {SIZE} pixels")
    assert text.count("the fewest below the error") == 1
    for words in ("whitted", "no indirect light", "glass is black", "light beyond"):
        assert words in text
    assert text.endswith(conclusion(verdict))
    assert conclusion(verdict).startswith("Enough: `")


@pytest.mark.parametrize(("work", "chosen"), [(1.06, "mis"), (TIE + 0.01, "nee")])
def test_the_choice_follows_the_rule_for_ties_that_it_states(work: float, chosen: str) -> None:
    """`mis` may be chosen although another method takes less work."""
    scene, mis = furnace(), of_bias(0.0, work=work)
    settings = mis.settings.model_copy(update={"method": "nee"})
    nee = replace(mis, name="nee", settings=settings, work_per_sample=1.0)
    ones = np.ones((1, 1, 3))
    verdict = Verdict(0.02, Reference(ones, ones, 1, 1), (nee, mis), {})
    text = "\n".join(advice(scene, verdict))
    assert "`mis` is chosen if it takes at most 1.25 times as much" in text
    assert f"Enough: `{chosen}`" in text


@pytest.mark.parametrize(
    ("sampler", "error", "said"),
    [
        ("sobol", 0.5, "with 32 samples (16 would do, but 32 are the fewest with a known error);"),
        ("sobol", 0.1, "with 112 samples;"),
        ("independent", 0.9, "with 2 samples;"),
    ],
)
def test_the_samples_that_suffice_have_a_known_error(sampler: str, error: float, said: str) -> None:
    """`glrt render --samples N` with these many can say that the error is reached."""
    found = of_bias(0.0)
    found = replace(found, settings=settings_for(found.settings, sampler=sampler))
    ones = np.ones((1, 1, 3))
    assert said in conclusion(Verdict(error, Reference(ones, ones, 1, 1), (found,), {}))


def test_methods_beyond_the_loop_limit_are_named() -> None:
    ones = np.ones((1, 1, 3))
    verdict = Verdict(
        0.5, Reference(ones, ones, 1, 1), (of_bias(0.0),), {}, impossible=("whitted_tree", "ddgi")
    )
    assert conclusion(verdict).endswith("The driver's loop limit rules out `whitted_tree`, `ddgi`.")


@pytest.mark.slow
@pytest.mark.usefixtures("loop_limit")
def test_a_method_beyond_the_loop_limit_is_left_out(context: Context) -> None:
    """A ball of glass under 160 lamps: a tree of 256 paths has a shadow ray from each to each."""
    lamps = [disk([x, 3, z], [0, -1, 0], 0.05, "lamp") for x in range(-8, 8) for z in range(-8, 2)]
    glass = {"type": "dielectric", "ior": 1.5}
    objects = [sphere([0, 0, -3], 0.8, "glass"), *lamps]
    scene = scene_of(objects, {"glass": glass, "lamp": lamp()}, background={"color": [1, 1, 1]})
    verdict = verdict_on(scene, 0.5, context, bounces=8)
    assert verdict.impossible == ("whitted_tree",)
    assert candidate(verdict, "whitted")


@pytest.mark.slow
def test_nothing_is_said_to_be_left_out_where_nothing_is(context: Context) -> None:
    sky = scene_of([], {}, background={"color": [1, 0.5, 0.2]})
    text = "\n".join(advice(sky, verdict_on(sky, 0.2, context)))
    assert "no light detected beyond 1 bounce" in text
    assert "light beyond" not in text
    cut = furnace()
    text = "\n".join(advice(cut, verdict_on(cut, 0.2, context)))
    assert "light beyond" in text


@pytest.mark.slow
def test_an_error_beyond_reach_is_reported(context: Context) -> None:
    verdict = verdict_on(furnace(), 0.02, context, bounces=1)
    assert verdict.best is None
    assert candidate(verdict, "mis").bias.value == pytest.approx(0.25, rel=0.05)
    assert re.fullmatch(
        r"No method reaches 2 %: the smallest bias is \d\d %, of `\w+` with 1 bounce. Allow more "
        "bounces, or ask for a larger error.",
        conclusion(verdict),
    )


def test_a_bias_that_may_be_chance_is_reported_as_noise() -> None:
    """1 % in the mean, with a standard error of 1 %, for an error of 0.9 %."""
    noisy = replace(of_bias(0.0), bias=Bias(0.01**2, 0.01**2))
    verdict = Verdict(0.009, Reference(np.ones((1, 1, 3)), np.ones((1, 1, 3)), 1, 1), (noisy,), {})
    assert verdict.best is None
    assert conclusion(verdict).startswith("No method is known to reach 0.9 %: the measurement, of")


def test_more_samples_than_a_picture_holds_are_not_enough() -> None:
    noisy = replace(of_bias(0.0), variance=2e6)
    verdict = Verdict(1.0, Reference(np.ones((1, 1, 3)), np.ones((1, 1, 3)), 1, 1), (noisy,), {})
    assert verdict.best is None
    assert conclusion(verdict) == (
        "No method reaches 100 %: `mis` needs 2,000,000 samples, and the limit is 1,048,576. "
        "Ask for a larger error."
    )
    one = replace(verdict, candidates=(replace(noisy, variance=1.0, seconds_per_sample=1e-5),))
    known = "with 2 samples (1 would do, but 2 are the fewest with a known error); about 0.001 s at"
    assert known in conclusion(one)


@pytest.mark.larger
@pytest.mark.slow
def test_inspect_and_auto_take_the_same_way(tmp_path: Path) -> None:
    size = ("--width", "16", "--height", "16")
    said = glrt("inspect", "methods/open", *size, "--error", "0.5").stdout.splitlines()
    assert said[-1].startswith("Enough: `"), "no denoiser is worth it"
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


@pytest.mark.slow
def test_a_measurement_ends_with_its_time_and_reports_what_it_did_not_try(
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


@pytest.mark.slow
def test_auto_without_time_to_measure_renders_and_says_so(tmp_path: Path) -> None:
    """A second goes by before the first picture that could decide anything."""
    picture = tmp_path / "a.png"
    line = ("render", "methods/glass", "-o", picture, "--width", "16", "--height", "16")
    done = glrt(*line, "--method", "auto", "--error", "0.9", "--time", "0.001")
    assert "Not decided: half of --time is too short to measure. Using `mis` with" in done.stderr
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
