"""`glrt paths`: the paths of a pixel's samples, the brightest first."""

import argparse
import sys
from pathlib import Path as File

from glrt.cli.options import (
    SCENE,
    add_context,
    add_files,
    add_pipeline,
    add_settings,
    file_rules,
    settings_given,
)
from glrt.cli.request import scene_and_settings
from glrt.core import files
from glrt.core.errors import UsageError
from glrt.core.files import reason
from glrt.image.sources import check_not_scene, files_read, recipe_of, shown
from glrt.scene.scene import Scene
from glrt.settings import Settings

TYPE_CHECKING = False
if TYPE_CHECKING:
    from glrt.rendering.paths.file import StoredPaths
    from glrt.rendering.paths.values import Path as PixelPath

DESCRIPTION = (
    "Show the paths of a pixel's samples: which samples carry most of its light, where their paths "
    "went, and what each light on them added, found by which strategy with which weight."
)
EPILOG = (
    "Columns and rows count from 0, from the top left of the whole picture, also of a --crop. "
    "--replay traces the paths of a file again: the same bits are wanted of the driver that it "
    "names, and numbers within 0.1 % of another. Exit codes: 0 done, 1 a stored path differs, "
    "2 wrong usage or a bad scene or file, 3 no OpenGL 4.3, 4 the driver failed."
)
DIFFERENT = 1


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument("scene", metavar="SCENE", nargs="?", help=SCENE)
    parser.add_argument(
        "--pixel", type=int, nargs=2, metavar=("X", "Y"), help="column and row of the pixel"
    )
    parser.add_argument(
        "--sample",
        dest="numbers",
        type=int,
        action="append",
        metavar="K",
        help="show the path of this sample, from 0; may be repeated (default: that of the "
        "brightest)",
    )
    parser.add_argument(
        "--brightest",
        type=int,
        metavar="N",
        help="show the paths of the N samples that bring most light, and of as many particles "
        "(default: 1)",
    )
    parser.add_argument(
        "--json", action="store_true", help="print the paths and their recipe as one line of JSON"
    )
    parser.add_argument("-o", dest="output", metavar="FILE.json", help="store that line in a file")
    parser.add_argument(
        "--replay", metavar="FILE.json", help="trace the paths of such a file again, and compare"
    )
    add_settings(parser)
    add_context(parser)
    add_pipeline(parser)
    add_files(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print or store the paths of a pixel, or trace stored ones again; return the exit code."""
    if arguments.pipeline == "fragment":
        raise UsageError(
            "The fragment pipeline cannot record paths: it has no storage buffers, for which "
            "compute shaders and OpenGL 4.3 are needed. Leave out --pipeline."
        )
    return _replay(arguments) if arguments.replay is not None else _show(arguments)


def _show(arguments: argparse.Namespace) -> int:
    scene, settings, pixel = _asked(arguments)
    from glrt.rendering.paths.file import paths_to_json
    from glrt.rendering.paths.replay import (
        Selection,
        check_selection,
        path_replay,
        selected_paths,
    )

    recipe = recipe_of(arguments.scene)
    if recipe and recipe.traced:
        _report("the picture was relit in the window: its light now is traced, not its layers.")
    if recipe and recipe.partition:
        _report(f"the picture is a part of a render: all {settings.samples} samples are traced.")
    if scene.is_blurred:
        _report("the shutter is open: paths are traced at the moment when it opens.")
    most = arguments.brightest or 1
    wanted = Selection(arguments.numbers, 0 if arguments.numbers else most, most)
    check_selection(pixel, wanted, settings)
    traced = scene, settings, arguments.context
    apart = recipe.apart if recipe else "repeated"
    with path_replay(*traced, apart=apart) as (replay, own):
        found = selected_paths(replay, own, pixel, wanted)
    text = paths_to_json(found) if arguments.json or arguments.output else ""
    if arguments.output:
        files.write_text(File(arguments.output), text + "\n")
    if arguments.json:
        print(text, flush=True)
        return 0
    from glrt.analysis.path_report import report

    print(report(found, shown(arguments.scene)), flush=True)
    return 0


def _asked(arguments: argparse.Namespace) -> tuple[Scene, Settings, tuple[int, int]]:
    """Return scene, settings and pixel; UsageError for missing or conflicting options."""
    if arguments.scene is None:
        raise UsageError("SCENE is missing. See `glrt paths --help`.")
    if arguments.pixel is None:
        raise UsageError("--pixel X Y is missing: column and row, from the top left.")
    if arguments.numbers and arguments.brightest is not None:
        raise UsageError("--sample and --brightest both say which paths to show: give one.")
    if arguments.brightest is not None and arguments.brightest < 1:
        raise UsageError(f"--brightest must be 1 or more, got {arguments.brightest}.")
    if arguments.output is not None:
        check_not_scene(arguments.output, arguments.scene)
        if not arguments.output.lower().endswith(".json"):
            raise UsageError(f"Cannot write {arguments.output}: its name must end in .json.")
        files.check_writable(File(arguments.output))
    x, y = arguments.pixel
    return *scene_and_settings(arguments), (x, y)


def _replay(arguments: argparse.Namespace) -> int:
    """Trace stored paths again; return 0 if all come out the same, else 1."""
    asked = ("scene", "pixel", "numbers", "brightest", "json", "output", "lights")
    if settings_given(arguments) or any(getattr(arguments, name) for name in asked):
        raise UsageError(
            "--replay FILE.json takes scene, pixel and settings from the file alone, and reports "
            "whether its paths come out again: leave the others out."
        )
    from glrt.rendering.paths.file import TOLERANCE, first_difference

    name = shown(arguments.replay)
    stored, renderer, pairs = _traced_again(arguments)
    tolerance = 0.0 if renderer == stored.recipe.renderer else TOLERANCE
    for before, after in pairs:
        if difference := first_difference(before, after, tolerance):
            print(f"{name}: sample {before.sample} differs: {difference}", flush=True)
            return DIFFERENT
    how = "bit for bit"
    if tolerance:
        how = f"within {100 * TOLERANCE:g} %: another driver stored them"
    print(f"{name}: {len(pairs)} of {len(pairs)} paths come out again, {how}.", flush=True)
    return 0


def _traced_again(
    arguments: argparse.Namespace,
) -> "tuple[StoredPaths, str, list[tuple[PixelPath, PixelPath | None]]]":
    """Return the stored file, the driver here, and pairs of stored and new path (or None)."""
    from glrt.rendering.paths.file import LARGEST, paths_from_json
    from glrt.rendering.paths.replay import check_pixel, check_samples, path_replay

    name = arguments.replay
    try:
        text = files.read_at_most(File(name), LARGEST).decode()
    except (OSError, ValueError) as error:
        raise UsageError(f"{shown(name)}: cannot be read: {reason(error)}.") from None
    stored = paths_from_json(text, shown(name))
    recipe = files_read(stored.recipe, File(name), file_rules(arguments))
    numbers = [path.sample for path in stored.paths]
    check_pixel(stored.pixel, recipe.settings)
    check_samples(numbers, recipe.settings)
    traced = recipe.scene, recipe.settings, arguments.context
    with path_replay(*traced, apart=recipe.apart) as (replay, now):
        found = replay.paths(stored.pixel, numbers)
        particles = [
            replay.particle_path(stored.pixel, path.sample, path.particle or 0)
            for path in stored.particles
        ]
    pairs = zip((*stored.paths, *stored.particles), (*found, *particles), strict=True)
    return stored, now.renderer, list(pairs)


def _report(text: str) -> None:
    print(f"glrt: caution: {text}", file=sys.stderr, flush=True)
