"""The method and bounces that reach an error, for `inspect --error` and `render --method auto`."""

import argparse
import math
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import NamedTuple

from glrt.analysis.chart.page import number, percent
from glrt.analysis.method_choice.candidate import Candidate
from glrt.analysis.method_choice.denoised import DenoisedChoice, denoised_choice
from glrt.analysis.method_choice.search import TIE, Question, Verdict, what_suffices
from glrt.analysis.method_choice.trial import LEADER, OutOfTimeError, Tell
from glrt.core.errors import UsageError
from glrt.gpu.context import open_context
from glrt.plan.facts import SceneFacts
from glrt.plan.methods import BIASED, METHODS
from glrt.plan.omissions import omissions
from glrt.rendering.stopping import Limits
from glrt.scene.scene import Scene
from glrt.settings import MAX_SAMPLES, Settings, settings_for

_DOUBT = ", which is not to be believed (few samples carry much of its light)"
_TITLE = "Measuring which method suffices ..."
SHARE = 0.5  # most time of the measurement, relative to what is left of `--time`
# The reasons for a decision, as recipes store them.
BY_WORK = "auto: counted work"
BY_WORK_IN_TIME = "auto: counted work, within half of --time"
FOR_LACK_OF_TIME = "auto: the default, since half of --time was too short"


class Choice(NamedTuple):
    """Settings and limits that were chosen for a render, and the reasons, by names of settings."""

    settings: Settings
    limits: Limits
    decisions: dict[str, str]


def advise(arguments: argparse.Namespace, scene: Scene, settings: Settings) -> None:
    """Measure and print what reaches `arguments.error`, with `arguments.bounces` if given."""
    asked = Question(arguments.error, methods=tuple(METHODS))
    verdict = _verdict(arguments, scene, settings, asked)
    print("\n" + "\n".join(advice(scene, verdict)), flush=True)
    if verdict.best:
        context = open_context(arguments.context)
        found = denoised_choice(scene, verdict.best, verdict.error, context)
        context.gl.release()
        if found:
            print(denoised_advice(verdict, found))


def denoised_advice(verdict: Verdict, found: DenoisedChoice) -> str:
    """A sentence about the denoised picture, for which fewer samples suffice."""
    best = verdict.best
    plain = (best and best.samples_to(verdict.error)) or 0
    (width, height), samples = found.size, _count(found.samples, "sample")
    return (
        f"Denoised by `{found.by}`, {samples} reach it, where plain pictures take {plain:,}: the "
        f"error of noise and filter is {percent(found.error)} on {width} x {height} pixels, below "
        f"{percent(found.high)} in 95 of 100 cases, and larger pictures have less. Add `--denoise "
        f"{found.by} --samples {found.samples}`."
    )


def choose(
    arguments: argparse.Namespace, scene: Scene, settings: Settings, limits: Limits
) -> Choice:
    """Return settings with the cheapest method that reaches the error, and limits for its render.

    No clock decides, unless there is a deadline. The limits reduce the error by the bias of the
    method, and set the first look at the estimated error to the number of samples that the
    measurement found necessary: the estimate is too low where few paths carry the light. If a
    deadline leaves no time to measure, the method is LEADER with the bounces of `settings`. Raises
    UsageError if `limits` has no error.
    """
    if limits.error is None:
        raise UsageError("--method auto chooses the method by the requested error: give --error E.")
    left = math.inf if limits.deadline is None else limits.deadline - time.perf_counter()
    try:
        verdict = _verdict(arguments, scene, settings, Question(limits.error, seconds=SHARE * left))
    except OutOfTimeError:
        settings = settings_for(settings, method=LEADER)
        _report(arguments, _undecided(settings))
        return Choice(settings, limits, {"method": FOR_LACK_OF_TIME})
    chosen = verdict.best or verdict.candidates[-1]
    noise = math.sqrt(max(limits.error**2 - chosen.bias.most**2, 0.0)) or limits.error
    first_look = max(limits.first_look, chosen.samples_to(limits.error) or 0)
    _report(arguments, conclusion(verdict, least_samples=first_look))
    limits = replace(limits, error=noise, first_look=first_look)
    decided = BY_WORK if limits.deadline is None else BY_WORK_IN_TIME
    names = ["method"] if _bounces_given(arguments) is not None else ["method", "bounces"]
    return Choice(chosen.settings, limits, dict.fromkeys(names, decided))


def _verdict(
    arguments: argparse.Namespace,
    scene: Scene,
    settings: Settings,
    asked: Question,
) -> Verdict:
    context = open_context(arguments.context)
    try:
        with steps(arguments, _TITLE) as report:
            asked = asked._replace(bounces=_bounces_given(arguments))
            return what_suffices(scene, settings, asked, context, report)
    finally:
        context.gl.release()


@contextmanager
def steps(arguments: argparse.Namespace, title: str) -> Iterator[Tell]:
    """Show the steps of a measurement on stderr: one line on a terminal, else the title."""
    if getattr(arguments, "quiet", False):
        yield lambda _step: None
        return
    if not sys.stderr.isatty():
        print(title, file=sys.stderr, flush=True)
        yield lambda _step: None
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=None)
        yield lambda step: bar.update(task, description=f"{title} {step}")


def _bounces_given(arguments: argparse.Namespace) -> int | None:
    bounces: int | None = getattr(arguments, "bounces", None)
    return bounces


def _report(arguments: argparse.Namespace, text: str) -> None:
    if not getattr(arguments, "quiet", False):
        print(text, file=sys.stderr, flush=True)


def _undecided(settings: Settings) -> str:
    return (
        f"Not decided: half of --time is too short to measure. Using `{settings.method}` with "
        f"{_count(settings.bounces, 'bounce')}. Give more --time, or choose --method yourself."
    )


def advice(scene: Scene, verdict: Verdict) -> Iterator[str]:
    """The lines of the advice: error by number of bounces, results by method, and conclusion."""
    height, width, _ = verdict.reference.radiance.shape
    sampler = verdict.candidates[0].settings.sampler
    yield (
        f"For an error of {percent(verdict.error)} (relative RMS) with sampler {sampler}, measured "
        f"on {width} x {height} pixels against a reference with an error of "
        f"{percent(verdict.reference.error)}{_DOUBT if verdict.reference.is_doubtful else ''}:"
    )
    yield ""
    yield "bounces  bias from longer paths"
    chosen = verdict.leader.settings.bounces
    for limit, bias in verdict.beyond.items():
        marks = ["the fewest below the error"] if limit == verdict.least_bounces else []
        marks += ["least work: what is left for noise takes fewer samples"] * (limit == chosen)
        yield f"{limit:>7}  {percent(bias.value):<8}  {'; '.join(marks)}".rstrip()
    yield ""
    width = max(len(candidate.name) for candidate in verdict.candidates)
    yield f"{'method':<{width}} bounces  bias     work"
    for candidate in verdict.candidates:
        yield _row(scene, verdict, candidate, width)
    yield ""
    yield (
        "Work is counted, by rays, those of probes too, shapes and lamps: 1 is that of the method "
        f"which takes least. `{LEADER}` is chosen if it takes at most {number(TIE)} times as much, "
        "since it leaves out the least light."
    )
    yield conclusion(verdict)


def conclusion(verdict: Verdict, least_samples: int = 1) -> str:
    """Which method to use, or why none is known to suffice, and methods that were not tried.

    `least_samples` are taken in any case.
    """
    found = _finding(verdict, least_samples)
    if verdict.impossible:
        found += f" The driver's loop limit rules out {_quoted(verdict.impossible)}."
    if verdict.untried:
        found += f" Half of --time was too short to try {_quoted(verdict.untried)}."
    return found


def _quoted(names: Sequence[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _finding(verdict: Verdict, least_samples: int) -> str:
    best = verdict.best
    if best is None:
        wanted = verdict.nearest.samples_to(verdict.error)
        if wanted is not None:
            return (
                f"No method reaches {percent(verdict.error)}: `{verdict.nearest.settings.method}` "
                f"needs {wanted:,} samples, and the limit is {MAX_SAMPLES:,}. Ask for a larger "
                "error."
            )
        least = min(verdict.candidates, key=lambda candidate: candidate.bias.value)
        if least.bias.least >= verdict.error:
            return (
                f"No method reaches {percent(verdict.error)}: the smallest bias is "
                f"{percent(least.bias.value)}, of `{least.settings.method}` with "
                f"{_count(least.settings.bounces, 'bounce')}. Allow more bounces, or ask for a "
                "larger error."
            )
        return (
            f"No method is known to reach {percent(verdict.error)}: the measurement, of some "
            "seconds, is too noisy to decide. Ask for a larger error."
        )
    settings, (width, height) = best.settings, best.settings.size
    needed, known = best.samples_to(verdict.error) or 0, settings.division.least_known
    samples = max(needed, least_samples, known)
    why = f" ({needed} would do, but {known} are the fewest with a known error)"
    return (
        f"Enough: `{settings.method}` with {_count(settings.bounces, 'bounce')} reaches "
        f"{percent(verdict.error)} with {_count(samples, 'sample')}"
        f"{why if needed < samples == known else ''}; about "
        f"{_seconds(best.seconds_of(samples))} s at {width} x {height}, as timed now."
    )


def _count(number: int, thing: str) -> str:
    return f"{number:,} {thing}{'' if number == 1 else 's'}"


def _seconds(value: float) -> str:
    """Seconds with three significant digits, at least 0.001."""
    return number(max(value, 0.001))


def _row(scene: Scene, verdict: Verdict, candidate: Candidate, width: int) -> str:
    settings = candidate.settings
    samples = candidate.samples_to(verdict.error)
    least = min(each.work_to(verdict.error) for each in verdict.candidates)
    work = number(candidate.work_to(verdict.error) / least) if samples else "never"
    bias = percent(candidate.bias.value)
    if settings.method in BIASED:
        missing = omissions(SceneFacts(scene), settings)
        reason = "; ".join(missing) if missing else "leaves out nothing in this scene"
    else:
        seen = "leaves out light" if candidate.bias.value > 0 else "no light detected"
        reason = f"{seen} beyond {_count(settings.bounces, 'bounce')}"
    return f"{candidate.name:<{width}} {settings.bounces:>7}  {bias:<8} {work:<8} {reason}"
