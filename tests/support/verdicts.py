"""Searches for the method that suffices on small frames, and scenes to search on."""

from typing import Any

from glrt.analysis.method_choice import search
from glrt.analysis.method_choice.candidate import Bias, Candidate
from glrt.analysis.method_choice.search import Question, Verdict, what_suffices
from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.support.builders import box_of_quads, lamp, scene_of

SIZE, LARGER = 16, 24  # pixels of a frame


def verdict_on(scene: Scene, error: float, context: Context, **more: Any) -> Verdict:
    size = {"width": search.HEIGHT, "height": search.HEIGHT}
    settings = settings_for(scene.render, **size)
    return what_suffices(scene, settings, Question(error, **more), context)


def candidate(verdict: Verdict, method: str) -> Candidate:
    return next(c for c in verdict.candidates if method in c.name.split(" = "))


def furnace(albedo: float = 0.5, bounces: int = 10) -> Scene:
    """A closed box that glows: paths longer than B carry albedo^(B+1) of the light."""
    box = scene_of(box_of_quads("wall", 2.0), {"wall": lamp(1 - albedo, albedo)})
    return box.model_copy(update={"render": box.render.model_copy(update={"bounces": bounces})})


def of_bias(bias: float, variance: float = 1.0, work: float = 1.0) -> Candidate:
    settings = settings_for(furnace().render, sampler="independent")
    return Candidate("mis", settings, Bias(bias**2, 0.0), variance, work, 1.0)


class Clock:
    """Stands for the module `time`: each look at it takes a second."""

    def __init__(self) -> None:
        self.now = 0.0

    def perf_counter(self) -> float:
        self.now += 1.0
        return self.now
