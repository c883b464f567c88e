"""Whether `--caustics auto` chooses the best: `python -m bench.choices [SCENE...]`.

Each choice is rendered by force, in turns with the others, and its efficiency is 1 / (variance x
time). The efficiency of the choice of the pilot is given as a share of the best.
"""

import argparse
import math
import time

from bench.program import at_least, exit_code_of, machine, parser_of
from glrt.analysis.method_choice.caustics import CHOICES, around, particles_worth, variance_of
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.plan.facts import SceneFacts
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import RenderSettings, Settings, settings_for
from tests.support.sun_map import even_sky, sun_map

OWN = {"sun map": sun_map, "even sky": even_sky}  # scenes that are made here
SCENES = (
    *("sun map", "even sky", "sky", "weekend", "table", "drink", "water", "stage"),
    *("cornell", "methods/caustic", "methods/glass", "methods/gap"),
)
STEP = 16  # samples of a turn
LONG = 4096  # samples of the render that a pilot decides about
OFF = "off"


def main(arguments: list[str] | None = None) -> int:
    """Print a row for each scene; returns the exit code."""
    parser = parser_of("choices", __doc__)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", default=SCENES, help="default: 12")
    parser.add_argument("--samples", type=at_least(STEP), default=256, help="default: 256")
    parser.add_argument("--size", type=at_least(16), default=128, help="default: 128")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _run(parsed))


def _run(parsed: argparse.Namespace) -> None:
    context = open_context()
    print(
        "| scene | efficiency of each choice over none | chosen | of the best |\n|---|---|---|---|"
    )
    for name in parsed.scenes:
        scene = OWN[name]() if name in OWN else load(name)
        mis = RenderSettings.model_validate({**dict(scene.render), "method": "mis"})
        print(_row(name, scene.model_copy(update={"render": mis}), parsed, context), flush=True)
    print(f"\n{machine(context.renderer)}")


def _row(name: str, scene: Scene, parsed: argparse.Namespace, context: Context) -> str:
    wide = math.sqrt(scene.render.width / scene.render.height)
    sides = {"width": round(parsed.size * wide), "height": round(parsed.size / wide)}
    settings = settings_for(scene.render, samples=LONG, **sides)
    ways = _ways(scene, settings)
    found = _efficiencies(scene, ways, parsed.samples, context)
    chosen = particles_worth(scene, settings, context)
    assert chosen
    way = next(label for label, own in ways.items() if own == chosen.settings)
    gains = ", ".join(f"{found[label] / found[OFF]:.2f}" for label in ways if label != OFF)
    return f"| `{name}` | {gains} | {way} | {found[way] / max(found.values()):.2f} |"


def _ways(scene: Scene, settings: Settings) -> dict[str, Settings]:
    """The settings of a render without particles, and of each choice, by a label."""
    found = {OFF: settings_for(settings, caustics="off")}
    has_links = SceneFacts(scene).particles.links != 0
    for choice in CHOICES:
        if has_links or not choice["linked"]:
            label = ", ".join(f"{value:g}" for value in choice.values())
            found[label] = settings_for(settings, caustics="on", **choice)
    return found


def _efficiencies(
    scene: Scene, ways: dict[str, Settings], samples: int, context: Context
) -> dict[str, float]:
    renderers = {label: Renderer(scene, own, context, "complete") for label, own in ways.items()}
    seconds = dict.fromkeys(ways, 0.0)
    for target in range(STEP, samples + 1, STEP):
        for label, renderer in renderers.items():
            start = time.perf_counter()
            renderer.render(target)
            seconds[label] += time.perf_counter() - start
    images = {label: renderer.image() for label, renderer in renderers.items()}
    for renderer in renderers.values():
        renderer.release()
    level = around(next(image for label, image in images.items() if label != OFF).radiance)
    return {
        label: 1 / (variance_of(level, image.stderr) * seconds[label])
        for label, image in images.items()
    }


if __name__ == "__main__":
    raise SystemExit(main())
