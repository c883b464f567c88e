"""`glrt inspect`: show what a scene needs."""

import argparse

from glrt.cli.options import SCENE, add_context, add_settings
from glrt.cli.request import check_limit, scene_and_settings
from glrt.methods.omissions import left_out, omissions

DESCRIPTION = (
    "Show what the kernel for a scene contains and leaves out, and why; with --error, measure the "
    "cheapest method and the fewest bounces that reach it."
)
EPILOG = ""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of the command."""
    parser.add_argument("scene", metavar="SCENE", help=SCENE)
    add_settings(parser)
    parser.add_argument(
        "--error",
        type=float,
        metavar="E",
        help="measure which method and how many bounces reach this relative RMS error",
    )
    add_context(parser)


def run(arguments: argparse.Namespace) -> int:
    """`glrt inspect`: what the kernel contains and leaves out."""
    from glrt.gpu.driver_checks import LLVMPIPE_ROUNDS
    from glrt.methods.features import explain, has_tree
    from glrt.rendering.schedule import iterations_per_sample
    from glrt.scene.limits import cautions

    scene, settings = scene_and_settings(arguments)
    print(f"{arguments.scene}: {scene.title or 'no title'}")
    print(f"method {settings.method}, {settings.bounces} bounces, {len(scene.objects)} objects\n")
    for feature in explain(scene, settings):
        print(f"{'in ' if feature.present else 'out'}  {feature.name:<15} {feature.reason}")
    if missing := omissions(scene, settings):
        print(f"\n{left_out(settings, missing)}")
    rounds = iterations_per_sample(scene, settings)
    print(
        f"\nA sample takes {'about' if has_tree(scene) else 'up to'} {rounds:,} loop iterations; "
        f"llvmpipe ends the loops of a dispatch after {LLVMPIPE_ROUNDS:,}."
    )
    for text in cautions(scene, settings):
        print(f"\ncaution: {text}")
    if arguments.error is not None:
        from glrt.analysis.method_choice.advice import advise

        check_limit("error", arguments.error)
        advise(arguments, scene, settings)
    return 0
