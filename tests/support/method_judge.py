"""Judges the method that `glrt inspect --error` chose: by renders of it and of cheaper ones."""

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np

from glrt.analysis import reference as references
from glrt.analysis.method_choice.candidate import Candidate
from glrt.analysis.method_choice.search import Verdict
from glrt.analysis.method_choice.trial import LIMITS
from glrt.analysis.method_choice.work import counting, work_per_sample
from glrt.analysis.reference import Budget, Reference, reference_for
from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for
from tests.support.builders import lamp, quad, scene_of, sphere

SLACK = 1.15  # of an error, which the verdict knows from few pictures
MARGIN = 1.5  # of work: counts do not separate the times of methods that near
FIRST_SEED, FEWEST, MOST_PICTURES = 90, 8, 32  # of the pictures whose errors are taken
WORK = 4096  # samples for them all, within those numbers
TRUTH_SEEDS = (1001, 1002)  # not those of the reference that the verdict saw
TRUTH_SAMPLES = 8192  # at most; no clock decides, so a busy machine has the same truth
MOST = 1 << 14  # samples that a cheaper way is tried with


class Found(NamedTuple):
    """A way to render, how many samples of it were taken, and the errors of pictures."""

    name: str
    samples: int
    error: float  # the root of their mean square
    usual: float  # 3 of 4 have less
    most: float  # what the first is not above, in 97.5 of 100 cases


class Judge:
    """Renders what a verdict chose, and what else could be done with the same work."""

    def __init__(self, scene: Scene, verdict: Verdict, context: Context) -> None:
        """The verdict names something."""
        assert verdict.best is not None
        self.scene, self.verdict, self.context = scene, verdict, context
        self.best: Candidate = verdict.best

    @cached_property
    def truth(self) -> Reference:
        """A reference of random numbers of its own."""
        with patch.object(references, "SEEDS", TRUTH_SEEDS):
            budget = Budget(0.1 * self.verdict.error, math.inf, TRUTH_SAMPLES)
            return reference_for(self.scene, self.best.settings, self.context, budget)

    @cached_property
    def choice(self) -> Found:
        """The verdict's choice, with the samples that it asks for."""
        return self._tried(self.best.name, self.best.settings, self._samples)

    def choice_reaches(self) -> bool:
        """Whether 3 of 4 pictures have the error which was asked for.

        Not their mean: where a lamp shines through the edge of a pixel, one picture in many is so
        far off that it decides that alone.
        """
        return self.choice.usual <= SLACK * self.verdict.error

    def cheaper_ones(self) -> list[Found]:
        """Other methods, and fewer bounces, that surely reach the error with less work by MARGIN.

        As surely as the verdict knows noise and biases. In whole observations: a picture does not
        know the error of less.
        """
        ways = dict(self._others())
        enough = self._samples_needed() * self._work_a_sample(self.best.settings)
        found = []
        for name, settings in ways.items():
            own = self._work_a_sample(settings)
            samples = int(enough / own / MARGIN) // settings.block * settings.block
            if samples:
                found.append(self._tried(name, settings, min(samples, MOST)))
        return [each for each in found if each.most <= self.verdict.error]

    def _samples_needed(self) -> int:
        """The samples that the choice needs, to a factor of MARGIN.

        The verdict may name more, so that noise is surely small.
        """
        samples = self._samples
        while fewer := int(samples / MARGIN):
            found = self._tried(self.best.name, self.best.settings, fewer)
            if found.error > self.verdict.error:
                break
            samples = fewer
        return samples

    @property
    def _samples(self) -> int:
        samples = self.best.samples_to(self.verdict.error)
        assert samples is not None
        return samples

    def _others(self) -> Iterator[tuple[str, Settings]]:
        chosen = self.best.settings
        for candidate in self.verdict.candidates:
            if candidate is not self.best:
                yield candidate.name, candidate.settings
        fewer = max((limit for limit in LIMITS if limit < chosen.bounces), default=0)
        yield f"{fewer} bounces", settings_for(chosen, bounces=fewer)

    def _tried(self, name: str, settings: Settings, samples: int) -> Found:
        renderer = self._renderer(settings)
        squares = []
        for number in range(min(max(WORK // samples, FEWEST), MOST_PICTURES)):
            renderer.update(seed=FIRST_SEED + number)
            squares.append(self.truth.squared_error(renderer.render(samples).image().radiance))
        renderer.release()
        mean, usual = np.mean(squares), np.quantile(squares, 0.75)
        most = mean + 2 * np.std(squares, ddof=1) / np.sqrt(len(squares))
        errors = np.sqrt(np.maximum([mean, usual, most], 0.0))
        return Found(name, samples, *errors.tolist())

    def _work_a_sample(self, settings: Settings) -> float:
        """The counted work of a sample: it is the same on a busy machine."""
        with counting(self.scene, settings, self.context) as counter:
            return work_per_sample(counter, settings.bounces, lambda _renderer: True)

    def _renderer(self, settings: Settings) -> Renderer:
        return Renderer(self.scene, settings, self.context, tier="complete")


def random_scene(seed: int) -> Scene:
    """A floor or a room, some balls of any material, a lamp of any size, at times a sky."""
    draw = np.random.default_rng(seed)

    def color(low: float, high: float) -> list[float]:
        return [round(float(x), 3) for x in draw.uniform(low, high, 3)]

    kinds: list[dict[str, Any]] = [
        {"type": "lambertian", "color": color(0.1, 0.9)},
        {"type": "metal", "color": color(0.5, 0.95)},
        {"type": "metal", "color": color(0.5, 0.95), "roughness": float(draw.uniform(0.3, 0.8))},
        {"type": "dielectric", "ior": 1.5},
    ]
    materials = {"floor": {"type": "lambertian", "color": color(0.1, 0.8)}}
    materials |= {f"ball {i}": kinds[draw.choice(4, p=[0.55, 0.15, 0.15, 0.15])] for i in range(3)}
    objects = [quad([-3, -1, -8], [0, 0, 8], [6, 0, 0], "floor")]
    objects += [
        sphere([x, -0.5, -4 + draw.uniform(-0.5, 0.5)], 0.5, f"ball {i}")
        for i, x in enumerate((-1.2, 0.0, 1.2))
    ]
    if draw.random() < 0.5:
        objects.append(quad([-3, -1, -6], [6, 0, 0], [0, 4, 0], "floor"))
    size = float(draw.choice([0.3, 0.8, 1.5]))
    materials["lamp"] = lamp(6 / size**2)
    objects.append(quad([-size / 2, 2.5, -4], [size, 0, 0], [0, 0, size], "lamp"))
    sky = {"color": color(0.2, 0.6)} if draw.random() < 0.4 else {"color": [0.02, 0.02, 0.02]}
    used = {name: m for name, m in materials.items() if any(o["material"] == name for o in objects)}
    return scene_of(objects, used, {"fov": 50}, background=sky)
