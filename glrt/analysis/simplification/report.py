"""Parts that can go from a scene, in words."""

from collections.abc import Iterator
from typing import NamedTuple

from glrt.analysis.chart.page import number, percent
from glrt.analysis.method_choice.search import small_frame
from glrt.analysis.method_choice.work import counting, work_per_sample
from glrt.analysis.simplification.search import RISK, Simplification, Step
from glrt.core.text import counted
from glrt.gpu.context import Context
from glrt.plan.explanation import explain
from glrt.plan.plan import prepare
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for

MOST_NAMED = 6  # parts of a step, without --all


class Saving(NamedTuple):
    """Work and features that a smaller scene saves."""

    work: float  # of a sample, counted, as a share of that of the whole scene
    features: tuple[str, ...]  # of the kernel that go


def saving(scene: Scene, settings: Settings, found: Simplification, context: Context) -> Saving:
    """Count the work of a sample of both scenes, and compare the features of their kernels."""
    shorter = settings_for(settings, bounces=found.bounces)
    before, after = (
        _work(one, its, context) for one, its in ((scene, settings), (found.scene, shorter))
    )
    there = _features(found.scene, shorter)
    gone = [name for name in _features(scene, settings) if name not in there]
    return Saving(after / before if before else 1.0, tuple(gone))


def _work(scene: Scene, settings: Settings, context: Context) -> float:
    with counting(scene, small_frame(settings), context) as counter:
        return work_per_sample(counter, settings.bounces, lambda _: True)


def _features(scene: Scene, settings: Settings) -> list[str]:
    return [it.name for it in explain(prepare(scene, settings)) if it.present]


def lines(found: Simplification, saved: Saving, named: int = MOST_NAMED) -> Iterator[str]:
    """Yield the lines of the report; `named` parts of each step are named."""
    width, height = found.size
    if not found.steps:
        yield f"Nothing was found that can go below {percent(found.error)} (relative RMS)."
        yield from _unfinished(found)
        return
    yield f"These can go for an error of {percent(found.error)} (relative RMS), all together:"
    yield ""
    yield "change so far  without"
    for step in found.steps:
        yield f"{percent(step.change):<13}  {_told(step, named)}"
    yield ""
    yield (
        f"Without all of them the picture changes by {percent(found.change)}, and by less than "
        f"{percent(found.bound)} with {100 * (1 - RISK):g} % confidence: measured with other "
        f"random numbers than the search, on {width} x {height} pixels with "
        f"{counted(found.samples, 'sample')}."
    )
    gone = f" The kernel loses: {', '.join(saved.features)}." if saved.features else ""
    yield f"A sample takes {number(saved.work)} times the counted work.{gone}"
    yield from _unfinished(found)


def _unfinished(found: Simplification) -> Iterator[str]:
    if not found.is_whole:
        yield f"The search ended after {counted(found.trials, 'trial')}: more may be able to go."


def _told(step: Step, named: int) -> str:
    if step.bounces is not None:
        return f"bounces beyond {step.bounces}"
    names = [part.name for part in step.parts]
    rest = len(names) - named
    return ", ".join(names[:named]) + (f" and {rest} more" if rest > 0 else "")
