"""`glrt inspect`: show what a scene holds and what its kernel contains."""

import argparse
from collections.abc import Iterator

from glrt.cli.options import (
    SCENE,
    add_context,
    add_files,
    add_pipeline,
    add_settings,
    error_limit,
    settings_given,
)
from glrt.cli.request import check_limit, open_renderer, scene_and_settings
from glrt.cli.simplify import add_simplify, check_simplify, simplify
from glrt.core.errors import UsageError
from glrt.core.text import counted
from glrt.image.sources import recipe_of, shown
from glrt.plan.explanation import Feature, explain
from glrt.plan.idle_settings import idle
from glrt.plan.omissions import left_out, omissions
from glrt.plan.plan import prepare
from glrt.plan.slow_scenes import slow_because
from glrt.scene.scene import Scene
from glrt.scene.summary import summary
from glrt.scene.warnings import cautions
from glrt.settings import Settings, settings_for

DESCRIPTION = (
    "Show what a scene holds, and what the kernel for it contains and leaves out, and why; with "
    "--error, measure the cheapest method and the fewest bounces that reach it; with --simplify "
    "too, what the scene can do without."
)
EPILOG = (
    "Exit codes: 0 done, also where nothing can go, 1 a file could not be written, 2 wrong usage "
    "or scene."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument("scene", metavar="SCENE", help=SCENE)
    add_settings(parser)
    parser.add_argument(
        "--error",
        type=error_limit,
        metavar="E",
        help="measure which method and how many bounces reach this relative RMS error (2%% or "
        "0.02)",
    )
    parser.add_argument(
        "--kernel",
        action="store_true",
        help="print the shader that the driver gets for this scene, and nothing else",
    )
    parser.add_argument(
        "--all",
        action="store_true",
        help="list the features that the kernel leaves out too, each with its reason; with "
        "--simplify: name all that can go",
    )
    add_simplify(parser)
    add_context(parser)
    add_pipeline(parser)
    add_files(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the features or the text of the kernel, and what reaches an error; return 0.

    With --simplify: print what can go from the scene instead.
    """
    check_simplify(arguments)
    if arguments.pipeline != "auto" and not arguments.kernel:
        raise UsageError("--pipeline chooses the kernel that --kernel prints: give both.")
    scene, settings = scene_and_settings(arguments)
    if arguments.kernel:
        print(_kernel(arguments, scene, settings), end="")
        return 0
    if arguments.error is not None:
        check_limit("error", arguments.error)
    equal = settings_for(settings, adaptive="off")  # what is measured has equal counts
    if arguments.simplify:
        simplify(arguments, scene, equal)
        return 0
    _explain(arguments.scene, scene, settings, arguments.all)
    for text in idle(settings, settings_given(arguments)):
        print(f"\ncaution: {text}")
    if arguments.error is not None:
        from glrt.analysis.method_choice.advice import advise

        advise(arguments, scene, equal)
    return 0


def _explain(name: str, scene: Scene, settings: Settings, is_whole: bool) -> None:
    from glrt.gpu.driver_checks import LLVMPIPE_ROUNDS
    from glrt.rendering.schedule import iterations_per_sample

    print(f"{shown(name)}: {scene.title or 'no title'}")
    count, bounces = counted(len(scene.objects), "object"), counted(settings.bounces, "bounce")
    print(f"method {settings.method}, {bounces}, {count}\n")
    print("\n".join(summary(scene)) + "\n")
    plan = prepare(scene, settings)
    print("\n".join(_features(explain(plan), is_whole)))
    if missing := omissions(plan.facts, settings):
        print(f"\n{left_out(settings, missing)}")
    rounds = iterations_per_sample(plan)
    most = "about" if plan.facts.has_trees else "up to"
    print(
        f"\nA sample takes {most} {rounds:,} loop iterations; "
        f"llvmpipe in Mesa 22 ends the loops of a dispatch after {LLVMPIPE_ROUNDS:,}; "
        "`glrt doctor` measures this machine's limit."
    )
    for text in cautions(scene, settings):
        print(f"\ncaution: {text}")
    for text in slow_because(plan.facts, settings):
        print(f"\nslow: {text}")


def _features(found: list[Feature], is_whole: bool) -> Iterator[str]:
    """Yield a line for each feature of the kernel, then those left out: lines, or a paragraph."""
    width = max(len(it.name) for it in found if it.present or is_whole)
    for feature in found:
        if feature.present:
            yield f"in   {feature.name:<{width}}  {feature.reason}"
    out = [it for it in found if not it.present]
    if is_whole:
        yield from (f"out  {it.name:<{width}}  {it.reason}" for it in out)
    elif out:
        names = ", ".join(it.name for it in out)
        yield f"\nThe kernel leaves out {names} (--all gives the reasons)."


def _kernel(arguments: argparse.Namespace, scene: Scene, settings: Settings) -> str:
    """Return the shader that traces paths, as `glrt render` gives it to the driver."""
    from glrt.gpu.context import open_context

    context = open_context(arguments.context, arguments.pipeline)
    try:
        recipe, pipeline = recipe_of(arguments.scene), arguments.pipeline
        renderer = open_renderer(
            scene, settings, recipe, context, tier="complete", pipeline=pipeline
        )
        text = renderer.shaders[-1].live.text
        renderer.release()
        return text
    finally:
        context.gl.release()
