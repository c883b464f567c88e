"""What methods with probes miss at any number of samples: the tables of docs/explanation/probes.md.

`python -m bench.probe_floors` renders three rooms by `ddgi` and `gather` with 3, 5 and 8 probes
along an edge. The mean of (x1 - r1) (x2 - r2) over two pictures x and two renders r by `mis`, all
of other seeds, is the squared floor, without the noise of any. `--truths DIR` keeps these renders
for the next run.
"""

import argparse
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bench.contact_sheet import check_sheet, save_sheet
from bench.program import at_least, exit_code_of, machine, parser_of
from bench.truth import Truth, truth_of
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.image.tonemap import expose_and_encode
from glrt.plan.methods import METHODS
from glrt.rendering.renderer import Renderer

SCENES = ("methods/diffuse", "methods/two_rooms", "methods/white")
WITH_PROBES = [  # `resampled` has the floor of `gather`
    name for name, traits in METHODS.items() if traits.has_probes and not traits.resamples
]
PROBES = (3, 5, 8)
FEW = (1, 16, 64)  # samples of the second table
FEW_PROBES = 5
ROW = (384, 1024)  # pixels a side and samples of the pictures in a row
BOUNCES = 64  # of truths; probes light each other without a limit
FLOORS = ("scene", "method", "probes along an edge", "rms", "median of a pixel", "mean")
NOISE = ("scene", "method", *(f"{samples} samples" for samples in FEW))

Radiance = NDArray[np.float32]


class Floor(NamedTuple):
    """What is wrong with a picture of many samples, relative."""

    rms: float
    median: float  # of the pixels
    mean: float  # of the picture, with its sign


def floor_of(one: Radiance, other: Radiance, truth: Truth) -> Floor:
    """Of two pictures of the same scene, by other seeds."""
    picture, right = ((a + b).mean(axis=2) / 2 for a, b in ((one, other), truth))
    rms = math.sqrt(max(truth.shared(one, other), 0.0))
    median = float(np.median(np.abs(picture - right) / right))
    return Floor(rms, median, float(picture.mean() / right.mean() - 1))


def pictures(name: str, context: Context, seeds: int, **settings: Any) -> Iterator[Radiance]:
    """Of a scene, by as many seeds."""
    renderer = Renderer(load(name), None, context, "baked", bounces=BOUNCES, **settings)
    try:
        for seed in range(seeds):
            renderer.update(seed=seed)
            yield renderer.render().image().radiance
    finally:
        renderer.release()


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.probe_floors`; returns the exit code."""
    parser = parser_of("probe_floors", __doc__)
    parser.add_argument("scenes", nargs="*", default=SCENES, metavar="SCENE")
    for name, default, text in (
        ("size", 64, "pixels a side"),
        ("samples", 256, "of each picture of a floor"),
        ("seeds", 16, "of pictures with noise"),
        ("truth", 16384, "samples"),
    ):
        note = f"{text} (default: {default})"
        parser.add_argument(f"--{name}", type=at_least(2), default=default, metavar="N", help=note)
    parser.add_argument("--truths", type=Path, metavar="DIR", help="keep truths in this folder")
    parser.add_argument("--sheet", type=Path, metavar="FILE", help="write a row of pictures alone")
    given = parser.parse_args(arguments)
    return exit_code_of(lambda: _save_row(given.sheet) if given.sheet else _run(given))


def _run(given: argparse.Namespace) -> None:
    context = open_context()
    print(f"{machine(context.renderer)}; {given.size} x {given.size} pixels; truth from ")
    print(f"{given.truth} samples of {BOUNCES} bounces.")
    floors, noise = [FLOORS, ("---",) * len(FLOORS)], [NOISE, ("---",) * len(NOISE)]
    for name in given.scenes:
        ways: Any = {"size": given.size, "samples": given.truth, "bounces": BOUNCES}
        truth = truth_of(name, context, given.truths, **ways)
        for method in WITH_PROBES:
            for probes in PROBES:
                way = {**_way(given.size, given.samples, method), "probes": probes}
                one, other = pictures(name, context, 2, **way)
                floor = floor_of(one, other, truth)
                cells = f"{100 * floor.rms:.1f} %", f"{100 * floor.median:.1f} %"
                floors.append((name, method, str(probes), *cells, f"{100 * floor.mean:+.1f} %"))
        for method in ("mis", *WITH_PROBES):
            errors = []
            for samples in FEW:
                images = pictures(name, context, given.seeds, **_way(given.size, samples, method))
                square = float(np.mean([truth.relative(image) for image in images]))
                errors.append(f"{100 * math.sqrt(max(square, 0.0)):.1f} %")
            noise.append((name, method, *errors))
    print(f"\nWhat is missed with {given.samples} samples, without noise:\n\n{_table(floors)}")
    print(f"\nErrors with noise, {FEW_PROBES} probes along an edge, {given.seeds} seeds:\n")
    print(_table(noise))
    context.gl.release()


def _way(size: int, samples: int, method: str) -> dict[str, Any]:
    edges = {"width": size, "height": size}
    return {**edges, "samples": samples, "method": method, "probes": FEW_PROBES}


def _table(rows: list[tuple[str, ...]]) -> str:
    return "\n".join(f"| {' | '.join(cells)} |" for cells in rows)


def _save_row(file: Path) -> None:
    """The first scene by `ddgi`, `gather` and `mis`."""
    check_sheet(file)
    context = open_context()
    row = [
        expose_and_encode(
            next(pictures(SCENES[0], context, 1, **_way(*ROW, method))), 0.0, "neutral"
        )
        for method in (*WITH_PROBES, "mis")
    ]
    context.gl.release()
    save_sheet(row, file)


if __name__ == "__main__":
    sys.exit(main())
