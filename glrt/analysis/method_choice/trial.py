"""Bias, variance and time of the methods for one scene, measured on a small frame.

With pictures x1, x2 of two seeds and the independent halves r1, r2 of the reference, the mean of
(x1 - r1) (x2 - r2) is an unbiased estimator of the squared bias of a method. The bias from a limit
of bounces is estimated from the difference of two pictures of the same seed, which follow the same
paths up to their limits, so that most of their noise cancels.
"""

import math
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from glrt.analysis.reference import Floats, Reference
from glrt.analysis.variants import Variant
from glrt.gpu.context import Context
from glrt.methods.table import CLASSIC
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for

SAMPLES = 128  # per pixel of each picture
MOST_TRIED = 16 * SAMPLES  # the same, where the variance is not yet known precisely enough
TURNS = 5  # rounds in which the methods are timed, interleaved so that other load affects all
SEEDS = (0x53554646, 0x53554647)
LIMITS = (1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96, 128, 192, 256)
LEADER = "mis"  # the method whose bounces are measured
_EXTRA_LIMITS = 4  # tried beyond the first that suffices: more bounces may need fewer samples
_SIGMAS = 2.0  # half width of intervals, in standard errors
_PRECISE = 0.1  # relative standard error below which a variance is taken as known


class OutOfTimeError(Exception):
    """The measurement has used up its time."""


Check = Callable[[Renderer | None], bool]  # called after each dispatch: True, or OutOfTimeError


def until(deadline: float) -> Check:
    """A Check that raises OutOfTimeError from `deadline` on, a time of time.perf_counter."""

    def check(_renderer: Renderer | None) -> bool:
        if time.perf_counter() >= deadline:
            raise OutOfTimeError
        return True

    return check


class Bias(NamedTuple):
    """A squared relative bias with its standard error over pixels."""

    squared: float
    stderr: float

    @property
    def value(self) -> float:
        """The bias; 0 if the estimate of its square is negative."""
        return math.sqrt(max(self.squared, 0.0))

    @property
    def least(self) -> float:
        """Lower bound of the bias at a confidence of 97.5 %."""
        return math.sqrt(max(self.squared - _SIGMAS * self.stderr, 0.0))

    @property
    def most(self) -> float:
        """Upper bound of the bias at a confidence of 97.5 %."""
        return math.sqrt(max(self.squared + _SIGMAS * self.stderr, 0.0))


@dataclass(frozen=True)
class Candidate:
    """A method with a limit of bounces, and its measured bias, variance and time."""

    name: str
    settings: Settings  # for the requested frame
    bias: Bias
    variance: float  # relative, of one sample: upper bound at a confidence of 97.5 %
    seconds_per_sample: float  # for one sample of every pixel of the requested frame

    def samples_to(self, error: float) -> int | None:
        """Samples per pixel to reach an error; None if the bias is not known to be below it.

        A multiple of the block of the sampler: the samples of an incomplete block are noisier.
        """
        room = error**2 - self.bias.most**2
        block = self.settings.block
        return block * max(1, math.ceil(self.variance / room / block)) if room > 0 else None

    def seconds_to(self, error: float) -> float:
        """Seconds to reach an error; infinite if `samples_to` is None."""
        samples = self.samples_to(error)
        return math.inf if samples is None else samples * self.seconds_per_sample


@dataclass(frozen=True)
class Trial:
    """Measures candidates on a small frame; the frame of `wanted` has `pixels` times its pixels."""

    scene: Scene
    wanted: Settings
    context: Context
    reference: Reference
    pixels: float
    check: Check

    def limits(
        self, small: Settings, error: float, fixed: int | None, most: int
    ) -> dict[int, Candidate]:
        """LEADER by limit of bounces: `fixed`, or up to `most`.

        Raises OutOfTimeError if the time runs out before one suffices.
        """
        found: dict[int, Candidate] = {}
        try:
            found.update(self._limits(small, error, fixed, most))
        except OutOfTimeError:
            if not any(candidate.bias.most < error for candidate in found.values()):
                raise
        return found

    def _limits(
        self, small: Settings, error: float, fixed: int | None, most: int
    ) -> Iterator[tuple[int, Candidate]]:
        """Limits and candidates in ascending order, to some beyond the first that suffices."""
        with self._opened(small, method=LEADER) as renderer:
            whole = [self._picture(renderer, seed, most) for seed in SEEDS]
            enough = 0
            for limit in [fixed] if fixed is not None else [n for n in LIMITS if n <= most]:
                pictures = [self._picture(renderer, seed, limit) for seed in SEEDS]
                cut = [a.radiance - b.radiance for a, b in zip(whole, pictures, strict=True)]
                bias = self._bias(*cut)
                yield limit, self._candidate(LEADER, renderer.settings, pictures, bias)
                enough += bias.most < error
                if enough > _EXTRA_LIMITS or bias.most < error / 8:
                    break

    def methods(self, variants: Sequence[Variant], leader: Candidate) -> list[Candidate]:
        """A candidate for each variant while time is left, LEADER first, with its bounces."""
        first = [v for v in variants if LEADER in v.name.split(" = ")]
        found: list[Candidate] = []
        with suppress(OutOfTimeError):
            for variant in [*first, *(v for v in variants if v not in first)]:
                found.append(self._measured(variant, leader))
        return found or [replace(leader, name=variant.name) for variant in first]

    def _measured(self, variant: Variant, leader: Candidate) -> Candidate:
        if variant.settings.method in CLASSIC:
            return self.model(variant)
        return self.tracer(variant, leader.settings.bounces, leader.bias)

    def model(self, variant: Variant) -> Candidate:
        """The candidate of a classic model, with its bias measured against the reference."""
        pictures = self._pictures(variant.settings)
        halves = (self.reference.first, self.reference.second)
        errors = [p.radiance - r for p, r in zip(pictures, halves, strict=True)]
        return self._candidate(variant.name, variant.settings, pictures, self._bias(*errors))

    def tracer(self, variant: Variant, limit: int, bias: Bias) -> Candidate:
        """The candidate of a path tracing method: its bias is that of the limit of bounces."""
        settings = settings_for(variant.settings, bounces=limit)
        return self._candidate(variant.name, settings, self._pictures(settings), bias)

    def in_turns(self, candidates: Sequence[Candidate], small: Settings) -> list[Candidate]:
        """The candidates with interleaved timings: the shortest of TURNS for each.

        Their earlier times are kept if the time runs out in the first turn.
        """
        frame = {name: getattr(small, name) for name in ("width", "height", "crop")}
        turns: list[list[float]] = []
        with ExitStack() as stack, suppress(OutOfTimeError):
            renderers = [
                stack.enter_context(self._opened(settings_for(c.settings, **frame)))
                for c in candidates
            ]
            for turn in range(TURNS):
                turns.append([self._picture(each, turn).seconds for each in renderers])
        if not turns:
            return list(candidates)
        least = np.min(turns, axis=0) / SAMPLES * self.pixels
        pairs = zip(candidates, least.tolist(), strict=True)
        return [replace(candidate, seconds_per_sample=seconds) for candidate, seconds in pairs]

    def _pictures(self, settings: Settings) -> list["_Picture"]:
        """A picture for each of SEEDS, with more samples until the variance is known precisely."""
        with self._opened(settings) as renderer:
            found = [self._picture(renderer, seed) for seed in SEEDS]
            samples = SAMPLES
            with suppress(OutOfTimeError):
                while samples < MOST_TRIED and not _is_known(self._noise(found)):
                    samples *= 4
                    found = [self._picture(renderer, seed, samples=samples) for seed in SEEDS]
        return found

    @contextmanager
    def _opened(self, settings: Settings, **changes: Any) -> Iterator[Renderer]:
        self.check(None)
        renderer = Renderer(self.scene, settings, self.context, tier="baked", **changes)
        try:
            yield renderer
        finally:
            renderer.release()

    def _picture(
        self, renderer: Renderer, seed: int, bounces: int | None = None, samples: int = SAMPLES
    ) -> "_Picture":
        limit = renderer.settings.bounces if bounces is None else bounces
        renderer.update(seed=seed, bounces=limit)
        return _Picture.of(renderer, samples, self.check)

    def _noise(self, pictures: Sequence["_Picture"]) -> Bias:
        return self._relative(np.mean([picture.squared_stderr for picture in pictures], axis=0))

    def _bias(self, first: Floats, second: Floats) -> Bias:
        """The squared bias from two errors with independent noise, (H, W, 3) each."""
        return self._relative(first * second)

    def _relative(self, squares: Floats) -> Bias:
        """Mean of `squares`, (H, W, 3), relative to the reference, with its standard error."""
        scale = np.where(self.reference.scale > 0, self.reference.scale, 1.0)
        pixels = (squares / scale).mean(axis=2)  # channels share their noise
        return Bias(float(pixels.mean()), float(pixels.std() / math.sqrt(pixels.size)))

    def _candidate(
        self, name: str, settings: Settings, pictures: Sequence["_Picture"], bias: Bias
    ) -> Candidate:
        samples = pictures[0].samples
        seconds = min(picture.seconds for picture in pictures)  # less disturbed by other load
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
    """A picture with the seconds of its rendering; arrays are (H, W, 3)."""

    samples: int
    radiance: Floats
    squared_stderr: Floats
    seconds: float

    @classmethod
    def of(cls, renderer: Renderer, samples: int, check: Check) -> "_Picture":
        warm = samples // 4  # not timed: the first dispatches are small
        renderer.render(warm, check)
        start = time.perf_counter()
        renderer.render(samples, check)
        seconds = (time.perf_counter() - start) * samples / (samples - warm)
        image = renderer.image()
        squared = np.square(image.stderr.astype(float))
        return cls(samples, image.radiance.astype(float), squared, seconds)


def _is_known(noise: Bias) -> bool:
    return noise.stderr <= _PRECISE * noise.squared
