"""One route, pipeline and tier with one scene: the process that `bench.gpu` starts for each.

    python -m bench.gpu_way WORK.json PICTURES.npy

It prints its result, or its error if the driver does not crash, as one line of JSON.
"""

import json
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

from bench.against_side import peak_bytes
from glrt.gpu.context import Context, Pipeline, open_context, open_device
from glrt.image.image import Pixels
from glrt.image.sources import load
from glrt.rendering.pipelines import Tier
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import DispatchPolicy
from glrt.rendering.tracer import Tracer

SEEDS = 1, 2  # of the pictures; the first one is also the warm-up


@dataclass(frozen=True)
class Work:
    """A route, pipeline and tier, a scene, and the amount of rendering."""

    route: str  # or "auto"
    device: int  # its number among the devices of the route
    pipeline: Pipeline
    tier: Tier
    scene: str
    size: int  # pixels a side
    samples: int  # per pixel
    seconds: float  # the last picture is repeated until this time has passed


def longest(work: Callable[[], object]) -> float:
    """Seconds of the longest dispatch of a tracer while `work` runs."""
    with _timed() as seconds:
        work()
    return max(seconds)


@contextmanager
def _timed() -> Iterator[list[float]]:
    """Seconds of every dispatch of a tracer, appended while the context lasts."""
    seconds: list[float] = []
    work_on = Tracer.work_on

    def timed(tracer: Tracer, remaining: int, policy: DispatchPolicy, seconds_left: float) -> None:
        start = time.perf_counter()
        work_on(tracer, remaining, policy, seconds_left)
        seconds.append(time.perf_counter() - start)

    with patch.object(Tracer, "work_on", timed):
        yield seconds


def measure(work: Work, pictures: Path) -> dict[str, Any]:
    """Return the figures; write the pictures of both seeds, (2, H, W, 3), to a file."""
    context = open_context() if work.route == "auto" else open_device(work.route, work.device)
    renderer = Renderer(
        load(work.scene),
        context=context,
        pipeline=work.pipeline,
        tier=work.tier,
        width=work.size,
        height=work.size,
        samples=work.samples,
    )
    images = [_picture(renderer, seed) for seed in SEEDS]
    np.save(pictures, np.stack(images))
    taken: list[float] = []
    dispatch = longest(lambda: _repeat(renderer, work.seconds, taken))
    return {
        **_opened(context),
        "tier": renderer.tier,  # scenes of many shapes are never baked
        "compile_seconds": renderer.seconds["compile"],
        "longest_dispatch": dispatch,
        "samples_per_second": work.samples * work.size**2 / statistics.median(taken),
        "peak_bytes": peak_bytes(),
    }


def _opened(context: Context) -> dict[str, Any]:
    return {
        "renderer": context.renderer,
        "version": context.version,
        "is_software": context.is_software,
    }


def _picture(renderer: Renderer, seed: int) -> Pixels:
    renderer.update(seed=seed)
    return renderer.render().image().radiance


def _repeat(renderer: Renderer, seconds: float, taken: list[float]) -> None:
    """Render the same picture at least once, for `seconds`; append each time to `taken`."""
    while sum(taken) < seconds or not taken:
        start = time.perf_counter()
        renderer.restart()
        renderer.render()
        taken.append(time.perf_counter() - start)


def main(work: str, pictures: str) -> None:
    """Print the result as JSON."""
    try:
        found = measure(Work(**json.loads(work)), Path(pictures))
    except Exception as error:  # any error of a driver is a result
        kind = type(error).__name__
        found = {"error": f"{kind}: {' '.join(str(error).split())}"}
    print(json.dumps(found), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
