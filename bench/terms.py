"""Terms of light by several methods, as a picture, and the time that gathering them takes.

`python -m bench.terms` renders a scene without terms and with all of them, in turns, and prints a
row for each method: the mean of each term, and the ratio of the times. `-o FILE.jpg` writes the
picture of docs: a row for each method, and a column for each term.
"""

import argparse
import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from bench.program import add_rounds, at_least, exit_code_of, machine, parser_of
from bench.ratios import LEAST_ROUNDS, ratio_of
from bench.sheets import in_rows, titled, write_sheet
from glrt.core.files import check_writable
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.settings import TERMS, Method

METHODS: tuple[Method, ...] = ("mis", "ddgi", "whitted")
SHOWN = TERMS[:-1]  # the scene has no medium


class Found(NamedTuple):
    """A picture with its terms, and the times of rounds with and without them, in seconds."""

    image: Image
    with_terms: list[float]
    without: list[float]


def main(arguments: list[str] | None = None) -> int:
    """Print the table and write the picture; returns the exit code."""
    parser = parser_of("terms", __doc__)
    parser.add_argument("scene", nargs="?", default="cornell", help="default: cornell")
    parser.add_argument("--samples", type=at_least(16), default=256, help="default: 256")
    parser.add_argument("-o", dest="file", type=Path, metavar="FILE.jpg", help="picture to write")
    add_rounds(parser, 192, LEAST_ROUNDS, LEAST_ROUNDS)
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    if parsed.file:
        check_writable(parsed.file)
    context, cells = open_context(), []
    print(f"| method | picture | {' | '.join(SHOWN)} | time over that without terms |")
    print("|---" * (len(SHOWN) + 3) + "|")
    for method in METHODS:
        found = _found(context, method, parsed)
        means = [found.image.radiance, *(found.image.aovs[term].value for term in SHOWN)]
        row = [f"{mean.mean(dtype=np.float64):.4f}" for mean in means]
        ratio = ratio_of(found.with_terms, found.without)
        print(f"| `{method}` | {' | '.join(row)} | {ratio} |", flush=True)
        titles = [method, *SHOWN]
        cells += [titled(title, mean) for title, mean in zip(titles, means, strict=True)]
    print(f"\n{machine(context.renderer)}; {parsed.size} x {parsed.size}, {parsed.samples} samples")
    if parsed.file:
        write_sheet(parsed.file, in_rows(cells, 1 + len(SHOWN)))


def _found(context: Context, method: Method, parsed: argparse.Namespace) -> Found:
    scene = load(parsed.scene)
    size: dict[str, Any] = {"width": parsed.size, "height": parsed.size, "method": method}
    plain = Renderer(scene, context=context, **size)
    sorting = Renderer(scene, context=context, aov=TERMS, **size)
    times: dict[Renderer, list[float]] = {plain: [], sorting: []}
    try:
        for _ in range(1 + parsed.rounds):
            for renderer, seconds in times.items():
                renderer.restart()
                start = time.perf_counter()
                renderer.render(parsed.samples)
                seconds.append(time.perf_counter() - start)
        return Found(sorting.image(), times[sorting][1:], times[plain][1:])
    finally:
        plain.release()
        sorting.release()


if __name__ == "__main__":
    sys.exit(main())
