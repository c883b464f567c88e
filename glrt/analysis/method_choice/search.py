"""The fastest method, and the number of bounces, that render a scene to a given error."""

import math
import time
from dataclasses import dataclass

from glrt.analysis.chart.experiment import frame_of
from glrt.analysis.method_choice.trial import LEADER, Bias, Candidate, Trial, until
from glrt.analysis.reference import Reference, reference_for
from glrt.analysis.variants import METHODS, variants_of
from glrt.gpu.context import Context
from glrt.methods.table import CLASSIC
from glrt.scene.scene import Scene
from glrt.settings import MAX_SAMPLES, Settings, settings_for

MOST_PIXELS = 16000  # of an edge of the frame in which a crop is measured
HEIGHT = 48  # of the measured frame, in pixels
REFERENCE_SECONDS = 10.0
REFERENCE_SHARE = 0.25  # most time of the reference, relative to the seconds that are allowed
_TIE = 1.25  # LEADER is chosen if it takes at most this many times as long as the fastest


@dataclass(frozen=True)
class Verdict:
    """The measured candidates for an error."""

    error: float
    reference: Reference
    candidates: tuple[Candidate, ...]  # every method, the classic models first
    beyond: dict[int, Bias]  # by limit of bounces: the bias from leaving out longer paths
    untried: tuple[str, ...] = ()  # methods that were not measured, for lack of time

    @property
    def best(self) -> Candidate | None:
        """The candidate that reaches the error first; None if none is known to reach it.

        LEADER is preferred if it is hardly slower, since it leaves out the least light.
        """
        nearest = self.nearest
        samples = nearest.samples_to(self.error)
        return nearest if samples and samples <= MAX_SAMPLES else None

    @property
    def nearest(self) -> Candidate:
        """The candidate that would reach the error first without a limit of samples."""
        nearest = min(self.candidates, key=lambda candidate: candidate.seconds_to(self.error))
        leader = next(c for c in self.candidates if LEADER in c.name.split(" = "))
        tied = leader.seconds_to(self.error) <= _TIE * nearest.seconds_to(self.error)
        return leader if tied else nearest

    @property
    def least_bounces(self) -> int | None:
        """The lowest limit of bounces with a bias known to be below the error, if there is one."""
        return next((b for b, bias in self.beyond.items() if bias.most < self.error), None)


def what_suffices(
    scene: Scene,
    settings: Settings,
    error: float,
    context: Context,
    bounces: int | None = None,
    seconds: float = math.inf,
) -> Verdict:
    """Measure every method on a small frame; `bounces` is their limit, or None to choose it, too.

    Methods that are not measured within `seconds` are left out. Raises OutOfTimeError if no number
    of bounces is known to suffice by then.
    """
    check = until(time.perf_counter() + seconds)
    small = _small_frame(scene, settings)
    small = small if bounces is None else settings_for(small, bounces=bounces)
    allowed = _reference_seconds(seconds)
    reference = reference_for(scene, small, context, 0.25 * error, allowed, check=check)
    pixels = math.prod(settings.size) / math.prod(small.size)
    trial = Trial(scene, settings, context, reference, pixels, check)
    limits = trial.limits(small, error, bounces, reference.bounces)
    beyond = {limit: candidate.bias for limit, candidate in limits.items()}
    leader = min(limits.values(), key=lambda candidate: candidate.seconds_to(error))
    variants = variants_of(scene, small, METHODS, leads=False)
    found = trial.methods(variants, leader)
    order = [*CLASSIC, *METHODS]
    ranked = sorted(found, key=lambda c: order.index(c.settings.method))
    untried = {variant.name for variant in variants} - {candidate.name for candidate in found}
    candidates = tuple(trial.in_turns(ranked, small))
    return Verdict(error, reference, candidates, beyond, tuple(sorted(untried)))


def _small_frame(scene: Scene, settings: Settings) -> Settings:
    """Settings for a frame of HEIGHT rows, or one in which the crop has about HEIGHT^2 pixels."""
    if settings.crop is None:
        small = frame_of(scene, HEIGHT)
        return settings_for(settings, width=small.width, height=small.height)
    scale = HEIGHT / math.sqrt(math.prod(settings.size))
    scale = min(scale, MOST_PIXELS / max(settings.width, settings.height))
    left, top, columns, rows = settings.crop
    x, across = _scaled(left, columns, scale)
    y, down = _scaled(top, rows, scale)
    width = max(round(scale * settings.width), x + across)
    height = max(round(scale * settings.height), y + down)
    return settings_for(settings, width=width, height=height, crop=(x, y, across, down))


def _scaled(start: int, length: int, scale: float) -> tuple[int, int]:
    """Start and length of a scaled range of pixels, at least one pixel long."""
    first = math.floor(scale * start)
    return first, max(1, round(scale * (start + length)) - first)


def _reference_seconds(allowed: float) -> float:
    """Seconds for the reference: a power of two, so that similar times share a cached reference."""
    if REFERENCE_SHARE * allowed >= REFERENCE_SECONDS:
        return REFERENCE_SECONDS
    return float(2.0 ** math.floor(math.log2(max(REFERENCE_SHARE * allowed, 2.0**-10))))
