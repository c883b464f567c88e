"""The number of nodes of the tree that a ray visits, alone and in groups of eight lanes.

Counted are the camera and scattered rays of each sample, without shadow rays. Software drivers
trace eight pixels of a row in parallel lanes, each its paths one after the other, so that every
search takes as long as that of the lane with the most visits.
"""

import argparse
import sys
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from bench.program import exit_code_of, machine, parser_of
from bench.shader_edits import Edit, edited
from bench.shape_counts import crowd
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.rendering.pipelines import Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene

Looks = NDArray[np.float32]

LANES = 8
CROWDS = (485, 2000, 10_000, 65_000)
SIZE = 96  # pixels a side
SAMPLES = 3


def looks_of(scene: Scene, context: Context, size: int, samples: int) -> Looks:
    """Nodes that each ray visits, (samples, rays of a path, size, size); 0 where there is no ray.

    `size` must be a multiple of LANES.
    """
    rays = range(scene.render.bounces + 1)
    return np.stack([_looks_at(depth, scene, context, size, samples) for depth in rays], axis=1)


def per_ray(looks: Looks) -> float:
    """The mean number of nodes over all rays."""
    return float(looks[looks > 0].mean())


def per_lanes(looks: Looks) -> float:
    """The mean, over the searches of eight lanes in parallel, of the largest number in a lane."""
    samples, rays = looks.shape[:2]
    lanes = looks.transpose(2, 3, 0, 1).reshape(-1, LANES, samples * rays)
    in_turn = np.take_along_axis(lanes, np.argsort(lanes == 0, axis=2, kind="stable"), axis=2)
    most = in_turn.max(axis=1)
    return float(most[most > 0].mean())


def table(scenes: dict[str, Scene], context: Context) -> Iterator[str]:
    """A row for each scene, as Markdown."""
    yield "| scene | nodes per ray | nodes in the slowest of eight lanes |"
    yield "|---|---|---|"
    for name, scene in scenes.items():
        looks = looks_of(scene, context, SIZE, SAMPLES)
        yield f"| {name} | {per_ray(looks):.1f} | {per_lanes(looks):.1f} |"


def _looks_at(depth: int, scene: Scene, context: Context, size: int, samples: int) -> Looks:
    """Nodes of the rays after `depth` bounces, (samples, size, size); one seed per sample."""
    renderer = Renderer(scene, context=context, variant=_counter(depth), width=size, height=size)
    pictures = []
    for seed in range(samples):
        renderer.update(seed=seed)
        pictures.append(renderer.render(1).image().radiance[..., 0])
    renderer.release()
    return np.stack(pictures)


def _counter(depth: int) -> Variant:
    """A kernel that renders the number of nodes visited by the ray of this depth, not radiance."""
    search = "    precise Hit hit = closest_hit(path.ray);\n"
    node = "        precise Node node = node_at(place);\n"
    hit = "struct Hit {"
    return edited(
        Edit("shapes/hit.glsl", hit, f"int looks = 0;\nint looks_then = 0;\n\n{hit}"),
        Edit("shapes/sphere_tree.glsl", node, f"{node}        looks += 1;\n"),
        Edit(
            "integrators/path.glsl",
            search,
            f"    looks = 0;\n{search}    if (path.depth == {depth}) looks_then = looks;\n",
        ),
        Edit("integrators/samples.glsl", ": path.radiance", ": vec3(looks_then)"),
    )


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.node_visits`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> None:
    context = open_context()
    crowds = {f"{count:,} spheres": crowd(count) for count in parsed.spheres}
    print(f"{machine(context.renderer)}, {SIZE} x {SIZE} pixels, {SAMPLES} samples\n")
    for line in table({**crowds, "`weekend`": load("weekend")}, context):
        print(line)


def _parser() -> argparse.ArgumentParser:
    parser = parser_of("node_visits", __doc__)
    parser.add_argument("--spheres", type=int, nargs="+", metavar="N", default=list(CROWDS))
    return parser


if __name__ == "__main__":
    sys.exit(main())
