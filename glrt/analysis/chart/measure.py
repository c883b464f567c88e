"""Error against time: interleaved rounds of all variants, each round in another order.

A round renders each variant from an empty film with its own seed, and computes the error at 1, 2,
4, ... samples per pixel. Interleaving lets other load on the machine affect all variants alike.
"""

import random
import time
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.analysis.chart.flip import flip, is_installed
from glrt.analysis.reference import Reference
from glrt.analysis.variants import Variant
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import MAX_SAMPLES

WARM_UP = 3  # dispatches before the first that is timed
LEAST_SAMPLES = 32
SETTLED = 100  # updates of live probes before a picture: they keep 5 % of where they began


class Look(NamedTuple):
    """A picture at one number of samples: its squared relative error, and the time that it took."""

    samples: int  # per pixel
    seconds: float  # to render it, and to denoise it once
    squared_error: float
    flip: float | None = None  # None where it was not computed


class Run(NamedTuple):
    """One variant in one round."""

    variant: str
    looks: list[Look]
    squared_bias: float  # unbiased estimate at the last look; it may be negative


Round = list[Run]


class _Picture(NamedTuple):
    """The picture that is shown, and its standard error by its own estimate, (H, W, 3) each."""

    shown: NDArray[np.float32]
    noise: NDArray[np.float32] | None  # None before two observations
    is_denoised: bool = False


class Bench:
    """The variants of a scene, compiled and warmed up, for any number of rounds."""

    def __init__(
        self, scene: Scene, variants: Sequence[Variant], reference: Reference, context: Context
    ) -> None:
        """Compile every variant; errors are relative to `reference`."""
        self._reference = reference
        self._live = {it.name: it.hysteresis for it in variants if it.hysteresis is not None}
        self._renderers = {
            variant.name: Renderer(scene, variant.settings, context, tier="complete")
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
            renderer = self._renderers[name]
            if hysteresis := self._live.get(name):
                _settle(renderer, hysteresis)
            renderer.update(seed=number + 1, hysteresis=hysteresis)
            share = seconds / len(names)
            runs.append(_run(name, renderer, self._reference, share, with_flip))
            yield runs

    def pictures(self, name: str, samples: Sequence[int]) -> Iterator[Image]:
        """Render a variant again; yield its picture at each number of samples, ascending."""
        self._renderers[name].update(seed=1)
        for wanted in samples:
            self._renderers[name].render(wanted)
            yield self._renderers[name].image()

    def release(self) -> None:
        """Release the resources of all renderers."""
        for renderer in self._renderers.values():
            renderer.release()


def _settle(renderer: Renderer, hysteresis: float) -> None:
    """Update live probes until little is left of the probes before; each picture updates once."""
    renderer.render(1)  # with warm probes, if these are the first
    renderer.update(hysteresis=hysteresis)
    for _ in range(SETTLED):
        renderer.restart()
        renderer.render(1)


def _run(
    name: str, renderer: Renderer, reference: Reference, seconds: float, with_flip: bool
) -> Run:
    """Double the samples until the next doubling would exceed `seconds`.

    Rendering and denoising are timed alone. Pictures that have too few samples to be denoised are
    left out where that is asked for.
    """
    is_denoised = renderer.settings.denoise != "none"
    least = max(LEAST_SAMPLES, renderer.settings.division.least_known)
    looks: list[Look] = []
    spent = 0.0
    samples = 1
    while True:
        start = time.perf_counter()
        renderer.render(samples)
        middle = time.perf_counter()
        picture = _picture_of(renderer)
        filtering = time.perf_counter() - middle if is_denoised else 0.0
        spent += middle - start
        if picture.is_denoised == is_denoised:
            squared = reference.squared_error(picture.shown)
            look = flip(picture.shown, reference.radiance) if with_flip else None
            looks.append(Look(samples, spent + filtering, squared, look))
        is_over = bool(looks) and 2 * spent > seconds and samples >= least
        if is_over or samples == MAX_SAMPLES:
            assert picture.noise is not None  # it has two observations, and was denoised here
            noise = reference.relative(np.square(picture.noise, dtype=np.float64))
            return Run(name, looks, looks[-1].squared_error - noise)
        samples *= 2


def _picture_of(renderer: Renderer) -> _Picture:
    if renderer.probes.hysteresis is not None:  # no other picture is possible
        with renderer.context.gl:
            return _Picture(*renderer.picture(renderer.plan.weights))
    image = renderer.image()
    denoising = image.denoising
    noise = denoising.noise if denoising else image.stderr
    return _Picture(image.shown, noise, bool(denoising))


def of_variant(rounds: Sequence[Round], name: str) -> list[Run]:
    """The runs of the variant `name`, one per round."""
    return [run for runs in rounds for run in runs if run.variant == name]
