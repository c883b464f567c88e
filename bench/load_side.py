"""Frames of one scene for some seconds: the process that `bench.load` starts for each row.

    python -m bench.load_side WORK.json

A frame is what the thesis draws: one sample of each pixel, added to the film, and a full-screen
quad that shows it, here on a texture in place of a window.
"""

import json
import sys
import time
from dataclasses import dataclass
from typing import Any

from bench.against_side import peak_bytes
from glrt.core.errors import GlrtError
from glrt.image.sources import load
from glrt.process.load import Load, LoadMeter, mean_of
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.display import Display
from glrt.settings import MAX_SAMPLES

PERIOD = 0.5  # seconds between readings of the load
WARM_UP = 3  # frames before the first that counts


@dataclass(frozen=True)
class Work:
    """A scene, the settings of a renderer, and for how long frames are drawn."""

    scene: str
    options: dict[str, Any]  # of glrt.Renderer
    seconds: float
    limit: float  # most frames a second, as by v-sync; 0: none


def measure(work: Work) -> dict[str, Any]:
    """Draw frames; return the load with the driver, the frame's size and the peak of memory."""
    renderer = Renderer(load(work.scene), **work.options)
    loads, meter = loads_of(renderer, work)
    found = mean_of(loads)
    return {
        "renderer": renderer.context.renderer,
        "size": renderer.size,
        "frames_per_second": found.rate,
        "cpu": found.cpu,
        "gpu": found.gpu,
        "gpu_unknown": meter.gpu.unknown,
        "peak_bytes": peak_bytes(),
    }


def loads_of(renderer: Renderer, work: Work) -> tuple[list[Load], LoadMeter]:
    """Draw frames until their periods have lasted the seconds of the work."""
    gl, loads = renderer.context.gl, list[Load]()
    with gl:
        display, target = Display(gl), gl.simple_framebuffer(renderer.size, 4)
        target.use()

        def draw() -> None:
            if renderer.samples == MAX_SAMPLES:
                renderer.restart()
            renderer.step(1)
            with gl.scope(target):
                display.draw(renderer.weighed(renderer.plan.weights), renderer.settings)
            gl.finish()

        for _ in range(WARM_UP):
            draw()
        meter = LoadMeter(renderer.context.renderer, min(PERIOD, work.seconds))
        while sum(it.seconds for it in loads) < work.seconds:
            start = time.perf_counter()
            draw()
            if work.limit:
                time.sleep(max(0.0, 1 / work.limit - (time.perf_counter() - start)))
            if found := meter.look():
                loads.append(found)
        display.release()
        target.release()
    return loads, meter


def main(work: str) -> None:
    """Print the result, or the error, as JSON."""
    try:
        found = measure(Work(**json.loads(work)))
    except GlrtError as error:
        found = {"error": str(error)}
    print(json.dumps(found), flush=True)


if __name__ == "__main__":
    main(sys.argv[1])
