"""Error against time: interleaved rounds of all variants, each round in another order.

A round renders each variant from an empty film with its own seed, and computes the error at 1, 2,
4, ... samples per pixel. Interleaving lets other load on the machine affect all variants alike.
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

WARM_UP = 3  # dispatches before the first that is timed
LEAST_LOOKS = 6  # up to 32 samples: two observations of any sampler, which give a standard error


class Look(NamedTuple):
    """A picture at one number of samples: its squared relative error and the time spent so far."""

    samples: int  # per pixel
    seconds: float
    squared_error: float
    flip: float | None = None  # None where it was not computed


class Run(NamedTuple):
    """One variant in one round."""

    variant: str
    looks: list[Look]
    squared_bias: float  # unbiased estimate at the last look; it may be negative


Round = list[Run]


class Bench:
    """The variants of a scene, compiled and warmed up, for any number of rounds."""

    def __init__(
        self, scene: Scene, variants: Sequence[Variant], reference: Reference, context: Context
    ) -> None:
        """Compile every variant; errors are relative to `reference`."""
        self._reference = reference
        self._renderers = {
            variant.name: Renderer(scene, variant.settings, context, tier="baked")
            for variant in variants
        }
        for renderer in self._renderers.values():
            for _ in range(WARM_UP):
                renderer.step(1)

    def round(self, number: int, seconds: float) -> Iterator[Round]:
        """Run each variant once, all in about `seconds`; yield the runs so far after each.

        The order and the seeds follow from `number`. FLIP is computed in round 0 alone, where it is
        installed: it is a mean over pixels, which varies little between rounds, and it is slow.
        """
        with_flip = number == 0 and is_installed()
        names = list(self._renderers)
        random.Random(number).shuffle(names)
        runs: Round = []
        for name in names:
            self._renderers[name].update(seed=number + 1)
            share = seconds / len(names)
            runs.append(_run(name, self._renderers[name], self._reference, share, with_flip))
            yield runs

    def release(self) -> None:
        """Release the resources of all renderers."""
        for renderer in self._renderers.values():
            renderer.release()


def _run(
    name: str, renderer: Renderer, reference: Reference, seconds: float, with_flip: bool
) -> Run:
    """Double the samples until the next doubling would exceed `seconds`; time rendering alone."""
    looks: list[Look] = []
    spent = 0.0
    samples = 1
    while True:
        start = time.perf_counter()
        renderer.render(samples)
        spent += time.perf_counter() - start
        image = renderer.image()
        squared = reference.squared_error(image.radiance)
        look = flip(image.radiance, reference.radiance) if with_flip else None
        looks.append(Look(samples, spent, squared, look))
        is_over = 2 * spent > seconds and len(looks) >= LEAST_LOOKS
        if is_over or samples == MAX_SAMPLES:
            noise = reference.relative(np.square(image.stderr, dtype=np.float64))
            return Run(name, looks, squared - noise)
        samples *= 2


def of_variant(rounds: Sequence[Round], name: str) -> list[Run]:
    """The runs of the variant `name`, one per round."""
    return [run for runs in rounds for run in runs if run.variant == name]
