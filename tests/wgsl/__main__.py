"""Renders a scene as the thesis did, on WebGPU: `python -m tests.wgsl SCENE -o FILE.exr`.

The file is like one of `glrt render --method naive --no-roulette`, and holds the same picture.
"""

import argparse
import json
import sys
import time
from typing import Any

from glrt.core.errors import GlrtError
from glrt.image.image import check_writable
from glrt.image.sources import load_recipe
from glrt.process.command import peak_bytes, since_start
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.wgsl.device import describe, open_device
from tests.wgsl.program import RayTracer
from tests.wgsl.tracer import Tracer, naive

SETTINGS = ("width", "height", "samples", "bounces", "seed")


def main(arguments: list[str] | None = None) -> int:
    """Returns the exit code, as `glrt render` does."""
    parsed = _parser().parse_args(arguments)
    try:
        check_writable(parsed.output)
        scene, recipe = load_recipe(parsed.scene)
        given = {name: getattr(parsed, name) for name in SETTINGS}
        chosen = {name: value for name, value in given.items() if value is not None}
        figures = _render(parsed, scene, naive(scene, recipe, **chosen))
    except GlrtError as error:
        print(f"glrt: {' '.join(str(error).split())}", file=sys.stderr)
        return error.exit_code
    rate, seconds = figures["samples_per_second"], figures["seconds"]["render"]
    told = f"Wrote {parsed.output} in {seconds:.1f} s ({rate / 1e6:.2f} million samples/s)."
    print(json.dumps(figures) if parsed.json else told)
    return 0


def _render(parsed: argparse.Namespace, scene: Scene, settings: Settings) -> dict[str, Any]:
    device = open_device()
    setup, start = since_start(), time.perf_counter()
    program = RayTracer(device)
    Tracer(program, scene, naive(scene, settings, width=1, height=1)).render(1)  # drivers wait
    compiled = time.perf_counter()  # until the first dispatch with their compiling
    tracer = Tracer(program, scene, settings).render()
    done = time.perf_counter()
    image = tracer.image()
    image.save(parsed.output)
    seconds = {"setup": setup, "compile": compiled - start, "render": done - compiled}
    work = settings.width * settings.height * settings.samples
    return {
        "scene": parsed.scene,
        **{name: getattr(settings, name) for name in (*SETTINGS, "method")},
        "pipeline": "wgsl",
        "context": "wgpu",
        "renderer": describe(device),
        "seconds": {name: round(value, 6) for name, value in seconds.items()},
        "samples_per_second": round(work / (done - compiled), 1),
        "error": image.error,
        "nonfinite": tracer.nonfinite(),
        "peak_bytes": peak_bytes(),
    }


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.wgsl", description=__doc__)
    add = parser.add_argument
    add("scene", metavar="SCENE", help="a scene file, a name, or a picture rendered by glrt")
    add("-o", dest="output", metavar="FILE", required=True, help=".exr, .png or .npy")
    for name in SETTINGS:
        help_text = f"{Settings.model_fields[name].description} (default: the scene's)"
        add(f"--{name}", type=int, metavar="N", help=help_text)
    add("--json", action="store_true", help="one line of figures")
    return parser


if __name__ == "__main__":
    sys.exit(main())
