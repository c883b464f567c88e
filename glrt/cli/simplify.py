"""`glrt inspect --simplify`: what a scene can do without, and the smaller scene."""

import argparse
from pathlib import Path

from glrt.core.errors import UsageError
from glrt.core.files import check_writable
from glrt.core.text import counted, escaped
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import find
from glrt.settings import Settings


def add_simplify(parser: argparse.ArgumentParser) -> None:
    """Add `--simplify`, `--apply` and `-o` to the parser."""
    parser.add_argument(
        "--simplify",
        action="store_true",
        help="name what the scene can do without: bounces, features of materials, textures, lamps "
        "and objects that together change the picture by less than --error, with 95%% confidence",
    )
    parser.add_argument(
        "--apply", action="store_true", help="write the smaller scene to the file of -o"
    )
    parser.add_argument(
        "-o", dest="smaller", metavar="FILE.toml", help="the file for --apply, not that of SCENE"
    )


def check_simplify(arguments: argparse.Namespace) -> None:
    """Raise UsageError for options that do not go together, and for a file not to be written."""
    if arguments.simplify and arguments.error is None:
        raise UsageError("--simplify needs the change that is allowed: give --error, such as 2%.")
    if arguments.simplify and arguments.kernel:
        raise UsageError("--kernel prints the shader and nothing else: leave --simplify out.")
    if arguments.apply and not arguments.simplify:
        raise UsageError("--apply writes what --simplify finds: give both.")
    if arguments.apply != (arguments.smaller is not None):
        raise UsageError("--apply and -o FILE.toml go together: give both, or neither.")
    if not arguments.apply:
        return
    path = Path(arguments.smaller)
    if path.suffix.lower() != ".toml":
        raise UsageError(f"Cannot write {path}: the name of a scene file must end in .toml.")
    source = Path(find(arguments.scene))
    if path.exists() and source.exists() and path.samefile(source):
        raise UsageError(
            f"{path} is the scene itself, which would be lost: choose another name for -o."
        )
    check_writable(path)


def simplify(arguments: argparse.Namespace, scene: Scene, settings: Settings) -> None:
    """Print what can go for `arguments.error`, and write the smaller scene if that is wanted."""
    from glrt.analysis.method_choice.advice import steps
    from glrt.analysis.simplification.report import MOST_NAMED, lines, saving
    from glrt.analysis.simplification.search import check, simplified
    from glrt.gpu.context import open_context

    check(scene, arguments.error)
    context = open_context(arguments.context)
    try:
        with steps(arguments, "Measuring what can go ...") as report:
            found = simplified(scene, settings, arguments.error, context, report)
            saved = saving(scene, settings, found, context)
    finally:
        context.gl.release()
    named = len(scene.objects) if arguments.all else MOST_NAMED
    print("\n".join(lines(found, saved, named)), flush=True)
    if arguments.apply:
        found.scene.save(arguments.smaller)
        what = counted(len(found.scene.objects), "object")
        print(f"Wrote {escaped(arguments.smaller)}: {what}, {counted(found.bounces, 'bounce')}.")
