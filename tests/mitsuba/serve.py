"""A peer of `bench.peer`: `python -m tests.mitsuba.serve` renders by Mitsuba."""

import sys
import time
from dataclasses import replace
from functools import lru_cache

from bench.peer import Request, serve
from glrt.core.errors import UsageError
from glrt.image.image import Image
from glrt.settings import settings_for
from tests.mitsuba.convert import Liberties
from tests.mitsuba.engine import Engine, load_mitsuba, name_of


def main() -> int:
    """Until stdin ends; 2 if there is no Mitsuba with LLVM."""
    try:
        mi = load_mitsuba("llvm")
    except UsageError as error:
        print(error, file=sys.stderr)
        return error.exit_code

    @lru_cache(maxsize=4)
    def engine(asked: Request) -> Engine:
        scene = asked.parsed()
        size = {"width": asked.width, "height": asked.height}
        paths = {"bounces": asked.bounces, "roulette": asked.roulette}
        sampler = asked.sampler or "independent"
        liberties = Liberties(asked.one_sided, asked.finite, asked.native, sampler)
        return Engine(mi, scene, settings_for(scene.render, **size, **paths), liberties)

    def render(request: Request) -> tuple[Image, float]:
        ready = engine(replace(request, samples=1, seed=0, batches=1))
        start = time.perf_counter()
        image = ready.image(request.samples, request.seed, request.batches)
        return image, time.perf_counter() - start

    serve(name_of(mi), render)
    return 0


if __name__ == "__main__":
    sys.exit(main())
