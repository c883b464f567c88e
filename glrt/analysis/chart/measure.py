"""Error against time: every variant in every round, in another order each time.

A round renders each variant from an empty film with random numbers of its own and looks at the
error at 1, 2, 4, ... samples a pixel. Whatever else the machine does meets all variants.
"""

import random
import time
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from glrt.analysis.chart.flip import flip, is_installed
from glrt.analysis.reference import Reference
from glrt.analysis.variants import Variant
from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import MAX_SAMPLES

WARM_UP = 3  # dispatches that are not counted
LEAST_LOOKS = 6  # 32 samples: two observations of any sampler, so that the noise is known


class Look(NamedTuple):
    """A picture on its way: its squared relative error, and what it took."""

    samples: int  # a pixel
    seconds: float
    squared_error: float
    flip: float | None = None  # how different it looks, where that was asked


class Run(NamedTuple):
    """One variant in one round."""

    variant: str
    looks: list[Look]
    squared_bias: float  # estimated at the last look; around 0 where there is none


Round = list[Run]


class Bench:
    """The variants of a scene, compiled and warm, ready for any number of rounds."""

    def __init__(
        self, scene: Scene, variants: Sequence[Variant], reference: Reference, context: Context
    ) -> None:
        """Compile every variant; its errors are judged by `reference`."""
        self._reference = reference
        self._renderers = {
            variant.name: Renderer(scene, variant.settings, context, tier="baked")
            for variant in variants
        }
        for renderer in self._renderers.values():
            for _ in range(WARM_UP):
                renderer.step(1)

    def round(self, number: int, seconds: float) -> Iterator[Round]:
        """Run each variant once, all in about `seconds`; yields the runs so far after each.

        The number chooses order and seeds. Round 0 asks FLIP, where it is installed: of a mean
        over pixels one picture tells enough, and it takes longer than most looks.
        """
        asks_flip = number == 0 and is_installed()
        names = list(self._renderers)
        random.Random(number).shuffle(names)
        runs: Round = []
        for name in names:
            self._renderers[name].update(seed=number + 1)
            share = seconds / len(names)
            runs.append(_run(name, self._renderers[name], self._reference, share, asks_flip))
            yield runs

    def release(self) -> None:
        """Free what the driver holds."""
        for renderer in self._renderers.values():
            renderer.release()


def _run(
    name: str, renderer: Renderer, reference: Reference, seconds: float, asks_flip: bool
) -> Run:
    looks: list[Look] = []
    spent = 0.0
    samples = 1
    while True:
        start = time.perf_counter()
        renderer.render(samples)
        spent += time.perf_counter() - start
        image = renderer.image()
        squared = reference.squared_error(image.radiance)
        look = flip(image.radiance, reference.radiance) if asks_flip else None
        looks.append(Look(samples, spent, squared, look))
        is_over = 2 * spent > seconds and len(looks) >= LEAST_LOOKS
        if is_over or samples == MAX_SAMPLES:
            noise = reference.relative(np.square(image.stderr, dtype=np.float64))
            return Run(name, looks, squared - noise)
        samples *= 2


def of_variant(rounds: Sequence[Round], name: str) -> list[Run]:
    """Its run in each round."""
    return [run for runs in rounds for run in runs if run.variant == name]
