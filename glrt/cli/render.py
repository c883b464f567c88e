"""`glrt render`: render a scene to files, with figures and an exit code for scripts."""

import argparse
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from glrt.cli.autosave import Autosave
from glrt.cli.caustics import with_caustics
from glrt.cli.options import (
    SCENE,
    add_cluster,
    add_context,
    add_files,
    add_outputs,
    add_pipeline,
    add_progress,
    add_settings,
    add_summary,
    error_limit,
    is_automatic,
    once,
    settings_given,
)
from glrt.cli.reports.cluster_report import crew_of
from glrt.cli.reports.render_report import Done, Driver, Finished, report, unreached
from glrt.cli.reports.warnings import warn
from glrt.cli.request import Order, frame_of, is_in_bands, opened, order
from glrt.cli.sampler import BY_ERROR, kept, may_lengthen, sampler_to_error
from glrt.cluster.clusters import check_installed
from glrt.core.errors import RenderError, UsageError
from glrt.core.text import counted
from glrt.image.image import Image, check_writable
from glrt.image.partition import parse_part
from glrt.image.sources import check_not_scene, recipe_of
from glrt.plan.combinations import Way, check
from glrt.process import signals
from glrt.process.command import fail, since_start
from glrt.rendering.render_parts import render_parts
from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Interruption, Limits, first_look, render_to_limit
from glrt.scene.model_scene import is_model
from glrt.scene.studio import studio_note
from glrt.settings import settings_for

DESCRIPTION = "Render a scene to files, without a window."
EPILOG = (
    "The first limit reached of --samples, --time and --error ends the render; --time or "
    "--error without --samples raises the limit of samples to 1048576. Ctrl-C saves what was "
    "rendered; a long render saves every minute; --resume continues from its .exr. Exit codes: "
    "0 done, 1 --error not reached, 2 wrong usage or scene, 3 no usable OpenGL, 4 the render "
    "failed, 129, 130 and 143 interrupted."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument(
        "scene", metavar="SCENE", nargs="?", help=f"{SCENE}; optional with --resume"
    )
    add_outputs(parser)
    add_settings(parser, has_auto=True)
    parser.add_argument(
        "--time",
        type=float,
        metavar="SECONDS",
        help="stop after this process time",
    )
    parser.add_argument(
        "--error",
        type=error_limit,
        metavar="E",
        help="stop at this estimated relative RMS error (2%% or 0.02)",
    )
    parser.add_argument(
        "--part",
        type=_part,
        metavar="K/N",
        help="render the K-th of N parts of the samples, which `glrt merge` puts together",
    )
    parser.add_argument(
        "--frame",
        type=int,
        metavar="N",
        help="the frame of the scene's animation, from 0 (default: 0; of a model its pose without "
        "animation)",
    )
    add_cluster(parser)
    add_context(parser)
    add_pipeline(parser)
    add_files(parser)
    parser.add_argument(
        "--resume",
        metavar="FILE.exr",
        help="continue this picture, with its scene and settings, up to --samples in all",
    )
    add_summary(parser, "no progress and no summary")
    add_progress(parser)


def _part(text: str) -> tuple[int, int]:
    try:
        return parse_part(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


Watch = Callable[[Renderer], None]


def run(arguments: argparse.Namespace) -> int:
    """Render to files; the exit code is 1 if the picture does not reach `--error`."""
    try:
        return _run(arguments)
    except KeyboardInterrupt as error:
        return fail(signals.NOTHING, signals.exit_code_of(error))


def _run(arguments: argparse.Namespace) -> int:
    start = time.perf_counter()
    wanted = order(arguments)
    scene, settings = frame_of(wanted.scene, wanted.settings, arguments.frame)
    wanted = replace(wanted, scene=scene, settings=settings)
    if wanted.begun is not None and not arguments.quiet and (text := kept(arguments, settings)):
        print(text, file=sys.stderr, flush=True)
    load = time.perf_counter() - start
    arguments.outputs = once(arguments.outputs)
    for output in arguments.outputs:
        check_writable(output)
        if arguments.scene is not None:
            check_not_scene(output, arguments.scene)
    is_kept = any(name.lower().endswith(".exr") for name in arguments.outputs)
    if getattr(arguments, "aov", ()) and not is_kept:
        raise UsageError("--aov needs an .exr output: other files hold the picture alone.")
    if is_in_bands(arguments):
        check_installed()
    if is_automatic(arguments):
        check({Way.AUTO} | ({Way.SHUTTER} if wanted.scene.is_blurred else set()))
        from glrt.analysis.method_choice.advice import choose

        chosen = choose(arguments, wanted.scene, wanted.settings, wanted.limits)
        wanted = replace(wanted, **chosen._asdict())
    wanted = with_caustics(arguments, wanted)
    if is_in_bands(arguments) and wanted.settings.caustics == "on":
        raise UsageError(
            "--caustics auto chose particles, and each worker of --cluster would follow all of "
            "them again. Give --caustics off, or leave out --cluster."
        )
    is_own = arguments.scene is not None and is_model(Path(arguments.scene))
    if is_own and not arguments.quiet and (note := studio_note(wanted.scene)):
        print(note, file=sys.stderr)
    warn(wanted.scene, wanted.settings, settings_given(arguments), arguments.quiet)
    make = _render_in_bands if is_in_bands(arguments) else _render
    with Interruption().watched() as interruption:
        return make(arguments, wanted, interruption, load)


def _render(
    arguments: argparse.Namespace, wanted: Order, interruption: Interruption, load: float
) -> int:
    limits = wanted.limits
    renderer, autosave = opened(wanted, arguments), Autosave(arguments.outputs)
    begun = renderer.samples
    setup = since_start() - renderer.seconds["compile"]
    start = time.perf_counter()
    with _watch(arguments, limits, autosave, begun) as watch:
        try:
            longer = _lengthened(arguments, wanted, renderer, interruption, watch)
            start += longer.seconds["compile"] if longer is not renderer else 0.0
            renderer = longer
            image = _picture(renderer, wanted, interruption, watch)
        except RenderError as error:
            raise RenderError(f"{error} {autosave.advice}".strip()) from error
    seconds = {
        "setup": setup,
        "load": load,
        **renderer.seconds,
        "render": time.perf_counter() - start,
    }
    if image is None:
        return fail(signals.NOTHING, _signal_code(interruption))
    estimate = image.error_to_reach
    autosave.keep(image)
    report(arguments, Done(renderer, image, begun, seconds))
    if interruption.signal is not None:
        text = f"interrupted after {image.samples} samples, which are saved"
        return fail(text, _signal_code(interruption))
    if limits.error is not None and (estimate is None or estimate > limits.error):
        counts = image.samples, renderer.settings.division.least_known
        return fail(unreached(arguments.error, limits.error, estimate, *counts), 1)
    return 0


def _lengthened(
    arguments: argparse.Namespace,
    wanted: Order,
    renderer: Renderer,
    interruption: Interruption,
    watch: Watch,
) -> Renderer:
    """Return a renderer with longer blocks if `--error` takes many samples, else the same.

    The same renderer goes on from the samples of the first look; another begins again.
    """
    limits, settings = wanted.limits, renderer.settings
    is_new = wanted.begun is None and recipe_of(arguments.scene) is None
    if limits.error is None or not is_new or not may_lengthen(arguments, settings):
        return renderer
    first = replace(limits, samples=first_look(limits, 0))
    image = render_to_limit(renderer, first, interruption, watch)
    if image is None or interruption.signal is not None:
        return renderer
    sampler = sampler_to_error(image, limits.error, limits.samples)
    if sampler == settings.sampler:
        return renderer
    renderer.release()
    decisions = {**wanted.decisions, "sampler": BY_ERROR}
    longer = replace(wanted, settings=settings_for(settings, sampler=sampler), decisions=decisions)
    return opened(longer, arguments)


def _render_in_bands(
    arguments: argparse.Namespace, wanted: Order, interruption: Interruption, load: float
) -> int:
    """Render by the workers of `--cluster`."""
    from glrt.cluster.bands import PictureJob, render_bands
    from glrt.cluster.kept_bands import KeptBands

    kept = KeptBands(Path(arguments.outputs[0]))
    start, setup = time.perf_counter(), since_start()
    how = arguments.context, arguments.pipeline, wanted.decisions
    with crew_of(arguments, interruption, "band") as crew:
        done = render_bands(crew, PictureJob(wanted.scene, wanted.settings, *how), kept)
    if done is None:
        stand = f"interrupted: {kept.folder} holds {counted(kept.count, 'band')}"
        text = f"{stand}, and the same command continues" if kept.count else signals.NOTHING
        return fail(text, _signal_code(interruption))
    image, route = done
    assert image.recipe
    seconds = {"setup": setup, "load": load, "render": time.perf_counter() - start}
    driver = Driver(image.recipe.renderer, route)
    finished = Finished(wanted.scene, image.recipe.settings, image.recipe.pipeline, driver)
    Autosave(arguments.outputs).keep(image)
    kept.remove()
    report(arguments, Done(finished, image, 0, seconds))
    return 0


def _picture(
    renderer: Renderer, wanted: Order, interruption: Interruption, watch: Watch
) -> Image | None:
    """Render in one piece, or in parts that are merged; None if interrupted before a picture."""
    if wanted.merged:
        return render_parts(renderer, wanted.merged, interruption, watch)
    return render_to_limit(renderer, wanted.limits, interruption, watch)


def _signal_code(interruption: Interruption) -> int:
    return signals.INTERRUPTED + (interruption.signal or 0)


@contextmanager
def _watch(
    arguments: argparse.Namespace, limits: Limits, autosave: Autosave, begun: int
) -> Iterator[Watch]:
    """Yield a function to call after each dispatch: it saves, and shows progress on a terminal."""
    is_seen = not arguments.quiet and sys.stderr.isatty()
    if not (arguments.progress or is_seen):
        yield autosave.after
        return
    from glrt.cli.reports.progress import progress_bar, progress_lines

    shown = progress_lines if arguments.progress else progress_bar
    with shown(limits, begun) as show:

        def watch(renderer: Renderer) -> None:
            show(renderer)
            autosave.after(renderer)

        yield watch
