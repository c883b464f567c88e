"""Variance and time with lamps chosen by flux and distance, in scenes of many small lamps.

`hall`: spherical lamps of random flux below the ceiling of a hall; `mixed`: every other one is a
quad; `around`: lamps on a sphere around two small spheres, all at nearly the same distance, so
that distances cannot reduce the variance.
"""

import math
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from bench.efficiency import Row, Way, measure_scene, table
from bench.program import add_rounds, add_tables, exit_code_of, machine, parser_of
from bench.shader_edits import Edit
from bench.steps import BY_FLUX
from glrt.analysis.stress.scenes import lamp, matte, plane, quad, scene_of, sphere
from glrt.gpu.context import open_context
from glrt.scene.scene import Scene

COUNTS = (16, 32, 64, 300, 2000, 10_000)
PARTS_BY_FLUX = [
    Edit(
        "lights/choice.glsl",
        "    precise vec3 away",
        "    if (index >= CLUSTERS) return cluster.probability;\n    precise vec3 away",
    )
]
WAYS = {
    "by flux alone": Way({}, BY_FLUX),
    "clusters by distance, lamps in them by flux": Way({}, PARTS_BY_FLUX),
    "clusters and their parts by distance: the default": Way({}),
}
Array = np.ndarray[Any, Any]


def hall(count: int, panels: bool = False) -> Scene:
    """Lamps of random flux, 0.1 to 0.5 below the ceiling of a hall of 10 x 4 x 12 scene units."""
    random = np.random.default_rng(1)
    places = random.uniform([-4, 1.5, -9], [4, 1.9, -1], (count, 3))
    size = _size(count)
    lamps = [
        quad(place, [2 * size, 0, 0], [0, 0, 2 * size], str(number))
        if panels and number % 2
        else sphere(place, size, str(number))
        for number, place in enumerate(places)
    ]
    ends = [([0, -2, 0], [0, 1, 0]), ([0, 2, 0], [0, -1, 0]), ([-5, 0, 0], [1, 0, 0])]
    ends += [([5, 0, 0], [-1, 0, 0]), ([0, 0, -10], [0, 0, 1]), ([0, 0, 2], [0, 0, -1])]
    balls = [sphere([x, -1.5, -5], 0.5, "matte") for x in (-2, 0, 2)]
    walls = [plane(point, normal, "matte") for point, normal in ends]
    return _lit([*walls, *balls, *lamps], random.lognormal(0, 0.7, count))


def around(count: int) -> Scene:
    """Lamps of random flux on a sphere of radius 50 around two spheres of radius 1."""
    random = np.random.default_rng(1)
    places = random.normal(size=(count, 3))
    places *= 50 / np.linalg.norm(places, axis=1, keepdims=True)
    lamps = [sphere(place, 10 * _size(count), str(n)) for n, place in enumerate(places)]
    balls = [sphere([0, 0, -5], 1, "matte"), sphere([1.5, 0, -6], 1, "matte")]
    return _lit([*balls, *lamps], 100 * random.lognormal(0, 0.7, count))


SCENES = {"hall": hall, "mixed": lambda count: hall(count, panels=True), "around": around}


def _size(count: int) -> float:
    """Half edge or radius of a lamp, smaller for many lamps so that they do not overlap."""
    return 0.05 * min(1.0, math.sqrt(300 / count))


def _lit(objects: list[dict[str, Any]], radiance: Array) -> Scene:
    """A scene of `objects`; the lamps, named by number, have 20 times the given radiances."""
    lamps = {str(number): lamp(20 * float(value)) for number, value in enumerate(radiance)}
    return scene_of(objects, {"matte": matte(0.7), **lamps}, {"fov": 60}, render={"bounces": 4})


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.many_lamps`; returns the exit code."""
    parser = parser_of("many_lamps", __doc__)
    add_tables(parser, SCENES)
    parser.add_argument("--counts", nargs="+", type=int, metavar="N", default=COUNTS)
    add_rounds(parser, size=64, rounds=8)
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed.tables, parsed.counts, parsed.size, parsed.rounds))


def _print(names: Sequence[str], counts: Sequence[int], size: int, rounds: int) -> None:
    context = open_context()
    rows: list[Row] = []
    for name in names:
        for count in counts:
            title = f"{name}, {count} lamps"
            print(f"{title} ...", file=sys.stderr)
            rows += measure_scene(context, title, SCENES[name](count), size, rounds, WAYS)
    print(f"{machine(context.renderer)}, {size} x {size} pixels, {rounds} rounds\n")
    print("\n".join(table(rows)))


if __name__ == "__main__":
    sys.exit(main())
