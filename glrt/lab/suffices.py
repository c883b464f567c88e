"""The cheapest method, and the fewest bounces, that show a scene to a given error.

Measured on a small frame. With two seeds, each for its own half of the reference, the mean of
(x1 - r1) (x2 - r2) is the squared bias of a method, without the noise of either. What a limit of
bounces cuts off is seen in the difference of two pictures that follow the same paths to their
limits: most of their noise is the same too.
"""

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from glrt.context import Context
from glrt.lab.experiment import frame_of
from glrt.lab.reference import Floats, Reference, reference_for
from glrt.lab.variants import METHODS, Variant, variants_of
from glrt.needs import LADDER
from glrt.renderer import Renderer
from glrt.scene import Scene
from glrt.settings import MAX_SAMPLES, Settings, settings_for

HEIGHT = 48  # pixels of the frame that is measured
SAMPLES = 128  # of each picture
MOST_TRIED = 16 * SAMPLES  # of each picture, where few paths carry the noise
TURNS = 5  # in which the methods are timed: whatever else the machine does meets all
SEEDS = (0x53554646, 0x53554647)
REFERENCE_SECONDS = 10.0
LIMITS = (1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96, 128, 192, 256)
LEADER = "mis"  # the method whose bounces are measured
_SPARE = 4  # limits of bounces tried beyond the first that suffices: fewer samples may pay
_TIE = 1.25  # ratio of times
_SURE = 2.0  # standard errors
_KNOWN = 0.1  # relative standard error of a variance that is known


class Bias(NamedTuple):
    """A squared relative bias with its standard error over pixels."""

    squared: float
    stderr: float

    @property
    def value(self) -> float:
        """The bias, 0 where chance makes its square negative."""
        return math.sqrt(max(self.squared, 0.0))

    @property
    def least(self) -> float:
        """What it is not below, in 97.5 of 100 cases."""
        return math.sqrt(max(self.squared - _SURE * self.stderr, 0.0))

    @property
    def most(self) -> float:
        """What it is not above, in 97.5 of 100 cases."""
        return math.sqrt(max(self.squared + _SURE * self.stderr, 0.0))


@dataclass(frozen=True)
class Candidate:
    """A way to render the scene, and what it would take."""

    name: str
    settings: Settings  # in the frame that was asked for
    bias: Bias
    variance: float  # relative, of one sample: not above this, in 97.5 of 100 cases
    seconds_per_sample: float  # of the whole frame

    def samples_to(self, error: float) -> int | None:
        """Samples until bias and noise together are below an error; None if the bias is not.

        In whole observations: the samples of a part of one are noisier than their share of it.
        """
        room = error**2 - self.bias.most**2
        block = self.settings.block
        return block * max(1, math.ceil(self.variance / room / block)) if room > 0 else None

    def seconds_to(self, error: float) -> float:
        """Seconds for those samples; infinite if there are none."""
        samples = self.samples_to(error)
        return math.inf if samples is None else samples * self.seconds_per_sample


@dataclass(frozen=True)
class Verdict:
    """Everything that was tried for an error."""

    error: float
    reference: Reference
    candidates: tuple[Candidate, ...]  # every method, in the order of the ladder
    beyond: dict[int, Bias]  # by limit of bounces: the light of paths that are longer

    @property
    def best(self) -> Candidate | None:
        """The first to reach the error; None if nothing is known to reach it.

        LEADER wins where the measurement cannot tell them apart: what it misses is the least.
        """
        nearest = self.nearest
        samples = nearest.samples_to(self.error)
        return nearest if samples and samples <= MAX_SAMPLES else None

    @property
    def nearest(self) -> Candidate:
        """What would be first, were there no limit of samples."""
        nearest = min(self.candidates, key=lambda candidate: candidate.seconds_to(self.error))
        leader = next(c for c in self.candidates if LEADER in c.name.split(" = "))
        tied = leader.seconds_to(self.error) <= _TIE * nearest.seconds_to(self.error)
        return leader if tied else nearest

    @property
    def least_bounces(self) -> int | None:
        """The lowest limit that keeps what is cut off below the error."""
        return next((b for b, bias in self.beyond.items() if bias.most < self.error), None)


def what_suffices(
    scene: Scene,
    settings: Settings,
    error: float,
    context: Context,
    bounces: int | None = None,
) -> Verdict:
    """Try every method on a small frame; `bounces` fixes their limit, else it is chosen."""
    small = frame_of(scene, HEIGHT)
    small = settings_for(settings, width=small.width, height=small.height, crop=None)
    small = small if bounces is None else settings_for(small, bounces=bounces)
    reference = reference_for(scene, small, context, 0.25 * error, REFERENCE_SECONDS)
    pixels = settings.width * settings.height / (small.width * small.height)
    trial = _Trial(scene, settings, context, reference, pixels)
    limits = dict(trial.limits(small, error, bounces, reference.bounces))
    beyond = {limit: candidate.bias for limit, candidate in limits.items()}
    leader = min(limits.values(), key=lambda candidate: candidate.seconds_to(error))
    found = [
        trial.model(variant)
        if variant.settings.method in LADDER
        else trial.tracer(variant, leader.settings.bounces, leader.bias)
        for variant in variants_of(scene, small, METHODS, leads=False)
    ]
    order = [*LADDER, *METHODS]
    ranked = sorted(found, key=lambda c: order.index(c.settings.method))
    return Verdict(error, reference, tuple(trial.in_turns(ranked, small)), beyond)


@dataclass(frozen=True)
class _Trial:
    """Measures candidates on a small frame, for a frame of `pixels` times as many pixels."""

    scene: Scene
    wanted: Settings
    context: Context
    reference: Reference
    pixels: float

    def limits(
        self, small: Settings, error: float, fixed: int | None, most: int
    ) -> Iterator[tuple[int, Candidate]]:
        """LEADER under limits of bounces, from few to more than enough."""
        renderer = Renderer(self.scene, small, self.context, tier="baked", method=LEADER)
        whole = [_Picture.of(renderer, seed, most) for seed in SEEDS]
        enough = 0
        for limit in [fixed] if fixed is not None else [n for n in LIMITS if n <= most]:
            pictures = [_Picture.of(renderer, seed, limit) for seed in SEEDS]
            cut = [a.radiance - b.radiance for a, b in zip(whole, pictures, strict=True)]
            candidate = self._candidate(LEADER, renderer.settings, pictures, self._bias(*cut))
            yield limit, candidate
            enough += candidate.bias.most < error
            if enough > _SPARE or candidate.bias.most < error / 8:
                break
        renderer.release()

    def model(self, variant: Variant) -> Candidate:
        """A method of the ladder: its bias is measured."""
        pictures = self._pictures(variant.settings)
        halves = (self.reference.first, self.reference.second)
        errors = [p.radiance - r for p, r in zip(pictures, halves, strict=True)]
        return self._candidate(variant.name, variant.settings, pictures, self._bias(*errors))

    def tracer(self, variant: Variant, limit: int, bias: Bias) -> Candidate:
        """A method that traces paths: what it leaves out is what the limit cuts off."""
        settings = settings_for(variant.settings, bounces=limit)
        return self._candidate(variant.name, settings, self._pictures(settings), bias)

    def in_turns(self, candidates: Sequence[Candidate], small: Settings) -> list[Candidate]:
        """The candidates with times that were measured side by side: the least of TURNS each."""
        frame = {name: getattr(small, name) for name in ("width", "height", "crop")}
        renderers = [
            Renderer(self.scene, settings_for(c.settings, **frame), self.context, tier="baked")
            for c in candidates
        ]
        turns = [[_Picture.of(each, turn).seconds for each in renderers] for turn in range(TURNS)]
        for renderer in renderers:
            renderer.release()
        least = np.min(turns, axis=0) / SAMPLES * self.pixels
        pairs = zip(candidates, least.tolist(), strict=True)
        return [replace(candidate, seconds_per_sample=seconds) for candidate, seconds in pairs]

    def _pictures(self, settings: Settings) -> list["_Picture"]:
        """Of so many samples that the noise is known, where that is not beyond MOST_TRIED."""
        renderer = Renderer(self.scene, settings, self.context, tier="baked")
        samples = SAMPLES
        while True:
            pictures = [_Picture.of(renderer, seed, samples=samples) for seed in SEEDS]
            noise = self._noise(pictures)
            if noise.stderr <= _KNOWN * noise.squared or samples >= MOST_TRIED:
                renderer.release()
                return pictures
            samples *= 4

    def _noise(self, pictures: Sequence["_Picture"]) -> Bias:
        return self._relative(np.mean([picture.squared_stderr for picture in pictures], axis=0))

    def _bias(self, first: Floats, second: Floats) -> Bias:
        """From two errors with independent noise."""
        return self._relative(first * second)

    def _relative(self, squares: Floats) -> Bias:
        scale = np.where(self.reference.scale > 0, self.reference.scale, 1.0)
        pixels = (squares / scale).mean(axis=2)  # channels share their noise
        return Bias(float(pixels.mean()), float(pixels.std() / math.sqrt(pixels.size)))

    def _candidate(
        self, name: str, settings: Settings, pictures: Sequence["_Picture"], bias: Bias
    ) -> Candidate:
        samples = pictures[0].samples
        seconds = min(picture.seconds for picture in pictures)  # the other one may have waited
        full = {name: getattr(self.wanted, name) for name in ("width", "height", "crop", "seed")}
        return Candidate(
            name,
            settings_for(settings, **full),
            bias,
            samples * self._noise(pictures).most ** 2,
            seconds / samples * self.pixels,
        )


@dataclass(frozen=True, eq=False)
class _Picture:
    """A picture, and the seconds of its rendering."""

    samples: int
    radiance: Floats
    squared_stderr: Floats
    seconds: float

    @classmethod
    def of(
        cls, renderer: Renderer, seed: int, bounces: int | None = None, samples: int = SAMPLES
    ) -> "_Picture":
        limit = renderer.settings.bounces if bounces is None else bounces
        renderer.update(seed=seed, bounces=limit)
        warm = samples // 4  # the first dispatches are small
        renderer.render(warm)
        start = time.perf_counter()
        renderer.render(samples)
        seconds = (time.perf_counter() - start) * samples / (samples - warm)
        image = renderer.image()
        squared = np.square(image.stderr.astype(float))
        return cls(samples, image.radiance.astype(float), squared, seconds)
