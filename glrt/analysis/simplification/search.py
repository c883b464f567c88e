"""The parts of a scene that can go together, found by bisection and judged by another measurement.

The search and the judgement use different random numbers, so the bound holds for what the search
has chosen. A judgement that fails is repeated, with more samples or fewer parts. The k-th one has
the risk RISK / 2^k, so all of them together have at most RISK.
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from glrt.analysis.method_choice.trial import LIMITS
from glrt.analysis.simplification.difference import (
    FIRST_SEED,
    PAIRS,
    Change,
    Differences,
    doublings,
    frame,
)
from glrt.analysis.simplification.order import by_show
from glrt.analysis.simplification.parts import Part, features_of, without
from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from glrt.settings import Settings

RISK = 0.05  # that the change is not below its bound
SEARCHED = 1 << 16  # most pixels of the frame of the search
JUDGED = 1 << 18  # of the frame of the judgement
MOST_SAMPLES = 16  # per pixel and seed of the search
MOST_OF_JUDGE = 64
OF_BOUNCES = 0.5  # most of the squared error that fewer bounces may take; parts share the rest
MARGIN = 0.9  # of the error, which the search aims at
BLOCKERS = 4  # parts in a row that must stay, after which the larger ones of a list are not tried
MOST_FEATURES = 24  # tried, in the order of the file
HOPELESS = 4.0  # times the allowed square, and NOISY more: one pair of pictures decides
NOISY = 0.01  # of one pair: its standard error is some 0.004 where all pixels change
MOST_TRIALS = 48  # of a search
LOOKS = 12  # judgements at most

Tell = Callable[[str], None]


class Step(NamedTuple):
    """Parts or bounces that go, and the relative change with all that went before them."""

    parts: tuple[Part, ...]
    bounces: int | None
    change: float


@dataclass(frozen=True)
class Simplification:
    """Parts that can go from a scene, judged together."""

    error: float
    scene: Scene  # what is left, with its `[render]`
    bounces: int
    steps: tuple[Step, ...]
    change: float
    bound: float  # of the change, with confidence 1 - RISK
    size: tuple[int, int]  # of the judged picture, in pixels
    samples: int  # per pixel of the judged pictures, all seeds together
    trials: int  # scenes that were rendered
    is_whole: bool  # whether all was tried that the search would try


@dataclass
class _Search:
    differences: Differences
    error: float
    report: Tell
    bounces: int
    steps: list[Step] = field(default_factory=list)
    trials: int = 0

    @property
    def gone(self) -> list[Part]:
        return [part for step in self.steps for part in step.parts]

    def try_(self, parts: Collection[Part], bounces: int, share: float = 1.0) -> float | None:
        """Return the change by all that has gone and these parts too; None if it is too large.

        `share` of the squared error is allowed.
        """
        scene = without(self.differences.scene, [*self.gone, *parts])
        if scene is None or self.trials >= MOST_TRIALS:
            return None
        self.trials += 1
        self.report(f"trial {self.trials}")
        allowed = share * (MARGIN * self.error) ** 2
        for samples in doublings(MOST_SAMPLES):
            found = self.differences.change(
                scene, bounces, samples, lambda square: square > HOPELESS * allowed + NOISY
            )
            if len(found.squares) < PAIRS or found.above(RISK) ** 2 >= allowed:
                return None
            if found.below(RISK) ** 2 < allowed:
                return found.value
        return None

    def take(self, parts: Sequence[Part]) -> None:
        """Take the parts of a list that can go; the parts that show least stand first.

        Bisection finds the longest start of the list that can go, and does so again behind each
        part that must stay.
        """
        rest, blockers, first = list(parts), 0, True
        while rest and blockers < BLOCKERS and self.trials < MOST_TRIALS:
            count, change = self._start(rest, first)
            if count:
                self.steps.append(Step(tuple(rest[:count]), None, change))
            blockers = 1 if count else blockers + 1
            rest, first = rest[count + 1 :], False

    def _start(self, rest: Sequence[Part], from_whole: bool) -> tuple[int, float]:
        """Return how many parts at the start of a list can go together, and the change then."""
        low, high, change = 0, len(rest), 0.0
        size = high if from_whole else 1
        while low < high:
            found = self.try_(rest[:size], self.bounces)
            if found is None:
                high = size - 1
            else:
                low, change = size, found
            gallops = not from_whole and high == len(rest)
            size = min(2 * size, high) if gallops else (low + high + 1) // 2
        return low, change

    def shorten(self) -> None:
        """Lower the limit of bounces as far as its share of the error allows, by bisection."""
        limits = [0, *(n for n in LIMITS if n < self.bounces)]
        low, high, change = 0, len(limits), 0.0
        while low < high and self.bounces:
            middle = (low + high) // 2
            found = self.try_([], limits[middle], OF_BOUNCES)
            if found is None:
                low = middle + 1
            else:
                high, change = middle, found
        if self.bounces and high < len(limits):
            self.bounces = limits[high]
            self.steps.append(Step((), self.bounces, change))


def check(scene: Scene, error: float) -> None:
    """Raise UsageError for an error of 1 or more, and for an animated scene."""
    if error >= 1:
        raise UsageError(
            f"--simplify needs an --error below 100 %, got {100 * error:g} %: that much is missing "
            "from a black picture."
        )
    if scene.animation:
        raise UsageError(
            "--simplify judges a still picture, and the scene is animated: what is small in one "
            "frame may fill another. Leave [animation] out."
        )


def simplified(
    scene: Scene,
    settings: Settings,
    error: float,
    context: Context,
    report: Tell = lambda _: None,
) -> Simplification:
    """Return the parts whose absence changes the picture by less than a relative error.

    Method and other settings stay. `report` is called with the name of each step. The
    scene has passed `check`.
    """
    small = frame(settings, SEARCHED)
    differences = Differences(scene, small, context)
    search = _Search(differences, error, report, settings.bounces)
    report("what is seen")
    lamps, others = by_show(scene, small, context)
    features = features_of(scene)
    try:
        search.shorten()
        for part in features[:MOST_FEATURES]:
            search.take([part])
        search.take(lamps)
        search.take(others)
    finally:
        differences.release()
    return _judged(search, frame(settings, JUDGED), context)


def _judged(search: _Search, settings: Settings, context: Context) -> Simplification:
    scene, samples, change = search.differences.scene, 1, Change((0.0,) * PAIRS)
    whole, trials, used = settings.bounces, search.trials, 0
    most = search.trials < MOST_TRIALS
    bound, scale = 0.0, None
    for look in range(LOOKS if search.steps else 0):
        smaller = without(scene, search.gone)
        assert smaller is not None
        search.report(f"judgement {look + 1}")
        first_seed = FIRST_SEED + 2 * PAIRS * (look + 1)
        judge = Differences(scene, settings, context, first_seed, scale)
        try:
            change = judge.change(smaller, search.bounces, samples)
            scale = judge.scale
        finally:
            judge.release()
        trials, used = trials + 1, 2 * PAIRS * samples
        bound = change.below(RISK / 2 ** (look + 1))
        if bound < search.error:
            break
        if change.value < MARGIN * search.error and samples < MOST_OF_JUDGE:
            samples *= 4
            continue
        dropped = search.steps.pop()
        if dropped.bounces is not None:
            search.bounces = whole
        if not search.steps:
            break
    if bound >= search.error:
        search.steps.clear()
    if not search.steps:
        search.bounces, change, bound, used = whole, Change((0.0,) * PAIRS), 0.0, 0
    left = without(scene, search.gone) or scene
    render = left.render.model_copy(update={"bounces": search.bounces})
    return Simplification(
        error=search.error,
        scene=left.model_copy(update={"render": render}),
        bounces=search.bounces,
        steps=tuple(search.steps),
        change=change.value,
        bound=bound,
        size=settings.size,
        samples=used,
        trials=trials,
        is_whole=most,
    )
