"""`glrt merge`: put the parts of a render together."""

import argparse
import sys
from pathlib import Path

from glrt.cli.options import add_outputs, add_summary, once
from glrt.cli.reports.warnings import doubt, too_dark
from glrt.core.errors import UsageError
from glrt.core.text import counted
from glrt.image.image import Image, check_writable, read_recipe
from glrt.image.merge import merged_image
from glrt.image.recipe import Recipe
from glrt.process.command import file_names, print_figures

DESCRIPTION = "Put parts of a render together, each made with --part K/N."
EPILOG = (
    "The picture does not depend on the order of the parts. Rendered again from its recipe it has "
    "the same bits; a render in one piece adds its samples in another order, so its last bits "
    "differ. Exit codes: 0 done, 2 wrong usage, or parts that are missing or of other renders."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument(
        "parts", metavar="PART.exr", nargs="+", help="the parts of one render, in any order"
    )
    add_outputs(parser)
    parser.add_argument(
        "--incomplete",
        action="store_true",
        help="merge what is there, although parts are missing",
    )
    add_summary(parser, "no summary")


def run(arguments: argparse.Namespace) -> int:
    """Write the merged picture and return 0; UsageError if the parts cannot be merged."""
    arguments.outputs = once(arguments.outputs)
    for output in arguments.outputs:
        check_writable(output)
    recipes = _recipes(arguments.parts)
    image = merged_image(recipes, Image.load, arguments.incomplete)
    for output in arguments.outputs:
        image.save(output)
    _report(arguments, image)
    return 0


def _recipes(names: list[str]) -> dict[str, Recipe | None]:
    """Return the recipes of files by name; UsageError for a file not .exr, or given twice."""
    for name in names:
        if Path(name).suffix.lower() != ".exr":
            raise UsageError(f"{name} is not an .exr file: parts are, for they keep their film.")
        if names.count(name) > 1:
            raise UsageError(f"{name} is given twice; leave one out.")
    return {name: read_recipe(name) for name in names}


def _report(arguments: argparse.Namespace, image: Image) -> None:
    recipe, error = image.recipe, image.error
    assert recipe
    assert recipe.partition
    held, count = len(recipe.partition.numbers), recipe.partition.count
    if arguments.json:
        figures = {"parts": held, "of": count, "samples": image.samples, "error": error}
        figures["error_doubtful"] = image.error_doubtful
        print_figures(figures, arguments.outputs)
    elif not arguments.quiet:
        known = "" if error is None else f", estimated error {100 * error:.2g} %"
        print(
            f"Wrote {file_names(arguments.outputs)}: {held} of {counted(count, 'part')}, "
            f"{counted(image.samples, 'sample')}{known}.",
            file=sys.stderr,
        )
    for caution in filter(None, [doubt(image), too_dark(image, arguments.outputs)]):
        print(f"glrt: caution: {caution}", file=sys.stderr)
    ways = [way for way in (recipe.renderer, recipe.pipeline, recipe.tier) if " and " in way]
    if ways:
        print(
            f"glrt: caution: the parts come from several drivers or kernels ({'; '.join(ways)}): "
            "rendered again by one, the picture may have other last bits.",
            file=sys.stderr,
        )
