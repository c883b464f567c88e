"""What it costs to keep the triangles of repeated meshes once: speed, memory and time to build.

Copies of a displaced ball in a heap, each turned otherwise, kept once or as often as they are seen.
Rounds are interleaved; a ratio is that of two runs of the same round.
"""

import argparse
import statistics
import sys
import time
from collections.abc import Iterator, Sequence
from typing import NamedTuple
from unittest.mock import patch

import numpy as np

from bench.mesh_sizes import displaced, packed
from bench.program import add_rounds, exit_code_of, machine, parser_of
from bench.ratios import Ratio, ratio_of
from glrt.gpu.context import Context, open_context
from glrt.rendering.device_scene import STILL
from glrt.rendering.renderer import Renderer
from glrt.scene import instancing
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane

HEAPS = ((6, 2), (4, 20), (5, 50), (4, 400))  # divisions of each triangle in four, and copies
SAMPLES = 4


def heap(steps: int, copies: int) -> Scene:
    """Balls of 20 * 4^steps triangles in a box of 8 x 4 x 8 over a floor."""
    draw = np.random.default_rng(1)
    ball = Mesh(*displaced(steps), material="clay", scale=0.35)
    places = draw.uniform(-1, 1, (copies, 3)) * [4, 2, 4]
    turns = draw.uniform(0, 360, (copies, 3))
    balls = [
        ball.model_copy(update={"translate": tuple(place), "rotate": tuple(turn)})
        for place, turn in zip(places.tolist(), turns.tolist(), strict=True)
    ]
    floor = Plane(point=(0, -3, 0), normal=(0, 1, 0), material="clay")
    return Scene.build(
        {"position": [0, 0, 9], "look_at": [0, 0, 0], "fov": 45},
        [*balls, floor],
        materials={"clay": {"type": "lambertian", "color": [0.7, 0.5, 0.4]}},
        background={"bottom": [0.4, 0.4, 0.5], "top": [0.9, 1.0, 1.2]},
        render={"bounces": 8},
    )


class Kept(NamedTuple):
    """One way to keep the triangles."""

    seconds: float  # to build and pack, without the cache
    bytes_all: int  # on the driver
    renderer: Renderer


class Row(NamedTuple):
    """The figures for one heap, kept as often as seen and kept once."""

    triangles: int  # of a ball
    copies: int
    seconds: tuple[float, float]
    bytes_all: tuple[int, int]
    rates: tuple[float, float]  # million samples a second
    time: Ratio  # kept once, over kept as often as seen


def measure(
    context: Context, heaps: Sequence[tuple[int, int]], size: int, rounds: int
) -> list[Row]:
    """All heaps, one after the other; the two ways interleaved."""
    return [_row(context, steps, copies, size, rounds) for steps, copies in heaps]


def _row(context: Context, steps: int, copies: int, size: int, rounds: int) -> Row:
    scene = heap(steps, copies)
    ways = [_kept(context, scene, size, least) for least in (1 << 60, 1)]
    runs: tuple[list[float], list[float]] = ([], [])
    for _ in range(rounds):
        for times, way in zip(runs, ways, strict=True):
            way.renderer.restart()
            start = time.perf_counter()
            way.renderer.render(SAMPLES)
            times.append(time.perf_counter() - start)
    for way in ways:
        way.renderer.release()
    often, once = ways
    rates = [SAMPLES * size**2 / statistics.median(times) / 1e6 for times in runs]
    return Row(
        len(scene.meshes[0].triangles.faces),
        copies,
        (often.seconds, once.seconds),
        (often.bytes_all, once.bytes_all),
        (rates[0], rates[1]),
        ratio_of(runs[1], runs[0]),
    )


def _kept(context: Context, scene: Scene, size: int, least: int) -> Kept:
    """With trees of their own for meshes whose copies would take `least` triangles."""
    with patch.object(instancing, "LEAST_SAVED", least):
        arrays, seconds = packed(scene)
        bytes_all = sum(arrays[name].nbytes for name in (*STILL, "Instance"))
        del arrays
        return Kept(seconds, bytes_all, Renderer(scene, context=context, width=size, height=size))


def table(rows: Sequence[Row]) -> Iterator[str]:
    """The rows as Markdown."""
    columns = ["triangles", "copies", "tree", "kept once", "MB", "kept once"]
    columns += ["million samples/s", "kept once", "time kept once over time kept as seen"]
    yield f"| {' | '.join(columns)} |"
    yield "|---" * len(columns) + "|"
    for row in rows:
        cells = [f"{row.triangles:,}", str(row.copies)]
        cells += [f"{seconds:.2f} s" for seconds in row.seconds]
        cells += [f"{size / 1e6:.1f}" for size in row.bytes_all]
        cells += [*(f"{rate:.3f}" for rate in row.rates), str(row.time)]
        yield f"| {' | '.join(cells)} |"


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.repeated_meshes`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> None:
    context = open_context()
    rows = measure(context, parsed.heaps, parsed.size, parsed.rounds)
    work = f"{parsed.size} x {parsed.size} pixels, {parsed.rounds} rounds"
    print(f"{machine(context.renderer)}, {work}\n")
    print("\n".join(table(rows)))


def _heap(text: str) -> tuple[int, int]:
    steps, copies = text.split("x")
    return int(steps), int(copies)


def _parser() -> argparse.ArgumentParser:
    parser = parser_of("repeated_meshes", __doc__)
    told = "times that each triangle of an icosahedron is divided in four, and copies, as 4x20"
    parser.add_argument("--heaps", type=_heap, nargs="+", metavar="KxN", default=HEAPS, help=told)
    add_rounds(parser, size=128, rounds=7)
    return parser


if __name__ == "__main__":
    sys.exit(main())
