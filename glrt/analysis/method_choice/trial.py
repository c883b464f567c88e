"""Bias, variance and work of the methods for one scene, measured on a small frame.

With pictures x1, x2 of two seeds and the independent halves r1, r2 of the reference, the mean of
(x1 - r1) (x2 - r2) is an unbiased estimator of the squared bias of a method. The bias from a limit
of bounces is estimated from the difference of two pictures of the same seed, which follow the same
paths up to their limits, so that most of their noise cancels.

All that is compared is counted work. Seconds are noted for the user who reads the result.
"""

import math
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace

import numpy as np

from glrt.analysis.method_choice.candidate import NO_PROBES, Bias, Candidate, OfProbes
from glrt.analysis.method_choice.work import busy_pixels, counting, work_of_probes, work_per_sample
from glrt.analysis.reference import Floats, Reference
from glrt.analysis.variants import Variant
from glrt.gpu.context import Context
from glrt.plan.methods import BIASED
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for

SAMPLES = 128  # per pixel of each picture
MOST_TRIED = 16 * SAMPLES  # the same, where the variance is not yet known precisely enough
MOST_WORK = 2e9  # most work of the larger pictures of a method: some 3 s on one core of llvmpipe
SEEDS = (0x53554646, 0x53554647)
LIMITS = (1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64, 96, 128, 192, 256)
OF_FRAME = (
    "width",
    "height",
    "crop",
    "seed",
    "aov",
    "denoise",
)  # settings that a trial replaces by its own
LEADER = "mis"  # the method whose bounces are measured
_EXTRA_LIMITS = 4  # tried beyond the first that suffices: more bounces may need fewer samples
_PRECISE = 0.1  # relative standard error below which a variance is taken as known
_FAR = 2.0  # times an error, or another's work: so large a difference needs no more samples


class OutOfTimeError(Exception):
    """The measurement has used up its time."""


Check = Callable[[Renderer | None], bool]  # called after each dispatch: True, or OutOfTimeError
Tell = Callable[[str], None]
BiasOf = Callable[[Sequence["_Picture"]], "Bias"]


def until(deadline: float) -> Check:
    """A Check that raises OutOfTimeError from `deadline` on, a time of time.perf_counter."""

    def check(_renderer: Renderer | None) -> bool:
        if time.perf_counter() >= deadline:
            raise OutOfTimeError
        return True

    return check


@dataclass(frozen=True)
class Trial:
    """Measures candidates on a small frame; the frame of `wanted` has `pixels` times its pixels."""

    scene: Scene
    wanted: Settings
    context: Context
    reference: Reference
    error: float
    pixels: float
    check: Check
    report: Tell  # called with the name of each step

    def limits(self, counter: Renderer, fixed: int | None, most: int) -> dict[int, Candidate]:
        """LEADER by limit of bounces: `fixed`, or up to `most`; `counter` counts its work.

        Raises OutOfTimeError if the time runs out before one suffices.
        """
        found: dict[int, Candidate] = {}
        try:
            found.update(self._limits(counter, fixed, most))
        except OutOfTimeError:
            if not any(candidate.bias.most < self.error for candidate in found.values()):
                raise
        return found

    def _limits(
        self, counter: Renderer, fixed: int | None, most: int
    ) -> Iterator[tuple[int, Candidate]]:
        """Limits and candidates in ascending order, to some beyond the first that suffices."""
        with self._opened(counter.settings) as renderer:
            whole = [self._picture(renderer, seed, most) for seed in SEEDS]
            enough = 0
            for limit in [fixed] if fixed is not None else [n for n in LIMITS if n <= most]:
                self.report(f"{LEADER}, bounces {limit}")
                pictures = [self._picture(renderer, seed, limit) for seed in SEEDS]
                cut = [a.radiance - b.radiance for a, b in zip(whole, pictures, strict=True)]
                bias = self._bias(*cut)
                work = work_per_sample(counter, limit, self.check)
                yield limit, self._candidate(LEADER, renderer.settings, pictures, bias, work)
                enough += bias.most < self.error
                if enough > _EXTRA_LIMITS or bias.most < self.error / 8:
                    break

    def methods(self, variants: Sequence[Variant], leader: Candidate) -> list[Candidate]:
        """Candidates while time is left, LEADER first; all but biased ones have its bounces."""
        first = [variant for variant in variants if _is_leader(variant)]
        found: list[Candidate] = []
        with suppress(OutOfTimeError):
            for variant in [*first, *(v for v in variants if v not in first)]:
                found.append(self._measured(variant, leader))
        return found or [replace(leader, name=variant.name) for variant in first]

    def _measured(self, variant: Variant, leader: Candidate) -> Candidate:
        if variant.settings.method in BIASED:
            return self._tried(variant, self._bias_of_model, leader)
        settings = settings_for(variant.settings, bounces=leader.settings.bounces)
        return self._tried(Variant(variant.name, settings), lambda _: leader.bias, leader)

    def _bias_of_model(self, pictures: Sequence["_Picture"]) -> Bias:
        """The bias of a method that leaves light out, measured against the reference."""
        halves = (self.reference.first, self.reference.second)
        errors = [p.radiance - r for p, r in zip(pictures, halves, strict=True)]
        return self._bias(*errors)

    def _tried(self, variant: Variant, bias: BiasOf, leader: Candidate) -> Candidate:
        """A candidate by a picture for each of SEEDS, with more samples until it is known well."""
        name, settings = variant.name, variant.settings

        def taken(samples: int) -> list[_Picture]:
            self.report(f"{name}, {samples} samples")
            return [self._picture(renderer, seed, samples=samples) for seed in SEEDS]

        with self._opened(settings) as renderer:
            pictures = taken(samples := SAMPLES)
            work = self._work(variant, bias(pictures), leader)
            candidate = self._candidate(name, settings, pictures, bias(pictures), *work)
            each = work[0] + work[1].work_of_set / settings.block / math.prod(settings.size)
            most = min(MOST_TRIED, MOST_WORK / (len(SEEDS) * busy_pixels(settings) * each))
            with suppress(OutOfTimeError):
                while not self._is_settled(candidate, pictures, leader) and 4 * samples <= most:
                    pictures = taken(samples := 4 * samples)
                    candidate = self._candidate(name, settings, pictures, bias(pictures), *work)
        return candidate

    def _work(self, variant: Variant, bias: Bias, leader: Candidate) -> tuple[float, OfProbes]:
        """Work of a sample, and of probes; infinite, and not counted, if the bias is too large."""
        if bias.least >= self.error:
            return math.inf, NO_PROBES
        if _is_leader(variant):
            return leader.work_per_sample, NO_PROBES
        with counting(self.scene, variant.settings, self.context) as counter:
            work = work_per_sample(counter, variant.settings.bounces, self.check)
            of_set, once = work_of_probes(counter)
            return work, OfProbes(work_of_set=of_set, work_once=once)

    def _is_settled(
        self, candidate: Candidate, pictures: Sequence["_Picture"], leader: Candidate
    ) -> bool:
        """Whether more samples would change no choice: few suffice, or far too many are needed."""
        noise = self._noise(pictures)
        needs_least = candidate.samples_to(self.error / _FAR) == candidate.settings.block
        bias = Bias(candidate.bias.least**2, 0.0)
        at_best = replace(candidate, bias=bias, variance=pictures[0].samples * noise.least**2)
        is_far = at_best.work_to(self.error) > _FAR * leader.work_to(self.error)
        return needs_least or is_far or noise.stderr <= _PRECISE * noise.squared

    @contextmanager
    def _opened(self, settings: Settings) -> Iterator[Renderer]:
        self.check(None)
        renderer = Renderer(self.scene, settings, self.context, tier="complete")
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
        self,
        name: str,
        settings: Settings,
        pictures: Sequence["_Picture"],
        bias: Bias,
        work: float,
        probes: OfProbes = NO_PROBES,
    ) -> Candidate:
        samples = pictures[0].samples
        seconds = min(picture.seconds for picture in pictures)  # less disturbed by other load
        full = {name: getattr(self.wanted, name) for name in OF_FRAME}
        return Candidate(
            name,
            settings_for(settings, **full),
            bias,
            samples * self._noise(pictures).most ** 2,
            work,
            seconds / samples * self.pixels,
            probes._replace(
                seconds_of_set=min(picture.seconds_of_set for picture in pictures),
                seconds_once=min(picture.seconds_once for picture in pictures),
            ),
        )


@dataclass(frozen=True, eq=False)
class _Picture:
    """A picture with the seconds of its rendering; arrays are (H, W, 3)."""

    samples: int
    radiance: Floats
    squared_stderr: Floats
    seconds: float  # without those of probes
    seconds_of_set: float
    seconds_once: float

    @classmethod
    def of(cls, renderer: Renderer, samples: int, check: Check) -> "_Picture":
        warm = samples // 4  # not timed: the first dispatches are small
        renderer.render(warm, check)
        probes, start = renderer.probes.tracer, time.perf_counter()
        before = probes.seconds.update if probes else 0.0
        renderer.render(samples, check)
        of_sets = probes.seconds.update - before if probes else 0.0
        seconds = (time.perf_counter() - start - of_sets) * samples / (samples - warm)
        of_set = of_sets / max((samples - warm) // renderer.settings.block, 1)
        once = probes.seconds.look if probes else 0.0
        image = renderer.image()
        squared = np.square(image.stderr.astype(float))
        return cls(samples, image.radiance.astype(float), squared, seconds, of_set, once)


def _is_leader(variant: Variant) -> bool:
    return LEADER in variant.name.split(" = ")
