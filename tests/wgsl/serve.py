"""A peer of `bench.peer`: `python -m tests.wgsl.serve` renders by the WGSL version."""

import sys
import time

from bench.peer import Request, serve
from glrt.core.errors import GlrtError
from glrt.image.image import Image
from tests.wgsl.device import describe, open_device
from tests.wgsl.program import RayTracer
from tests.wgsl.tracer import Tracer, naive


def main() -> int:
    """Until stdin ends; another exit code if there is no WebGPU."""
    try:
        device = open_device()
        program = RayTracer(device)
    except GlrtError as error:
        print(error, file=sys.stderr)
        return error.exit_code

    def render(request: Request) -> tuple[Image, float]:
        size = {"width": request.width, "height": request.height}
        paths = {"bounces": request.bounces, "samples": request.samples, "seed": request.seed}
        scene = request.parsed()
        tracer = Tracer(program, scene, naive(scene, None, **size, **paths))
        start = time.perf_counter()
        image = tracer.render().image()
        return image, time.perf_counter() - start

    serve(f"WGSL, {describe(device)}", render)
    return 0


if __name__ == "__main__":
    sys.exit(main())
