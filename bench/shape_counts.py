"""The speed-up by a tree over shapes of some kinds, by their number: shapes on a floor.

They cover the same share of the floor whatever their number, so that paths are equally long. Rounds
are interleaved; a ratio is that of two runs of the same round. With `--mesh` a ball of triangles
hangs above them, and the shapes are in its tree or stay outside.
"""

import argparse
import math
import statistics
import sys
import time
from collections.abc import Iterator, Sequence
from itertools import cycle
from pathlib import Path
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np

from bench.program import add_rounds, exit_code_of, machine, parser_of
from glrt.core.errors import SceneError
from glrt.core.text import plural
from glrt.gpu.context import Context, open_context
from glrt.plan import facts
from glrt.process.command import peak_bytes
from glrt.rendering import pipelines
from glrt.rendering.renderer import Renderer
from glrt.scene.files.assets import AssetFolder
from glrt.scene.files.named_meshes import mesh_of_arrays
from glrt.scene.loading.scene_files import with_files
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene
from tests.support.meshes import blob

COUNTS = (16, 32, 64, 128, 485, 2000, 10_000, 65_000)
FIRST = 485  # number of shapes with which others are compared
CONSTANTS = 128  # most baked shapes: 3 s of compilation, which grows quadratically
KINDS = ("sphere", "quad", "disk", "box", "cylinder")
Table = dict[str, Any]
Array = np.ndarray[Any, Any]


def crowd(
    count: int, seed: int = 1, kinds: Sequence[str] = ("sphere",), mesh: int | None = None
) -> Scene:
    """A scene of `count` shapes, matte and metal, on a floor of 2 x 2 units under a bright sky.

    Shapes take the `kinds` in turns. With `mesh`, a ball of 20 * 4**mesh triangles is above them.
    """
    rng = np.random.default_rng(seed)
    columns = math.ceil(math.sqrt(count))
    cell = 2 / columns
    place = np.array([divmod(index, columns) for index in range(count)])
    radius = cell * rng.uniform(0.2, 0.35, count)
    center = np.column_stack([cell * (place + 0.5) - 1, radius])[:, [0, 2, 1]]
    center[:, [0, 2]] += cell * rng.uniform(-0.15, 0.15, (count, 2))
    shapes = [
        {"shape": kind, "material": ("clay", "brass")[i % 2], **_within(kind, c, r, rng)}
        for i, (c, r, kind) in enumerate(zip(center, radius.tolist(), cycle(kinds), strict=False))
    ]
    floor = {"shape": "plane", "point": [0, 0, 0], "normal": [0, 1, 0], "material": "clay"}
    if mesh is not None:
        vertices, faces = blob(mesh)
        ball = {"shape": "mesh", "file": mesh_of_arrays(vertices * 0.4, faces), "material": "clay"}
        shapes.append({**ball, "translate": [0, 0.7, 0]})
    scene = parse_scene(
        {
            "title": f"{count} shapes on a floor",
            "camera": {"position": [0, 1.5, 2.5], "look_at": [0, 0, 0]},
            "background": {"bottom": [0.9, 0.9, 0.9], "top": [0.5, 0.7, 1.0]},
            "materials": {
                "clay": {"type": "lambertian", "color": [0.7, 0.6, 0.5]},
                "brass": {"type": "metal", "color": [0.9, 0.8, 0.5], "roughness": 0.3},
            },
            "objects": [*shapes, floor],
        },
        "crowd",
    )
    return with_files(scene, AssetFolder(Path()), "crowd")


def _within(kind: str, center: Array, radius: float, rng: np.random.Generator) -> Table:
    """A shape of a kind within a ball, turned at random; a ball itself."""
    if kind == "sphere":
        return {"center": center.tolist(), "radius": radius}
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0] * radius
    if kind == "disk":
        return {"center": center.tolist(), "normal": axes[0].tolist(), "radius": radius}
    if kind == "quad":
        corner, edges = center - (axes[0] + axes[1]) / 2**0.5, (2**0.5 * axes[:2]).tolist()
        return {"corner": corner.tolist(), "edge_u": edges[0], "edge_v": edges[1]}
    if kind == "box":
        half, turn = radius / 3**0.5, rng.uniform(0, 90, 3).tolist()
        return {"min": (center - half).tolist(), "max": (center + half).tolist(), "rotate": turn}
    end, radius = axes[0] / 2**0.5, radius / 2**0.5
    return {"from": (center - end).tolist(), "to": (center + end).tolist(), "radius": radius}


class Row(NamedTuple):
    """The figures for one number of shapes; seconds are for one sample of every pixel."""

    number: int
    setup_seconds: float  # to pack the scene, build the tree and compile
    tree_seconds: float
    loop_seconds: float | None  # without a tree; None beyond the loop limit of the driver
    gain: tuple[float, float, float] | None  # speed-up by the tree: median and quartiles
    growth: tuple[float, float, float] | None  # time with the tree over that of FIRST shapes


def measure(
    context: Context,
    counts: Sequence[int],
    size: int,
    rounds: int,
    constants: int = CONSTANTS,
    kinds: Sequence[str] = ("sphere",),
    mesh: int | None = None,
) -> list[Row]:
    """Measure all `counts` interleaved, with a tree, and without (baked up to `constants`)."""
    tree, loop, setup = {}, {}, {}
    for count in counts:
        scene = crowd(count, kinds=kinds, mesh=mesh)
        start = time.perf_counter()
        tree[count] = _renderer(context, scene, size, tree_from=1, most_baked=0)
        setup[count] = time.perf_counter() - start
        try:
            baked = constants + 1  # with the floor
            loop[count] = _renderer(context, scene, size, tree_from=count + 1, most_baked=baked)
        except SceneError:
            continue
    runs: dict[tuple[str, int], list[float]] = {}
    for _ in range(rounds):
        for name, renderers in (("tree", tree), ("loop", loop)):
            for count, renderer in renderers.items():
                runs.setdefault((name, count), []).append(_seconds(renderer))
    for renderer in (*tree.values(), *loop.values()):
        renderer.release()
    return [_row(count, setup[count], runs) for count in counts]


def _renderer(
    context: Context, scene: Scene, size: int, tree_from: int, most_baked: int
) -> Renderer:
    """A renderer with a tree from `tree_from` shapes on; up to `most_baked` are constants instead.

    Spheres are found by their own, unless other kinds or a mesh are there.
    """
    is_mixed = len({thing.shape for thing in scene.objects}) > 2  # the floor is one
    own = 1 << 30 if is_mixed else tree_from
    with (
        patch.multiple(facts, SPHERES_FROM=own, TREE_FROM=tree_from, REST_FROM=tree_from),
        patch.object(pipelines, "MOST_BAKED", most_baked),
    ):
        return Renderer(scene, context=context, tier="complete", width=size, height=size)


def _seconds(renderer: Renderer) -> float:
    samples = min(4, renderer.most_samples)
    renderer.restart()
    start = time.perf_counter()
    renderer.step(samples)
    return (time.perf_counter() - start) / samples


def _row(count: int, setup: float, runs: dict[tuple[str, int], list[float]]) -> Row:
    tree, loop, first = runs["tree", count], runs.get(("loop", count)), runs.get(("tree", FIRST))
    return Row(
        count,
        setup,
        statistics.median(tree),
        statistics.median(loop) if loop else None,
        _ratio(loop, tree) if loop else None,
        _ratio(tree, first) if first else None,
    )


def _ratio(a: Sequence[float], b: Sequence[float]) -> tuple[float, float, float]:
    low, middle, high = statistics.quantiles([x / y for x, y in zip(a, b, strict=True)], n=4)
    return middle, low, high


def table(rows: Sequence[Row], pixels: int, kinds: Sequence[str] = ("sphere",)) -> Iterator[str]:
    """The rows as Markdown."""
    columns = [", ".join(map(plural, kinds)), "set-up", "loop over all, million samples/s", "tree"]
    columns += ["speed-up by the tree", f"time over that of {FIRST}"]
    yield f"| {' | '.join(columns)} |"
    yield "|---|---|---|---|---|---|"
    for row in rows:
        loop = f"{pixels / row.loop_seconds / 1e6:.3f}" if row.loop_seconds else "refused"
        rate = f"{pixels / row.tree_seconds / 1e6:.2f}"
        ratios = f"{_text(row.gain)} | {_text(row.growth)}"
        yield f"| {row.number:,} | {row.setup_seconds:.2f} s | {loop} | {rate} | {ratios} |"


def _text(ratio: tuple[float, float, float] | None) -> str:
    return "{:.2f} ({:.2f}-{:.2f})".format(*ratio) if ratio else "-"


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.shape_counts`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> None:
    context = open_context()
    kinds: list[str] = parsed.shape
    limits = (parsed.counts, parsed.size, parsed.rounds, parsed.constants)
    rows = measure(context, *limits, kinds=kinds, mesh=parsed.mesh)
    work = f"{parsed.size} x {parsed.size} pixels, {parsed.rounds} rounds"
    print(f"{machine(context.renderer)}, {work}\n")
    print("\n".join(table(rows, parsed.size**2, kinds)))
    print(f"\npeak memory {(peak_bytes() or 0) / 2**20:.0f} MiB")


def _parser() -> argparse.ArgumentParser:
    parser = parser_of("shape_counts", __doc__)
    add = parser.add_argument
    told = "kinds of shapes, in turns (default: sphere)"
    add("--shape", choices=KINDS, nargs="+", default=["sphere"], metavar="KIND", help=told)
    told = "a ball of 20 * 4^LEVEL triangles above them"
    add("--mesh", type=int, metavar="LEVEL", help=told)
    add("--counts", type=int, nargs="+", metavar="N", default=list(COUNTS))
    add_rounds(parser, size=96, rounds=9)
    told = f"most shapes to bake for the loop over all (default: {CONSTANTS})"
    add("--constants", type=int, default=CONSTANTS, metavar="N", help=told)
    return parser


if __name__ == "__main__":
    sys.exit(main())
