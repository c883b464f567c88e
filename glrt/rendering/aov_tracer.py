"""Gather AOVs on the driver while the picture grows: of first surfaces, and of whole paths.

A dispatch adds whole observations (blocks of samples). A picture that ends inside an observation
therefore has AOVs of at least all its samples. With an open shutter each sample sees a scene of its
own: then a dispatch adds one sample, and observations go on from dispatch to dispatch.
"""

import time
from collections.abc import Collection, Iterator, Mapping
from contextlib import ExitStack
from typing import Any, NamedTuple

import moderngl
import numpy as np

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.gpu.driver_checks import usable_rounds
from glrt.gpu.program import Resource, tile_count
from glrt.gpu.programs import AnyKernel
from glrt.image.aovs import AovImages
from glrt.plan.plan import Plan
from glrt.rendering.aov_places import Place, image_of, standard_error
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.kernel_switch import ready
from glrt.rendering.pass_film import Array, PassFilm
from glrt.rendering.passes import SLOTS, Resolved, aov_pass
from glrt.rendering.schedule import (
    DispatchPolicy,
    DispatchRange,
    Schedule,
    iterations_per_sample,
    rounds_for_particles,
    rounds_of_search,
)
from glrt.scene.scene import Scene
from glrt.settings import OF_PATHS, TERMS, Aov


class Subject(NamedTuple):
    """A scene on the driver that AOVs are gathered of."""

    plan: Plan
    scene: DeviceScene
    own: Mapping[str, Resource]  # of probes


class AovMean(NamedTuple):
    """The texture of an AOV's mean: one of some parts that lie side by side in it."""

    texture: moderngl.Texture
    part: int
    parts: int


class _Stage:
    """One pass that gathers some AOVs: its kernel, its film and its dispatch schedule."""

    def __init__(
        self,
        context: Context,
        plan: Plan,
        scene: DeviceScene,
        aovs: tuple[Aov, ...],
        kept: PassFilm | None = None,
    ) -> None:
        """Add to the film `kept`, or to a new one."""
        self.aovs, self._context = aovs, context
        render_pass, size = aov_pass(aovs, plan.is_blurred), plan.settings.size
        self._tiles = tile_count(*size)
        self.schedule = Schedule(self._tiles, _most_at_once(context, plan, aovs))
        what = f"{' and '.join(aovs)} of {size[0]} x {size[1]} pixels"
        with ExitStack() as refused:
            parts = len(aovs) if aovs[0] in TERMS else 1
            sizes = dict.fromkeys(render_pass.outputs, (parts * size[0], size[1]))
            self.film = kept or PassFilm(context.gl, what, sizes)
            if not kept:
                refused.callback(self.film.release)

            def dispatch(kernel: AnyKernel, part: DispatchRange) -> None:
                scene.dispatch(kernel, self.film, plan, part, self._tiles)

            self.kernel = ready(context, scene.shaders_of(render_pass), dispatch)
            refused.pop_all()

    def release(self, kept: Collection[PassFilm]) -> None:
        if self.film not in kept:
            self.film.release()
        self._context.programs.give_back(self.kernel)

    def places(self) -> Iterator[tuple[Aov, Place]]:
        """Yield each AOV of this pass, and where it is held."""
        for number, aov in enumerate(self.aovs):
            if aov in TERMS:
                yield aov, Place(self.film, "", number, len(self.aovs))
            else:
                yield aov, Place(self.film, SLOTS[number], 0, 1)

    def work_on(self, subject: Subject, missing: int, seconds: float) -> None:
        """Run one dispatch of about `seconds` towards the `missing` observations or pieces."""
        plan, scene, own = subject
        unit = _unit(plan)
        planned = self.schedule.next_dispatch(missing, seconds, self.film.samples // unit)
        part = planned._replace(samples=unit * planned.samples)
        start = time.perf_counter()
        scene.dispatch(self.kernel, self.film, plan, part, self._tiles, own)
        self._context.finish()
        if scene.lost_any() and planned.samples > 1:
            self.schedule.limit(planned.samples // 2)
        elif self.schedule.record(planned, time.perf_counter() - start):
            self.film.advance(part.samples)


class AovTracer:
    """Gathers the AOVs that the settings request."""

    def __init__(
        self, context: Context, plan: Plan, scene: DeviceScene, before: "AovTracer | None" = None
    ) -> None:
        """Compile the kernels, and allocate the films, or take over those of `before`.

        Raises SceneError if one dispatch exceeds the driver's loop limit. Raises RenderError if the
        driver refuses a kernel or has no room for a film.
        """
        self.aovs = aovs = plan.settings.gathered
        self._context, self._served = context, _served(plan)
        self._stages: list[_Stage] = []
        start = time.perf_counter()
        with ExitStack() as refused:
            refused.callback(self.release, before)
            for number, together in enumerate(_together(plan, scene.pipeline)):
                kept = before._stages[number] if before else None
                if kept:
                    kept.schedule.drop()  # the first dispatch of a kernel writes to its film
                film = kept.film if kept else None
                self._stages.append(_Stage(context, plan, scene, together, film))
            refused.pop_all()
        self.compile_seconds = time.perf_counter() - start if aovs else 0.0

    def serve(self, plan: Plan) -> bool:
        """Whether these films serve a plan, and the kernels, too, if the scene's kernel does."""
        return _served(plan) == self._served

    def check(self, plan: Plan) -> None:
        """Raise SceneError if one dispatch of a plan exceeds the driver's loop limit."""
        for stage in self._stages:
            _most_at_once(self._context, plan, stage.aovs)

    def restart(self, plan: Plan) -> None:
        """Discard all samples and begin `plan`, which these kernels must serve."""
        for stage in self._stages:
            stage.schedule.limit(_most_at_once(self._context, plan, stage.aovs))
            stage.film.restart(plan.first_sample)

    @property
    def samples(self) -> int:
        """Samples per pixel of the AOV with the fewest samples; 0 without AOVs."""
        return min((stage.film.samples for stage in self._stages), default=0)

    def is_behind(self, samples: int) -> bool:
        """Whether an AOV has fewer than `samples` per pixel."""
        return any(stage.film.samples < samples for stage in self._stages)

    def work_on(
        self, subject: Subject, samples: int, policy: DispatchPolicy, seconds: float
    ) -> None:
        """Run one dispatch of about `seconds` towards `samples` per pixel, if any are missing.

        With an open shutter it works on one sample alone: the subject is the scene of that one.
        """
        unit = _unit(subject.plan)
        if subject.plan.is_blurred:
            samples = min(samples, self.samples + 1)
        for stage in self._stages:
            missing = -(-(samples - stage.film.samples) // unit)
            if missing > 0:
                planned = min(seconds, policy.limit / 2)
                return stage.work_on(subject, missing, planned)
        return None

    def mean(self, aov: Aov) -> AovMean | None:
        """An AOV's mean in kernel numbers and coordinates; None without samples."""
        place = self._place_of(aov)
        if place is None:
            return None
        return AovMean(place.film.sources[f"{place.prefix}mean"], place.part, place.parts)

    def pixel(self, aov: Aov, x: int, y: int) -> Array | None:
        """The mean of an AOV in one pixel and its standard error, (2, 3).

        Pixel (0, 0) is upper left. Object numbers and coordinates are the kernel's. None if the AOV
        has no samples there.
        """
        place = self._place_of(aov)
        if place is None:
            return None
        mean, variance = (place.rows(name, y, y + 1)[0, x] for name in ("mean", "variance"))
        return np.stack([mean[:3], standard_error(variance)]) if mean[3] else None

    def _place_of(self, aov: Aov) -> Place | None:
        """Where an AOV is held; None without samples."""
        for stage in self._stages:
            if aov in stage.aovs and stage.film.samples:
                return dict(stage.places())[aov]
        return None

    def read(self, scene: Scene) -> AovImages:
        """Read all AOVs back; `scene` must be the plan's scene."""
        found = {
            aov: image_of(aov, place, scene)
            for stage in self._stages
            for aov, place in stage.places()
        }
        return {aov: found[aov] for aov in self.aovs}

    def release(self, after: "AovTracer | None" = None) -> None:
        """Release the films, except the ones of `after`, and give the kernels back.

        If it is `after` itself, nothing is released.
        """
        if after is self:
            return
        kept = [stage.film for stage in after._stages] if after else []
        for stage in self._stages:
            stage.release(kept)


def _served(plan: Plan) -> tuple[Any, ...]:
    """All that decides the films of a plan, and its passes."""
    settings = plan.settings
    return settings.size, settings.block, settings.gathered, plan.is_blurred


def _unit(plan: Plan) -> int:
    """Samples that a dispatch adds whole numbers of."""
    return 1 if plan.is_blurred else plan.settings.block


def _together(plan: Plan, pipeline: Resolved) -> Iterator[tuple[Aov, ...]]:
    """Yield the AOVs of each pass: surface AOVs in pairs, bounces alone, terms of light together.

    Surface AOVs go one by one with an open shutter. A fragment shader writes to its own pixel
    alone, so it gathers one term in each pass.
    """
    aovs, size = plan.settings.gathered, 1 if plan.is_blurred else 2
    of_surfaces = tuple(aov for aov in aovs if aov not in OF_PATHS)
    yield from (of_surfaces[first : first + size] for first in range(0, len(of_surfaces), size))
    yield from ((aov,) for aov in aovs if aov in OF_PATHS and aov not in TERMS)
    terms = tuple(aov for aov in aovs if aov in TERMS)
    if pipeline == "fragment":
        yield from ((term,) for term in terms)
    elif terms:
        yield terms


def _most_at_once(context: Context, plan: Plan, aovs: tuple[Aov, ...]) -> int:
    """The most observations, or pieces of them, per dispatch; SceneError if not even one fits."""
    unit, is_of_paths = _unit(plan), aovs[0] in OF_PATHS
    iterations, certain = _rounds_of_paths(plan) if is_of_paths else _rounds_of_rays(plan)
    rounds = usable_rounds(context)
    if rounds is not None and unit * certain > rounds:
        what = f"{unit} {'paths' if is_of_paths else 'camera rays'}"
        which = f"--aov {aovs[0]}" if is_of_paths else "--aov"
        raise SceneError(
            f"{which} is beyond this driver's loop limit here: {what} take up to "
            f"{unit * certain} rounds of its loops, and it stops silently after {rounds}. Leave "
            "it out, use --sampler independent, fewer objects"
            f"{', fewer bounces' if is_of_paths else ''} or a GPU."
        )
    return 1 << 10 if rounds is None else max(1, rounds // (unit * iterations))


def _rounds_of_rays(plan: Plan) -> tuple[int, int]:
    """Loop rounds of one camera ray: the likely number, and the least that is certain."""
    return 1 + rounds_of_search(plan.facts), 1 + rounds_of_search(plan.facts, 0)


def _rounds_of_paths(plan: Plan) -> tuple[int, int]:
    """Loop rounds of one whole path: the likely number, and the least that is certain."""
    more = rounds_for_particles(plan)
    return iterations_per_sample(plan) + more, iterations_per_sample(plan, 0) + more
