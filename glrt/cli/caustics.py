"""`--caustics auto`: measure in a short pilot whether particles from lamps pay off."""

import argparse
import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from glrt.cli.options import AUTO, is_automatic
from glrt.cli.request import Order
from glrt.gpu.context import open_context
from glrt.image.sources import recipe_of
from glrt.plan.combinations import Way, ways_of
from glrt.rendering.pipelines import resolve

if TYPE_CHECKING:
    from glrt.analysis.method_choice.caustics import Finding

SHORT = 30.0  # seconds: of a shorter `--time`, a pilot would take too large a share
WITHOUT = {Way.TERMS, Way.ADAPTIVE}  # options that particles do not go with
MANY = 100  # times as efficient: the message reports no larger gain


def with_caustics(arguments: argparse.Namespace, wanted: Order) -> Order:
    """Return the order, with particles if a pilot finds that they pay off.

    Rendering a picture again keeps its own choice. The finding is reported on stderr.
    """
    if wanted.begun is not None and not arguments.quiet and (text := kept(arguments, wanted)):
        print(text, file=sys.stderr, flush=True)
    if not _is_open(arguments, wanted):
        return wanted
    from glrt.analysis.method_choice.caustics import CHOICES

    given = {name: value for name, value in vars(arguments).items() if name in CHOICES[0]}
    found = _finding(arguments, wanted, given)
    if found is None:
        return wanted
    if not arguments.quiet:
        print(told(found), file=sys.stderr, flush=True)
    decisions = {**wanted.decisions, **found.decisions(given)}
    return replace(wanted, settings=found.settings, decisions=decisions)


def kept(arguments: argparse.Namespace, wanted: Order) -> str:
    """Return a sentence if a picture goes on with a choice that one render might not take."""
    if getattr(arguments, "caustics", AUTO) != AUTO or wanted.begun is None:
        return ""
    from glrt.analysis.method_choice.caustics import may_differ

    if not may_differ(wanted.scene, wanted.settings, wanted.begun.samples):
        return ""
    return (
        f"Rendering with --caustics {wanted.settings.caustics}, as the picture began. One render "
        f"of {wanted.settings.samples} samples may choose otherwise, and have other bits."
    )


def _is_open(arguments: argparse.Namespace, wanted: Order) -> bool:
    """Whether the command line leaves the choice open, and the render is new and not short."""
    is_asked = getattr(arguments, "caustics", AUTO) == AUTO and not is_automatic(arguments)
    is_new = wanted.begun is None and recipe_of(arguments.scene) is None
    is_short = arguments.time is not None and arguments.time < SHORT
    fits = arguments.pipeline != "fragment" and not WITHOUT & ways_of(wanted.settings)
    return is_asked and is_new and not is_short and fits


def _finding(
    arguments: argparse.Namespace, wanted: Order, given: dict[str, Any]
) -> "Finding | None":
    """Run a pilot and return its finding; None if particles cannot be traced, or cannot help."""
    from glrt.analysis.method_choice.caustics import may_gain, particles_worth

    scene, settings = wanted.scene, wanted.settings
    if not may_gain(scene, settings):
        return None
    context = open_context(arguments.context, arguments.pipeline)
    try:
        if resolve(arguments.pipeline, context) == "fragment":
            return None
        return particles_worth(scene, settings, context, given, wanted.limits.error)
    finally:
        context.gl.release()


def told(found: "Finding") -> str:
    """Return a sentence on what a pilot chose, and why."""
    from glrt.analysis.method_choice.caustics import CHOICES

    times = f"about {found.gain:.2g} times" if found.gain < MANY else f"over {MANY} times"
    if found.settings.caustics == "off":
        return f"Rendering with --caustics off: particles would be {times} as efficient."
    chosen = " ".join(f"--{name} {getattr(found.settings, name):g}" for name in CHOICES[0])
    return (
        f"Rendering with --caustics on {chosen}: {times} as efficient as without, by a short pilot."
    )
