"""Gather AOVs on the driver while the picture grows: of first surfaces, and of whole paths.

A dispatch adds whole observations (blocks of samples). A picture that ends inside an observation
therefore has AOVs of at least all its samples.
"""

import time
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from typing import Any, NamedTuple

import moderngl
import numpy as np

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.gpu.driver_checks import usable_rounds
from glrt.gpu.program import Resource, tile_count
from glrt.gpu.programs import AnyKernel
from glrt.image.aovs import AovImage, AovImages
from glrt.packing.shapes import order_of_kernel
from glrt.plan.plan import Plan
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
from glrt.settings import OF_PATHS, TERMS, Aov, Settings


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


class _Place(NamedTuple):
    """Where a film holds an AOV."""

    film: PassFilm
    prefix: str  # of the names of its outputs
    part: int
    parts: int  # side by side in an output

    def rows(self, name: str, first: int, end: int) -> Array:
        """Rows of an output, (rows, width, 4)."""
        rows = self.film.read_output(f"{self.prefix}{name}", first, end)
        width = rows.shape[1] // self.parts
        return rows[:, self.part * width : (self.part + 1) * width]


class _Stage:
    """One pass that gathers some AOVs: its kernel, its film and its dispatch schedule."""

    def __init__(
        self,
        context: Context,
        plan: Plan,
        scene: DeviceScene,
        aovs: tuple[Aov, ...],
    ) -> None:
        self.aovs, self._context = aovs, context
        render_pass, size = aov_pass(aovs), plan.settings.size
        self._tiles = tile_count(*size)
        self.schedule = Schedule(self._tiles, _most_observations(context, plan, aovs))
        what = f"{' and '.join(aovs)} of {size[0]} x {size[1]} pixels"
        with ExitStack() as refused:
            parts = len(aovs) if aovs[0] in TERMS else 1
            sizes = dict.fromkeys(render_pass.outputs, (parts * size[0], size[1]))
            self.film = PassFilm(context.gl, what, sizes)
            refused.callback(self.film.release)

            def dispatch(kernel: AnyKernel, part: DispatchRange) -> None:
                scene.dispatch(kernel, self.film, plan, part, self._tiles)

            self.kernel = ready(context, scene.shaders_of(render_pass), dispatch)
            refused.pop_all()

    def release(self) -> None:
        self.film.release()
        self._context.programs.give_back(self.kernel)

    def places(self) -> Iterator[tuple[Aov, _Place]]:
        """Yield each AOV of this pass, and where it is held."""
        for number, aov in enumerate(self.aovs):
            if aov in TERMS:
                yield aov, _Place(self.film, "", number, len(self.aovs))
            else:
                yield aov, _Place(self.film, SLOTS[number], 0, 1)

    def work_on(self, subject: Subject, missing: int, seconds: float) -> None:
        """Run one dispatch of about `seconds` towards the `missing` observations."""
        plan, scene, own = subject
        block = plan.settings.block
        planned = self.schedule.next_dispatch(missing, seconds, self.film.samples // block)
        part = planned._replace(samples=block * planned.samples)
        start = time.perf_counter()
        scene.dispatch(self.kernel, self.film, plan, part, self._tiles, own)
        self._context.finish()
        if scene.lost_any() and planned.samples > 1:
            self.schedule.limit(planned.samples // 2)
        elif self.schedule.record(planned, time.perf_counter() - start):
            self.film.advance(part.samples)


class AovTracer:
    """Gathers the AOVs that the settings request."""

    def __init__(self, context: Context, plan: Plan, scene: DeviceScene) -> None:
        """Allocate the films and compile the kernels.

        Raises SceneError if one observation exceeds the driver's loop limit. Raises RenderError if
        the driver refuses a kernel or has no room for a film.
        """
        self.aovs = aovs = plan.settings.gathered
        self._context, self._size, self._block = context, plan.settings.size, plan.settings.block
        self._stages: list[_Stage] = []
        start = time.perf_counter()
        with ExitStack() as refused:
            refused.callback(self.release)
            for together in _together(aovs, scene.pipeline):
                self._stages.append(_Stage(context, plan, scene, together))
            refused.pop_all()
        self.compile_seconds = time.perf_counter() - start if aovs else 0.0

    def serve(self, settings: Settings) -> bool:
        """Whether these films and kernels also serve `settings`, if the scene's kernel does."""
        wanted = settings.size, settings.block, settings.gathered
        return wanted == (self._size, self._block, self.aovs)

    def check(self, plan: Plan) -> None:
        """Raise SceneError if one observation of a plan exceeds the driver's loop limit."""
        for stage in self._stages:
            _most_observations(self._context, plan, stage.aovs)

    def restart(self, plan: Plan) -> None:
        """Discard all samples and begin `plan`, which these kernels must serve."""
        for stage in self._stages:
            stage.schedule.limit(_most_observations(self._context, plan, stage.aovs))
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
        """Run one dispatch of about `seconds` towards `samples` per pixel, if any are missing."""
        for stage in self._stages:
            missing = -(-(samples - stage.film.samples) // self._block)
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
        return np.stack([mean[:3], _standard_error(variance)]) if mean[3] else None

    def _place_of(self, aov: Aov) -> _Place | None:
        """Where an AOV is held; None without samples."""
        for stage in self._stages:
            if aov in stage.aovs and stage.film.samples:
                return dict(stage.places())[aov]
        return None

    def read(self, scene: Scene) -> AovImages:
        """Read all AOVs back; `scene` must be the plan's scene."""
        found = {
            aov: _image(aov, place, scene)
            for stage in self._stages
            for aov, place in stage.places()
        }
        return {aov: found[aov] for aov in self.aovs}

    def release(self) -> None:
        """Release the films and give the kernels back."""
        for stage in self._stages:
            stage.release()


def _together(aovs: tuple[Aov, ...], pipeline: Resolved) -> Iterator[tuple[Aov, ...]]:
    """Yield the AOVs of each pass: surface AOVs in pairs, bounces alone, terms of light together.

    A fragment shader writes to its own pixel alone, so it gathers one term in each pass.
    """
    of_surfaces = tuple(aov for aov in aovs if aov not in OF_PATHS)
    yield from (of_surfaces[first : first + 2] for first in range(0, len(of_surfaces), 2))
    yield from ((aov,) for aov in aovs if aov in OF_PATHS and aov not in TERMS)
    terms = tuple(aov for aov in aovs if aov in TERMS)
    if pipeline == "fragment":
        yield from ((term,) for term in terms)
    elif terms:
        yield terms


def _most_observations(context: Context, plan: Plan, aovs: tuple[Aov, ...]) -> int:
    """The most observations per dispatch; SceneError if not even one fits."""
    block, is_of_paths = plan.settings.block, aovs[0] in OF_PATHS
    iterations, certain = _rounds_of_paths(plan) if is_of_paths else _rounds_of_rays(plan)
    rounds = usable_rounds(context)
    if rounds is not None and block * certain > rounds:
        what = f"{block} {'paths' if is_of_paths else 'camera rays'}"
        which = f"--aov {aovs[0]}" if is_of_paths else "--aov"
        raise SceneError(
            f"{which} is beyond this driver's loop limit here: {what} take up to "
            f"{block * certain} rounds of its loops, and it stops silently after {rounds}. Leave "
            "it out, use --sampler independent, fewer objects"
            f"{', fewer bounces' if is_of_paths else ''} or a GPU."
        )
    return 1 << 10 if rounds is None else max(1, rounds // (block * iterations))


def _rounds_of_rays(plan: Plan) -> tuple[int, int]:
    """Loop rounds of one camera ray: the likely number, and the least that is certain."""
    return 1 + rounds_of_search(plan.facts), 1 + rounds_of_search(plan.facts, 0)


def _rounds_of_paths(plan: Plan) -> tuple[int, int]:
    """Loop rounds of one whole path: the likely number, and the least that is certain."""
    more = rounds_for_particles(plan)
    return iterations_per_sample(plan) + more, iterations_per_sample(plan, 0) + more


def _image(aov: Aov, place: _Place, scene: Scene) -> AovImage:
    """Read one AOV back, with object numbers and positions converted to the scene's."""
    height = place.film.sources["mean"].height
    mean, variance = (place.rows(name, 0, height) for name in ("mean", "variance"))
    if aov == "object":
        numbers = np.array([0, *(1 + index for index in order_of_kernel(scene))], np.uint32)
        return AovImage(numbers[mean[..., 0].astype(np.int64)])
    count, observations = mean[..., 3], variance[..., 3]
    value, stderr = mean[..., :3], _standard_error(variance)
    is_met = count[..., None] > 0
    if aov == "position":
        eye = np.array(scene.camera.position, np.float64)
        value = np.where(is_met, value + eye, 0.0).astype(np.float32)
    if aov == "depth":
        value = np.where(is_met, value, np.float32(np.inf))
    if aov in ("depth", "bounces"):
        value, stderr = value[..., 0], stderr[..., 0]
    counts = (part.astype(np.uint32) for part in (count, observations))
    return AovImage(np.ascontiguousarray(value), np.ascontiguousarray(stderr), *counts)


def _standard_error(variance: Array) -> Any:
    """Standard error of each mean; channel 3 of `variance` counts observations, NaN below two."""
    count = variance[..., 3:]
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.sqrt(variance[..., :3] / (count - 1))
    return np.where(count >= 2, error, np.float32(np.nan)).astype(np.float32)
