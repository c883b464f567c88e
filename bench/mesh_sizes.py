"""Speed and memory by the number of triangles: a displaced ball in an open matte box under a sky.

The surface is the same whatever the number, except its finest bumps, so that pictures are equally
hard. Rounds are interleaved; a ratio is that of two runs of the same round.
"""

import argparse
import statistics
import sys
import time
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np

from bench.program import add_rounds, exit_code_of, machine, parser_of
from bench.ratios import LEAST_ROUNDS, Ratio, ratio_of
from glrt.gpu.context import Context, open_context
from glrt.packing.scene_arrays import pack_scene
from glrt.packing.scene_tree import tree_of
from glrt.plan.facts import SceneFacts
from glrt.process.command import peak_bytes
from glrt.rendering.device_scene import STILL
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.quad import Quad
from tests.support.meshes import icosphere, quads

STEPS = (5, 6, 7, 8)  # of dividing each triangle in four: 20,480 to 1.3 million
Array = np.ndarray[Any, Any]


def displaced(steps: int) -> tuple[Array, Array]:
    """A ball with bumps of three sizes, of 20 * 4^steps triangles."""
    points, faces = icosphere(steps)
    x, y, z = points.T
    bumps = 0.15 * np.sin(5 * x) * np.sin(6 * y + 1) * np.sin(4 * z + 2)
    bumps += 0.04 * np.sin(23 * x + 1) * np.sin(19 * y) * np.sin(21 * z)
    bumps += 0.008 * np.sin(90 * x) * np.sin(80 * y) * np.sin(85 * z)
    return points * (1 + bumps)[:, None], faces


def scene_of(mesh: Mesh) -> Scene:
    """A mesh of the size of a unit ball in a box without a lid."""
    low, high = -1.5, 3.0
    sides = [
        ([low] * 3, [high, 0, 0], [0, 0, high]),
        ([low] * 3, [high, 0, 0], [0, high, 0]),
        ([low] * 3, [0, 0, high], [0, high, 0]),
        ([-low, low, low], [0, 0, high], [0, high, 0]),
    ]
    return Scene.build(
        {"position": [0.8, 1.6, 5.0], "look_at": [0, -0.2, 0], "fov": 40},
        [mesh, Mesh(*quads(*sides), material="wall", smooth=False)],
        materials={
            "clay": {"type": "lambertian", "color": [0.7, 0.5, 0.4]},
            "wall": {"type": "lambertian", "color": [0.7, 0.7, 0.7]},
        },
        background={"bottom": [0.4, 0.4, 0.5], "top": [0.9, 1.0, 1.2]},
        render={"bounces": 8},
    )


def of_steps(steps: int) -> Scene:
    """The scene of a ball of 20 * 4^steps triangles."""
    return scene_of(Mesh(*displaced(steps), material="clay"))


CLUTTER = 20  # balls of 5,120 triangles each


def cluttered() -> Scene:
    """A closed room of 102,400 triangles: balls of four colours, under a lamp in the ceiling."""
    balls = displaced(4)
    dice = np.random.Generator(np.random.PCG64(3))
    colors = ([0.7, 0.5, 0.4], [0.3, 0.5, 0.7], [0.6, 0.6, 0.25], [0.65, 0.65, 0.65])
    places = [(x, y, z) for y in (-1.0, -0.05) for z in (-0.9, 0.1) for x in np.linspace(-2, 2, 5)]
    objects = [
        Mesh(
            *balls,
            material=f"clay {number % 4}",
            translate=np.array(place) + dice.uniform(-0.08, 0.08, 3),
            rotate=dice.uniform(-180, 180, 3),
            scale=float(dice.uniform(0.28, 0.38)),
        )
        for number, place in enumerate(places[:CLUTTER])
    ]
    low, wide, high, deep = [-2.6, -1.5, -1.6], [5.2, 0, 0], [0, 3.0, 0], [0, 0, 6.0]
    top, right, front = [-2.6, 1.5, -1.6], [2.6, -1.5, -1.6], [-2.6, -1.5, 4.4]
    walls = [(low, wide, deep), (low, wide, high), (low, deep, high), (top, wide, deep)]
    walls += [(right, deep, high), (front, wide, high)]
    shell = Mesh(*quads(*walls), material="wall", smooth=False)
    lamp = Quad(corner=(-0.5, 1.48, 0), edge_u=(1, 0, 0), edge_v=(0, 0, 1), material="lamp")
    clay = {f"clay {k}": {"type": "lambertian", "color": color} for k, color in enumerate(colors)}
    return Scene.build(
        {"position": [0.0, 0.4, 4.2], "look_at": [0, -0.5, 0], "fov": 50},
        [*objects, shell, lamp],
        materials={
            **clay,
            "wall": {"type": "lambertian", "color": [0.7, 0.7, 0.7]},
            "lamp": {"type": "light", "emission": [12.0, 12.0, 12.0]},
        },
        render={"bounces": 8},
    )


def packed(scene: Scene) -> tuple[dict[str, Array], float]:
    """The arrays of a scene, and the seconds to build and pack them, without the cache of trees."""
    with patch("glrt.packing.tree_cache.kept", lambda key, build: build()):
        start = time.perf_counter()
        facts = SceneFacts(scene)
        arrays = pack_scene(facts, tree_of(facts))
        return arrays, time.perf_counter() - start


class Row(NamedTuple):
    """The figures for one mesh."""

    triangles: int
    mesh_seconds: float  # to check it and find its normals
    tree_seconds: float  # to build and pack
    compile_seconds: float
    bytes_each: float  # on the driver, of a triangle
    rate: float  # million samples a second
    growth: Ratio  # of its time to that of the first


def measure(context: Context, steps: Sequence[int], size: int, rounds: int) -> list[Row]:
    """All meshes, interleaved."""
    renderers, known = [], []
    for number in steps:
        start = time.perf_counter()
        mesh = Mesh(*displaced(number), material="clay")
        assert mesh.triangles.shading_normals.any()
        read = time.perf_counter() - start
        scene = scene_of(mesh)
        arrays, built = packed(scene)
        bytes_all = sum(arrays[name].nbytes for name in STILL)
        del arrays
        renderers.append(Renderer(scene, context=context, width=size, height=size))
        triangles = SceneFacts(scene).triangles
        known.append((triangles, read, built, bytes_all / triangles))
    runs: list[list[float]] = [[] for _ in steps]
    for _ in range(rounds):
        for times, renderer in zip(runs, renderers, strict=True):
            times.append(_seconds(renderer))
    rows = [
        Row(
            triangles,
            read,
            built,
            renderer.seconds["compile"],
            each,
            size**2 / statistics.median(times) / 1e6,
            ratio_of(times, runs[0]),
        )
        for (triangles, read, built, each), times, renderer in zip(
            known, runs, renderers, strict=True
        )
    ]
    for renderer in renderers:
        renderer.release()
    return rows


def _seconds(renderer: Renderer) -> float:
    """The seconds of one sample of every pixel."""
    renderer.restart()
    start = time.perf_counter()
    renderer.render(4)
    return (time.perf_counter() - start) / 4


def table(rows: Sequence[Row]) -> Iterator[str]:
    """The rows as Markdown."""
    columns = ["triangles", "mesh", "tree", "compile", "bytes a triangle", "million samples/s"]
    columns += [f"time over that of {rows[0].triangles:,}"]
    yield f"| {' | '.join(columns)} |"
    yield "|---" * len(columns) + "|"
    for row in rows:
        seconds = (row.mesh_seconds, row.tree_seconds, row.compile_seconds)
        spent = " | ".join(f"{value:.2f} s" for value in seconds)
        yield (
            f"| {row.triangles:,} | {spent} | {row.bytes_each:.0f} | {row.rate:.3f} "
            f"| {row.growth} |"
        )


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.mesh_sizes`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> None:
    context = open_context()
    rows = measure(context, parsed.steps, parsed.size, parsed.rounds)
    work = f"{parsed.size} x {parsed.size} pixels, {parsed.rounds} rounds"
    print(f"{machine(context.renderer)}, {work}\n")
    print("\n".join(table(rows)))
    print(f"\npeak memory {(peak_bytes() or 0) / 2**20:.0f} MiB")


def _parser() -> argparse.ArgumentParser:
    parser = parser_of("mesh_sizes", __doc__)
    told = "times that each triangle of an icosahedron is divided in four"
    parser.add_argument("--steps", type=int, nargs="+", metavar="K", default=STEPS, help=told)
    add_rounds(parser, 128, 7, LEAST_ROUNDS)
    return parser


if __name__ == "__main__":
    sys.exit(main())
