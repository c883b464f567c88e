"""glrt as a peer of `bench.peer`, so that it starts, waits and is timed as other renderers are."""

import sys
import time
from dataclasses import replace
from functools import lru_cache

from bench.peer import Request, serve
from glrt.analysis.method_choice.caustics import may_gain, particles_worth
from glrt.core.errors import GlrtError
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for

LENGTH = 1 << 16  # samples per pixel of a long render, for which `--caustics auto` takes all pilots


def main() -> int:
    """Until stdin ends; another exit code if there is no OpenGL."""
    try:
        context = open_context()
    except GlrtError as error:
        print(error, file=sys.stderr)
        return error.exit_code

    @lru_cache(maxsize=4)
    def renderer(asked: Request) -> Renderer:
        """As `glrt render` makes it."""
        scene = asked.parsed()
        size = {"width": asked.width, "height": asked.height, "bounces": asked.bounces}
        paths = {"method": asked.method, "roulette": asked.roulette}
        sampler = {"sampler": asked.sampler} if asked.sampler else {}
        settings = settings_for(scene.render, **size, **paths, **sampler)
        if asked.chooses:
            settings = with_particles(scene, settings, context)
        return Renderer(scene, settings, context, "complete")

    def render(request: Request) -> tuple[Image, float]:
        ready = renderer(replace(request, samples=1, seed=0, batches=1))
        start = time.perf_counter()
        ready.update(seed=request.seed)
        ready.restart()  # also for the seed of the last picture
        image = ready.render(request.samples).image()
        return image, time.perf_counter() - start

    serve(str(context.renderer), render)
    return 0


def with_particles(scene: Scene, settings: Settings, context: Context) -> Settings:
    """Settings with the particles that `--caustics auto` chooses for a long render."""
    long = settings_for(settings, samples=LENGTH)
    found = particles_worth(scene, long, context) if may_gain(scene, long) else None
    return found.settings if found else settings


if __name__ == "__main__":
    sys.exit(main())
