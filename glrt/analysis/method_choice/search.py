"""The cheapest method, and the number of bounces, that render a scene to a given error."""

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from glrt.analysis.method_choice.candidate import Bias, Candidate
from glrt.analysis.method_choice.trial import LEADER, Tell, Trial, until
from glrt.analysis.method_choice.work import busy_pixels, counting, work_per_sample
from glrt.analysis.reference import Budget, Reference, reference_for, unlimited
from glrt.analysis.variants import variants_of
from glrt.gpu.context import Context
from glrt.plan.methods import BIASED, METHODS
from glrt.plan.plan import prepare
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import is_within_limit
from glrt.scene.scene import Scene
from glrt.settings import MAX_SAMPLES, Settings, settings_for

MOST_PIXELS = 16000  # of the longest edge of the frame in which a crop is measured
HEIGHT = 48  # of the measured frame, in pixels
MOST_WIDE = 4  # times as wide as it is high; of a wider frame, the same number of pixels
REFERENCE_WORK = 4e9  # most work of the reference: some 6 s on one core of llvmpipe
REFERENCE_SHARE = 0.25  # most time of the reference, relative to the seconds that are allowed
# Methods to choose from without asking the user: sets of probes take time to measure, and `error`
# does not show what probes blur.
WITHOUT_PROBES = tuple(
    name for name, traits in METHODS.items() if not (traits.has_probes or traits.rasters)
)
TIE = 1.25  # LEADER is chosen if it takes at most this many times the work of the cheapest


@dataclass(frozen=True)
class Verdict:
    """The measured candidates for an error."""

    error: float
    reference: Reference
    candidates: tuple[Candidate, ...]  # the methods; the ones that leave light out come first
    beyond: dict[int, Bias]  # by limit of bounces: the bias from leaving out longer paths
    untried: tuple[str, ...] = ()  # methods that were not measured, for lack of time
    impossible: tuple[str, ...] = ()  # methods beyond the loop limit of the driver

    @property
    def best(self) -> Candidate | None:
        """The candidate that reaches the error with least work; None if none is known to reach it.

        LEADER is preferred if it takes hardly more, since it leaves out the least light.
        """
        nearest = self.nearest
        samples = nearest.samples_to(self.error)
        return nearest if samples and samples <= MAX_SAMPLES else None

    @property
    def nearest(self) -> Candidate:
        """The candidate that reaches the error with least work if samples are not limited."""
        nearest = min(self.candidates, key=lambda candidate: candidate.work_to(self.error))
        tied = self.leader.work_to(self.error) <= TIE * nearest.work_to(self.error)
        return self.leader if tied else nearest

    @property
    def leader(self) -> Candidate:
        """The candidate of LEADER."""
        return next(c for c in self.candidates if LEADER in c.name.split(" = "))

    @property
    def least_bounces(self) -> int | None:
        """The lowest limit of bounces with a bias known to be below the error, if there is one."""
        return next((b for b, bias in self.beyond.items() if bias.most < self.error), None)


def _silent(_step: str) -> None:
    pass


class Question(NamedTuple):
    """The request that a method must meet."""

    error: float
    bounces: int | None = None  # the limit of all methods; None: choose it, too
    seconds: float = math.inf
    methods: Sequence[str] = WITHOUT_PROBES


def what_suffices(
    scene: Scene,
    settings: Settings,
    asked: Question,
    context: Context,
    report: Tell = _silent,
) -> Verdict:
    """Measure methods on a small frame; `report` is called with the name of each step.

    The result is the same on every run of a driver, unless `seconds` end it: then methods that are
    not measured yet are left out. Raises OutOfTimeError if no number of bounces is known to suffice
    by then.
    """
    error, bounces, seconds, methods = asked
    check = until(time.perf_counter() + seconds) if seconds < math.inf else _always
    small = small_frame(settings)
    small = small if bounces is None else settings_for(small, bounces=bounces)
    leading = settings_for(small, method=LEADER)
    pixels = math.prod(settings.size) / math.prod(small.size)
    with counting(scene, leading, context) as counter:
        report("reference")
        longest = unlimited(scene, small, context).bounces
        samples = _reference_samples(work_per_sample(counter, longest, check), small)
        allowed = _reference_seconds(seconds)
        budget = Budget(0.25 * error, allowed, samples)
        reference = reference_for(scene, small, context, budget, check=check)
        trial = Trial(scene, settings, context, reference, error, pixels, check, report)
        limits = trial.limits(counter, bounces, reference.bounces)
    beyond = {limit: candidate.bias for limit, candidate in limits.items()}
    leader = min(limits.values(), key=lambda candidate: candidate.work_to(error))
    every = variants_of(scene, small, methods, leads=False)
    variants = [it for it in every if is_within_limit(context, prepare(scene, it.settings))]
    found = trial.methods(variants, leader)
    order = [*BIASED, *METHODS]
    ranked = sorted(found, key=lambda c: order.index(c.settings.method))
    untried = {variant.name for variant in variants} - {candidate.name for candidate in found}
    return Verdict(
        error,
        reference,
        tuple(ranked),
        beyond,
        untried=tuple(sorted(untried)),
        impossible=tuple(it.name for it in every if it not in variants),
    )


def _always(_renderer: Renderer | None) -> bool:
    return True


def small_frame(settings: Settings) -> Settings:
    """Settings for the whole frame in HEIGHT rows, or for a crop of some HEIGHT^2 pixels.

    They have no AOVs and no denoiser, which would cost time without effect on the choice.
    """
    own = settings_for(settings, aov=(), denoise="none")
    most = math.sqrt(MOST_WIDE / (settings.width * settings.height))
    if settings.crop is None:
        scale = HEIGHT * min(1 / settings.height, most)
        columns, rows = (max(1, round(scale * n)) for n in (settings.width, settings.height))
        return settings_for(own, width=columns, height=rows)
    scale = HEIGHT / math.sqrt(math.prod(settings.size))
    scale = min(scale, MOST_PIXELS / max(settings.width, settings.height))
    left, top, columns, rows = settings.crop
    x, across = _scaled(left, columns, scale)
    y, down = _scaled(top, rows, scale)
    width = max(round(scale * settings.width), x + across)
    height = max(round(scale * settings.height), y + down)
    return settings_for(own, width=width, height=height, crop=(x, y, across, down))


def _scaled(start: int, length: int, scale: float) -> tuple[int, int]:
    """Start and length of a scaled range of pixels, at least one pixel long."""
    first = math.floor(scale * start)
    return first, max(1, round(scale * (start + length)) - first)


def _reference_samples(work: float, small: Settings) -> int:
    """Samples of a pixel in each half of the reference that take REFERENCE_WORK in all."""
    return max(1, int(REFERENCE_WORK / (2 * busy_pixels(small) * work)))


def _reference_seconds(allowed: float) -> float:
    """Seconds for the reference: a power of two, so that similar times share a cached reference."""
    if allowed == math.inf:
        return math.inf
    return float(2.0 ** math.floor(math.log2(max(REFERENCE_SHARE * allowed, 2.0**-10))))
