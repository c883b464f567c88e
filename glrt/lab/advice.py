"""What suffices for an error, in plain words: `inspect --error` and `render --method auto`."""

import argparse
import math
import sys
from collections.abc import Iterator
from dataclasses import replace

from glrt.context import open_context
from glrt.errors import UsageError
from glrt.job import Limits
from glrt.lab.chart_words import number, percent
from glrt.lab.suffices import Candidate, Verdict, what_suffices
from glrt.needs import LADDER
from glrt.omissions import omissions
from glrt.scene import Scene
from glrt.settings import Settings


def advise(arguments: argparse.Namespace, scene: Scene, settings: Settings) -> None:
    """Measure and print what `arguments.error` takes; bounces that were given stay."""
    print("\n" + "\n".join(advice(scene, _verdict(arguments, scene, settings, arguments.error))))


def choose(
    arguments: argparse.Namespace, scene: Scene, settings: Settings, limits: Limits
) -> tuple[Settings, Limits]:
    """Settings with the cheapest method that reaches the error, and limits that leave room for
    its bias. The samples that it is known to need come before its own estimate is believed, which
    is too low where few paths carry the light. Raises UsageError without an error.
    """
    if limits.error is None:
        raise UsageError("--method auto is chosen by the error that is asked for: give --error E.")
    verdict = _verdict(arguments, scene, settings, limits.error)
    if not arguments.quiet:
        print(conclusion(verdict), file=sys.stderr)
    chosen = verdict.best or verdict.candidates[-1]
    noise = math.sqrt(max(limits.error**2 - chosen.bias.most**2, 0.0)) or limits.error
    first_look = max(limits.first_look, chosen.samples_to(limits.error) or 0)
    return chosen.settings, replace(limits, error=noise, first_look=first_look)


def _verdict(
    arguments: argparse.Namespace, scene: Scene, settings: Settings, error: float
) -> Verdict:
    context = open_context(arguments.context)
    bounces = getattr(arguments, "bounces", None)
    verdict = what_suffices(scene, settings, error, context, bounces)
    context.gl.release()
    return verdict


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
    yield "method           bounces  bias     seconds"
    for candidate in verdict.candidates:
        yield _row(scene, verdict, candidate)
    yield ""
    yield conclusion(verdict)


def conclusion(verdict: Verdict) -> str:
    """One sentence: what to take, or that nothing is known to do."""
    best = verdict.best
    if best is None:
        return (
            f"Nothing is known to reach {percent(verdict.error)}: what a measurement of some "
            "seconds finds is too noisy. Ask for a larger error."
        )
    settings = best.settings
    plural = "" if settings.bounces == 1 else "s"
    return (
        f"Enough: `{settings.method}` with {settings.bounces} bounce{plural} reaches "
        f"{percent(verdict.error)} with {best.samples_to(verdict.error):,} samples, in about "
        f"{number(best.seconds_to(verdict.error))} s at {settings.width} x {settings.height}."
    )


def _row(scene: Scene, verdict: Verdict, candidate: Candidate) -> str:
    settings = candidate.settings
    samples = candidate.samples_to(verdict.error)
    seconds = number(candidate.seconds_to(verdict.error)) if samples else "never"
    bias = percent(candidate.bias.value)
    if settings.method in LADDER:
        missing = omissions(scene, settings)
        reason = "; ".join(missing) if missing else "leaves nothing out here"
    else:
        reason = f"light beyond {settings.bounces} bounces"
    return f"{candidate.name:<16} {settings.bounces:>7}  {bias:<8} {seconds:<8} {reason}"
