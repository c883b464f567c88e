"""One way to render one scene, in a process of its own: what `bench.gpu` starts for each.

    python -m bench.gpu_way WORK.json PICTURES.npy

What was measured is printed as a line of JSON; a failure is one, too, if the driver lets it.
"""

import json
import statistics
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bench.against_side import peak_bytes
from bench.dispatches import longest
from glrt.gpu.context import Context, Pipeline, open_context, open_device
from glrt.image.image import Pixels
from glrt.image.sources import load
from glrt.rendering.pipelines import Tier
from glrt.rendering.renderer import Renderer

SEEDS = 1, 2  # of the pictures; the first one warms up


@dataclass(frozen=True)
class Work:
    """A way, a scene, and how much of it."""

    route: str  # or "auto"
    device: int  # of those that the route offers
    pipeline: Pipeline
    tier: Tier
    scene: str
    size: int  # pixels a side
    samples: int  # a pixel
    seconds: float  # the last picture is rendered again until so much time is spent


def measure(work: Work, pictures: Path) -> dict[str, Any]:
    """The figures; the pictures of both seeds, (2, H, W, 3), go to a file."""
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
        "tier": renderer.tier,  # many shapes are never baked
        "compile_seconds": renderer.compile_seconds,
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
    """Render the same picture again and again; once at least. The time of each is added."""
    while sum(taken) < seconds or not taken:
        start = time.perf_counter()
        renderer.restart()
        renderer.render()
        taken.append(time.perf_counter() - start)


def main(work: str, pictures: str) -> None:
    """Tell what was found."""
    try:
        found = measure(Work(**json.loads(work)), Path(pictures))
    except Exception as error:  # whatever a driver does is a finding
        kind = type(error).__name__
        found = {"error": f"{kind}: {' '.join(str(error).split())}"}
    print(json.dumps(found), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
