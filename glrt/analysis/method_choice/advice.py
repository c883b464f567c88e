"""What suffices for an error, in plain words: `inspect --error` and `render --method auto`."""

import argparse
import math
import sys
import time
from collections.abc import Iterator
from dataclasses import replace

from glrt.analysis.chart.words import number, percent
from glrt.analysis.method_choice.search import Verdict, what_suffices
from glrt.analysis.method_choice.trial import LEADER, Candidate, OutOfTimeError
from glrt.errors import UsageError
from glrt.gpu.context import open_context
from glrt.methods.omissions import omissions
from glrt.methods.table import CLASSIC
from glrt.rendering.stopping import Limits
from glrt.scene.scene import Scene
from glrt.settings import MAX_SAMPLES, Settings, settings_for

SHARE = 0.5  # of what is left of `--time`, at most, that the measurement takes


def advise(arguments: argparse.Namespace, scene: Scene, settings: Settings) -> None:
    """Measure and print what `arguments.error` takes; bounces that were given stay."""
    print("\n" + "\n".join(advice(scene, _verdict(arguments, scene, settings, arguments.error))))


def choose(
    arguments: argparse.Namespace, scene: Scene, settings: Settings, limits: Limits
) -> tuple[Settings, Limits]:
    """Settings with the cheapest method that reaches the error, and limits that leave room for
    its bias. The samples that it is known to need come before its own estimate is believed, which
    is too low where few paths carry the light. Where a deadline leaves no time to measure, LEADER
    with the bounces of `settings`. Raises UsageError without an error.
    """
    if limits.error is None:
        raise UsageError("--method auto is chosen by the error that is asked for: give --error E.")
    left = math.inf if limits.deadline is None else limits.deadline - time.perf_counter()
    try:
        verdict = _verdict(arguments, scene, settings, limits.error, SHARE * left)
    except OutOfTimeError:
        settings = settings_for(settings, method=LEADER)
        _tell(arguments, _undecided(settings))
        return settings, limits
    _tell(arguments, conclusion(verdict))
    chosen = verdict.best or verdict.candidates[-1]
    noise = math.sqrt(max(limits.error**2 - chosen.bias.most**2, 0.0)) or limits.error
    first_look = max(limits.first_look, chosen.samples_to(limits.error) or 0)
    return chosen.settings, replace(limits, error=noise, first_look=first_look)


def _verdict(
    arguments: argparse.Namespace,
    scene: Scene,
    settings: Settings,
    error: float,
    seconds: float = math.inf,
) -> Verdict:
    _tell(arguments, "Measuring which method suffices ...")
    context = open_context(arguments.context)
    bounces = getattr(arguments, "bounces", None)
    try:
        return what_suffices(scene, settings, error, context, bounces, seconds)
    finally:
        context.gl.release()


def _tell(arguments: argparse.Namespace, text: str) -> None:
    if not getattr(arguments, "quiet", False):
        print(text, file=sys.stderr, flush=True)


def _undecided(settings: Settings) -> str:
    return (
        f"Not decided: half of --time is too short to measure. Taken: `{settings.method}` with "
        f"{_count(settings.bounces, 'bounce')}. Give more --time, or choose --method yourself."
    )


def advice(scene: Scene, verdict: Verdict) -> Iterator[str]:
    """Lines: the bounces with their proof, every method with its reason, and what to take."""
    height, width, _ = verdict.reference.radiance.shape
    sampler = verdict.candidates[0].settings.sampler
    yield (
        f"For an error of {percent(verdict.error)} (relative RMS) by sampler {sampler}, measured "
        f"on {width} x {height} pixels against a reference with "
        f"{percent(verdict.reference.error)} of its own:"
    )
    yield ""
    yield "bounces  light of longer paths"
    for limit, bias in verdict.beyond.items():
        mark = "  the fewest that keep it below" if limit == verdict.least_bounces else ""
        yield f"{limit:>7}  {percent(bias.value):<8}{mark}".rstrip()
    yield ""
    width = max(len(candidate.name) for candidate in verdict.candidates)
    yield f"{'method':<{width}} bounces  bias     seconds"
    for candidate in verdict.candidates:
        yield _row(scene, verdict, candidate, width)
    yield ""
    yield conclusion(verdict)


def conclusion(verdict: Verdict) -> str:
    """What to take, or that nothing is known to do, and what was not tried for want of time."""
    found = _finding(verdict)
    if not verdict.untried:
        return found
    names = ", ".join(f"`{name}`" for name in verdict.untried)
    return f"{found} Half of --time was too short to try {names}."


def _finding(verdict: Verdict) -> str:
    best = verdict.best
    if best is None:
        wanted = verdict.nearest.samples_to(verdict.error)
        if wanted is not None:
            return (
                f"Nothing reaches {percent(verdict.error)}: `{verdict.nearest.settings.method}` "
                f"would take {wanted:,} samples, and a picture holds {MAX_SAMPLES:,}. Ask for a "
                "larger error."
            )
        least = min(verdict.candidates, key=lambda candidate: candidate.bias.value)
        if least.bias.least >= verdict.error:
            return (
                f"Nothing reaches {percent(verdict.error)}: `{least.settings.method}` with "
                f"{_count(least.settings.bounces, 'bounce')} misses the least, and that is "
                f"{percent(least.bias.value)}. Allow more bounces, or ask for a larger error."
            )
        return (
            f"Nothing is known to reach {percent(verdict.error)}: what a measurement of some "
            "seconds finds is too noisy. Ask for a larger error."
        )
    settings, (width, height) = best.settings, best.settings.size
    return (
        f"Enough: `{settings.method}` with {_count(settings.bounces, 'bounce')} reaches "
        f"{percent(verdict.error)} with {_count(best.samples_to(verdict.error) or 0, 'sample')}, "
        f"in about {_seconds(best.seconds_to(verdict.error))} s at {width} x {height}."
    )


def _count(number: int, thing: str) -> str:
    return f"{number:,} {thing}{'' if number == 1 else 's'}"


def _seconds(value: float) -> str:
    """Three digits; what is less than a millisecond is not worth telling apart."""
    return number(max(value, 0.001))


def _row(scene: Scene, verdict: Verdict, candidate: Candidate, width: int) -> str:
    settings = candidate.settings
    samples = candidate.samples_to(verdict.error)
    seconds = _seconds(candidate.seconds_to(verdict.error)) if samples else "never"
    bias = percent(candidate.bias.value)
    if settings.method in CLASSIC:
        missing = omissions(scene, settings)
        reason = "; ".join(missing) if missing else "leaves nothing out here"
    else:
        seen = "light" if candidate.bias.value > 0 else "nothing was seen"
        reason = f"{seen} beyond {_count(settings.bounces, 'bounce')}"
    return f"{candidate.name:<{width}} {settings.bounces:>7}  {bias:<8} {seconds:<8} {reason}"
