"""`glrt film`: render a series of pictures: an animation, a turntable, or a sweep of values."""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from glrt.cli.caustics import with_caustics
from glrt.cli.film_jobs import EXPORTS, job
from glrt.cli.options import (
    SCENE,
    add_cluster,
    add_context,
    add_files,
    add_pipeline,
    add_progress,
    add_settings,
    add_summary,
    error_limit,
    is_automatic,
)
from glrt.cli.reports.cluster_report import crew_of
from glrt.cli.reports.film_report import Reporter, named, warn_of
from glrt.cli.request import Order, order
from glrt.cluster.clusters import check_installed
from glrt.core.errors import RenderError, UsageError
from glrt.core.text import counted
from glrt.image.sources import STANDARD_INPUT, check_not_scene, shown
from glrt.process import signals
from glrt.process.command import fail
from glrt.rendering.stopping import Interruption, Limits
from glrt.series.containers import check_container
from glrt.series.film import Film
from glrt.series.outputs import parse_output
from glrt.series.rendering import Frame, RenderOptions
from glrt.series.series import Series, chosen
from glrt.series.sheet import check_sheet
from glrt.series.sweeps import parse_sweep

DESCRIPTION = "Render a series of pictures: the scene's animation, a turntable, or a sweep."
EPILOG = (
    "Complete frames of an earlier run are kept if scene, settings and limits are the same. Exit "
    "codes: 0 done, 1 a frame did not reach --error, 2 wrong usage or scene, 3 no usable OpenGL, 4 "
    "frames failed and the others are kept, 129, 130 and 143 interrupted; the same command then "
    "continues."
)
MOST_SWEEPS = 2  # rows and columns of a sheet
MOST_FPS = 1000
_OF_PARTICLES = ("caustics", "particles", "aimed", "linked")  # settings that a pilot chooses


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument("scene", metavar="SCENE", help=SCENE)
    parser.add_argument(
        "-o",
        dest="output",
        metavar="FILE",
        required=True,
        help="a film in .webp, .gif or .mp4; a sheet of all frames in .png; or a file for each "
        "frame, such as frames/%%04d.exr, frames/%%04d.png or frames/####.exr",
    )
    _add_frames(parser)
    _add_jobs(parser)
    add_settings(parser, has_auto=True)
    parser.add_argument(
        "--time", type=float, metavar="SECONDS", help="stop each frame after this time"
    )
    parser.add_argument(
        "--error",
        type=error_limit,
        metavar="E",
        help="stop each frame at this estimated relative RMS error (2%% or 0.02)",
    )
    add_cluster(parser)
    add_context(parser)
    add_pipeline(parser)
    add_files(parser)
    add_summary(parser, "no progress and no summary")
    add_progress(parser)
    parser.set_defaults(resume=None, part=None, frame=None)


def _add_frames(parser: argparse.ArgumentParser) -> None:
    """Add the options that say which frames there are."""
    group = parser.add_argument_group("frames")
    group.add_argument(
        "--frames",
        type=_frames,
        metavar="A-B",
        help="first and last frame to render, from 0 (default: all)",
    )
    group.add_argument(
        "--turntable",
        type=_whole,
        metavar="N",
        help="N frames of a camera that turns once around the point it looks at, about its axis up",
    )
    group.add_argument(
        "--sweep",
        dest="sweeps",
        action="append",
        default=[],
        type=_swept,
        metavar="KEY=FROM:TO:N",
        help="N frames in which a value goes from one number to another, as "
        "materials.ball.roughness=0:1:5, camera.fov=20:80:7 or render.bounces=1:8:8; given twice: "
        "rows and columns of a sheet",
    )
    group.add_argument(
        "--fps",
        type=float,
        metavar="X",
        help="frames a second at which the film plays (default: those of the animation, or 24)",
    )
    group.add_argument(
        "--vary-seed",
        action="store_true",
        help="another seed for each frame: noise flickers, instead of standing still",
    )
    group.add_argument(
        "--keep-frames",
        action="store_true",
        help="keep the frames of a film or a sheet, which lie in FILE.frames",
    )


def _add_jobs(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("jobs of render farms")
    group.add_argument(
        "--export",
        choices=EXPORTS,
        help="print the job that renders the frames, and render nothing: a shell script, the "
        "commands of OpenCue's cuecmd, or a template of Open Job Description",
    )
    group.add_argument(
        "--chunk",
        type=_whole,
        default=1,
        metavar="N",
        help="frames of each task of a job (default: %(default)s)",
    )


def _frames(text: str) -> tuple[int, int]:
    first, _, last = text.partition("-")
    try:
        found = int(first), int(last or first)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not A-B, such as 0-47") from None
    if not 0 <= found[0] <= found[1]:
        raise argparse.ArgumentTypeError(f"{text!r}: the first frame must not be after the last")
    return found


def _whole(text: str) -> int:
    if not text.isdecimal() or not int(text):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of frames, 1 or more")
    return int(text)


def _swept(text: str) -> Any:
    try:
        return parse_sweep(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def run(arguments: argparse.Namespace) -> int:
    """Render a film; the exit code is 1 if a frame did not reach `--error`, 4 if some failed."""
    film = _film(arguments)
    if arguments.export:
        print(job(arguments.export, arguments.words, film.numbers, arguments.chunk), end="")
        return 0
    film.output.check(film.numbers.start)
    with film.locked():
        film = _with_caustics(arguments, film)
        warn_of(arguments, film)
        return _rendered(arguments, film)


def _rendered(arguments: argparse.Namespace, film: Film) -> int:
    """Render the frames and write the film; returns the exit code."""
    reporter = Reporter(arguments, film)
    with Interruption().watched() as interruption:
        with _frames_of(arguments, film, reporter, interruption) as frames:
            for frame in frames:
                reporter.report(frame)
        if interruption.signal is not None:
            done = f"{len(film.complete)} of {counted(len(film.numbers), 'frame')}"
            text = f"interrupted; {done} are done: the same command continues"
            return fail(text, signals.INTERRUPTED + interruption.signal)
    if film.failed:
        text = f"{named(film.failed)} failed; the others are kept in {film.output.folder}"
        return fail(text, RenderError.exit_code)
    film.write(arguments.keep_frames)
    reporter.summarize()
    if film.missed:
        text = f"--error {arguments.error:g} was not reached by {named(film.missed)}"
        return fail(f"{text}. The film is saved; give more --samples or --time.", 1)
    return 0


@contextmanager
def _frames_of(
    arguments: argparse.Namespace, film: Film, reporter: Reporter, interruption: Interruption
) -> Iterator[Iterator[Frame]]:
    """Yield the frames of a film, rendered here or by the workers of `--cluster`."""
    if arguments.cluster is None:
        with reporter.watching() as watch:
            yield film.render(interruption, watch)
        return
    from glrt.cluster.films import render_frames_on

    with crew_of(arguments, interruption, "frame") as crew:
        rest = film.series, film.numbers, film.output, film.options
        yield film.taken(render_frames_on(crew, *rest))


def _film(arguments: argparse.Namespace) -> Film:
    _check(arguments)
    output = parse_output(arguments.output)
    check_container(output.path)
    check_not_scene(output.path, arguments.scene)
    wanted = order(arguments)
    if not (wanted.scene.animation or arguments.turntable or arguments.sweeps):
        raise UsageError(
            f"{shown(arguments.scene)} has no [animation], so it has one frame: give --turntable N "
            "or --sweep KEY=FROM:TO:N."
        )
    if wanted.settings.adaptive == "on":
        raise UsageError(
            "glrt film and --adaptive on do not go together: frames are proven with equal counts "
            "of samples alone. Give --adaptive off."
        )
    series = Series(
        *(wanted.scene, wanted.settings, arguments.turntable, tuple(arguments.sweeps)),
        varies_seed=arguments.vary_seed,
    )
    numbers = chosen(series.count, arguments.frames)
    if output.kind == "sheet":
        check_sheet(series, len(numbers))
    series.check()
    limits = arguments.time, arguments.error
    ways = arguments.context, arguments.pipeline
    options = RenderOptions(*limits, *ways, wanted.decisions)
    return Film(series, numbers, output, options, arguments.fps)


def _with_caustics(arguments: argparse.Namespace, film: Film) -> Film:
    """Return the film, with particles if a pilot of its first frame finds that they pay off."""
    series, first = film.series, film.series.still(0)
    limits, decisions = Limits(0, error=arguments.error), film.options.decisions
    start = Order(first.scene, first.settings, limits, decisions=decisions)
    wanted = with_caustics(arguments, start)
    particles = {name: getattr(wanted.settings, name) for name in _OF_PARTICLES}
    film.series = replace(series, settings=series.settings.model_copy(update=particles))
    film.options = replace(film.options, decisions=wanted.decisions)
    return film


def _check(arguments: argparse.Namespace) -> None:
    """Raise `UsageError` for options that do not go together, or are out of range."""
    if is_automatic(arguments):
        raise UsageError(
            "--method auto measures a single picture. Find a method for the film by `glrt inspect "
            "SCENE --error E`, and give it by --method."
        )
    if arguments.turntable and arguments.sweeps:
        raise UsageError("--turntable and --sweep do not go together: render one of them.")
    if len(arguments.sweeps) > MOST_SWEEPS:
        raise UsageError("--sweep can be given twice: rows and columns of a sheet.")
    if arguments.cluster:
        if arguments.export:
            raise UsageError("--export and --cluster do not go together: give one of them.")
        check_installed()
    if arguments.export and arguments.scene == STANDARD_INPUT:
        raise UsageError("--export needs a scene file: tasks have no standard input.")
    if arguments.export and parse_output(arguments.output).kind != "frames":
        raise UsageError(
            f"--export needs -o with a place for the number of a frame, as frames/%04d.exr; got "
            f"{arguments.output}."
        )
    if arguments.fps is not None and not 0 < arguments.fps <= MOST_FPS:
        raise UsageError(f"--fps must be above 0 and at most {MOST_FPS}, got {arguments.fps:g}.")
