"""The gain by samples of lamps along segments through fog: `python -m bench.foggy`.

Each scene is rendered with and without them, in turns. The efficiency is 1 / (error^2 x time), and
its ratio the median over the rounds.
"""

import argparse
import time
from statistics import median
from typing import Any

from bench.program import at_least, exit_code_of, machine, parser_of
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from tests.support.builders import box, disk, lamp, plane, scene_of, sphere

VARIANTS = {"with": PLAIN, "without": Variant({"HAS_EQUIANGULAR": False})}
FIRST = 16  # samples that are not measured
AXIS = [0.62, -0.78, -0.05]
THIN = {"scattering": [0.16, 0.17, 0.185], "absorption": [0.006] * 3, "anisotropy": 0.35}
THICK = {"scattering": [1.0, 2.0, 0.5], "absorption": [0.1, 0.1, 0.3], "anisotropy": 0.6}


def main(arguments: list[str] | None = None) -> int:
    """Print a row for each scene; returns the exit code."""
    parser = parser_of("foggy", __doc__)
    parser.add_argument("--samples", type=at_least(16), default=128, help="default: 128")
    parser.add_argument("--rounds", type=at_least(1), default=5, help="default: 5")
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    context = open_context()
    print("| scene | error | without | time, s | without | efficiency over without |")
    print("|---|---|---|---|---|---|")
    for name, scene in _scenes().items():
        print(_row(name, scene, parsed, context), flush=True)
    print(f"\n{machine(context.renderer)}")


def _row(name: str, scene: Scene, parsed: argparse.Namespace, context: Context) -> str:
    found: dict[str, list[tuple[float, float]]] = {way: [] for way in VARIANTS}
    for seed in range(parsed.rounds):
        for way, variant in VARIANTS.items():
            found[way].append(_figures(scene, variant, seed, parsed.samples, context))
    gains = [
        (other[0] / own[0]) ** 2 * other[1] / own[1]
        for own, other in zip(*found.values(), strict=True)
    ]
    errors = [median(it[0] for it in figures) for figures in found.values()]
    times = [median(it[1] for it in figures) for figures in found.values()]
    cells = [f"{100 * error:.1f} %" for error in errors] + [f"{it:.2f}" for it in times]
    return f"| {' | '.join([name, *cells])} | {median(gains):.2f} |"


def _figures(
    scene: Scene, variant: Variant, seed: int, samples: int, context: Context
) -> tuple[float, float]:
    """Return estimated error and seconds of a render."""
    size: dict[str, Any] = {"width": 64, "height": 48, "bounces": 5, "seed": seed}
    renderer = Renderer(scene, context=context, variant=variant, **size)
    try:
        renderer.render(FIRST)
        start = time.perf_counter()
        image = renderer.render(samples).image()
        seconds = time.perf_counter() - start
    finally:
        renderer.release()
    assert image.error is not None
    return image.error, seconds


def _scenes() -> dict[str, Scene]:
    spot = {"type": "light", "emission": [150.0, 137.0, 117.0]}
    cone = {"axis": AXIS, "inner": 12.0, "outer": 14.0}
    high = disk([-2.6, 3.6, 0.3], AXIS, 0.3, "lamp")
    bulb = sphere([0.3, 1.6, 0.3], 0.05, "lamp")
    large = sphere([0.3, 2.2, 0.3], 0.4, "lamp")
    return {
        "a bulb in thin fog": _room(bulb, lamp(400.0), THIN),
        "a spotlight in thin fog": _room(high, {**spot, "cone": cone}, THIN),
        "a bulb in thick fog": _room(bulb, lamp(400.0), THICK),
        "a large lamp in thin fog": _room(large, lamp(6.0), THIN),
        "`fog`": load("fog"),
    }


def _room(thing: dict[str, Any], material: dict[str, Any], fog: dict[str, Any]) -> Scene:
    return scene_of(
        [
            {**box([-6, -0.5, -4], [6, 5, 8], "none"), "medium": "fog"},
            plane([0, 0, 0], [0, 1, 0], "white"),
            plane([0, 0, -2.6], [0, 0, 1], "white"),
            sphere([-0.75, 1.3, 0.12], 0.34, "white"),
            thing,
        ],
        {"white": {"type": "lambertian", "color": [0.7] * 3}, "lamp": material},
        {"position": [0, 1.5, 6.5], "look_at": [0, 1.25, 0], "fov": 36},
        media={"fog": fog},
    )


if __name__ == "__main__":
    raise SystemExit(main())
