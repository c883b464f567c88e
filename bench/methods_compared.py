"""False alarms of `glrt compare` between different methods, where the noise of one is rare light.

`python -m bench.methods_compared` prints a table of docs/results/compare.md: pairs of renders of
one scene by two methods, 64 x 48 pixels, with Sobol' points. A reference serves 20 pairs at most,
an image one.
"""

import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from bench.false_alarms import ALPHA, markdown, wilson
from bench.program import at_least, exit_code_of, machine, parser_of
from glrt.analysis.stress.noisy_scenes import CASES
from glrt.comparison.result import Comparison, percent
from glrt.comparison.verdict import compare
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene
from glrt.settings import Method

WIDTH, HEIGHT, BOUNCES = 64, 48, 6
PAIRS_OF_A_REFERENCE = 20
REFERENCE_SEED = 1 << 20

HEAD = [
    *("scene", "methods", "samples", "called different", "95 % interval", "chance of as many"),
    *("same", "heavy tails", "change found"),
]


def metal_balls(roughest: float) -> Scene:
    """Four metal balls, of roughness 0.1 to `roughest`, on a matte floor under two quad lamps."""
    balls = {f"metal {k}": 0.1 + k / 3 * (roughest - 0.1) for k in range(4)}
    metals = {
        name: {"type": "metal", "color": [0.9, 0.85, 0.8], "roughness": roughness}
        for name, roughness in balls.items()
    }
    lamp = {"shape": "quad", "edge_u": [0.5, 0, 0], "edge_v": [0, 0, 0.5], "material": "lamp"}
    return parse_scene(
        {
            "camera": {"position": [0.0, 1.6, 4.5], "look_at": [0.0, 0.4, 0.0], "fov": 40.0},
            "materials": {
                "floor": {"type": "lambertian", "color": [0.7, 0.7, 0.7]},
                "lamp": {"type": "light", "emission": [12.0, 12.0, 12.0]},
                **metals,
            },
            "objects": [
                {"shape": "plane", "point": [0, 0, 0], "normal": [0, 1, 0], "material": "floor"},
                *(
                    {"shape": "sphere", "center": [k - 1.5, 0.45, 0], "radius": 0.45, "material": m}
                    for k, m in enumerate(balls)
                ),
                *({**lamp, "corner": [left, 2.5, -0.3]} for left in (-1.2, 0.8)),
            ],
        },
        "metal balls",
    )


@dataclass(frozen=True)
class Contest:
    """A scene by two methods, each with its samples a pixel."""

    scene: Scene
    image: tuple[Method, int]
    reference: tuple[Method, int]


def contests() -> dict[str, Contest]:
    """The scenes of the table, by name."""
    return {
        "metal balls, roughness 0.1 to 0.15": Contest(
            metal_balls(0.15), ("nee", 256), ("mis", 1024)
        ),
        "metal balls, roughness 0.1 to 0.4": Contest(metal_balls(0.4), ("nee", 256), ("mis", 1024)),
        "metals": Contest(load("metals"), ("nee", 128), ("mis", 256)),
        "caustic": Contest(CASES["caustic"].scene, ("nee", 64), ("mis", 1024)),
        "small lamp": Contest(CASES["small lamp"].scene, ("naive", 256), ("mis", 256)),
        "diffuse": Contest(CASES["diffuse"].scene, ("naive", 64), ("mis", 256)),
    }


def renders(
    context: Context, scene: Scene, method: tuple[Method, int], count: int, seed: int
) -> Iterator[Image]:
    """Independent renders, of the seeds `seed` to `seed` + `count` - 1."""
    renderer = Renderer(
        scene, context=context, width=WIDTH, height=HEIGHT, bounces=BOUNCES, method=method[0]
    )
    for k in range(count):
        renderer.update(seed=seed + k)
        yield renderer.render(method[1]).image()
    renderer.release()


def compared(context: Context, contest: Contest, pairs: int) -> list[Comparison]:
    """Each image with a reference of its twenty."""
    count = math.ceil(pairs / PAIRS_OF_A_REFERENCE)
    references = list(renders(context, contest.scene, contest.reference, count, REFERENCE_SEED))
    images = renders(context, contest.scene, contest.image, pairs, 0)
    return [compare(image, references[k % count], ALPHA) for k, image in enumerate(images)]


def chance_of_as_many(alarms: int, pairs: int) -> float:
    """That so many or more happen if each has the probability `ALPHA`."""
    terms = (math.comb(pairs, k) * ALPHA**k * (1 - ALPHA) ** (pairs - k) for k in range(alarms))
    return max(1 - math.fsum(terms), 0.0)


def row(name: str, contest: Contest, found: list[Comparison]) -> list[str]:
    """Of the table."""
    alarms = sum(not comparison for comparison in found)
    low, high = wilson(alarms, len(found))
    size = float(np.median([comparison.sensitivity.light for comparison in found]))
    return [
        name,
        f"{contest.image[0]} against {contest.reference[0]}",
        f"{contest.image[1]} / {contest.reference[1]}",
        f"{alarms} of {len(found)}",
        f"{100 * low:.1f} to {100 * high:.1f} %",
        f"{chance_of_as_many(alarms, len(found)):.2g}",
        str(sum(comparison.verdict == "same" for comparison in found)),
        str(sum(bool(comparison.heavy_tails) for comparison in found)),
        percent(size) if size < 10 else "none",
    ]


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.methods_compared`; returns the exit code."""
    parser = parser_of("methods_compared", __doc__)
    parser.add_argument("--pairs", type=at_least(1), default=300, metavar="N", help="pairs per row")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed.pairs))


def _print(pairs: int) -> None:
    context = open_context()
    print(f"{machine(context.renderer)}, {WIDTH} x {HEIGHT} pixels, alpha {ALPHA}")
    rows: list[Any] = [
        row(name, contest, compared(context, contest, pairs))
        for name, contest in contests().items()
    ]
    print("\n" + markdown(HEAD, rows), flush=True)


if __name__ == "__main__":
    sys.exit(main())
