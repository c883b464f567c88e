"""Gather AOVs on the driver while the picture grows: first surfaces, and bounces of paths.

A dispatch adds whole observations (blocks of samples). A picture that ends inside an observation
therefore has AOVs of at least all its samples.
"""

import time
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import moderngl
import numpy as np

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.gpu.driver_checks import usable_rounds
from glrt.gpu.program import tile_count
from glrt.gpu.programs import AnyKernel
from glrt.image.aovs import AovImage, AovImages
from glrt.packing.shapes import order_of_kernel
from glrt.plan.plan import Plan
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.kernel_switch import ready
from glrt.rendering.pass_film import Array, PassFilm
from glrt.rendering.passes import SLOTS, aov_pass
from glrt.rendering.schedule import (
    DispatchPolicy,
    DispatchRange,
    Schedule,
    iterations_per_sample,
    rounds_for_particles,
    rounds_of_search,
)
from glrt.scene.scene import Scene
from glrt.settings import OF_PATHS, Aov, Settings


class _Stage:
    """One pass that gathers one or two AOVs: its kernel, its film and its dispatch schedule."""

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
            self.film = PassFilm(context.gl, what, dict.fromkeys(render_pass.outputs, size))
            refused.callback(self.film.release)

            def dispatch(kernel: AnyKernel, part: DispatchRange) -> None:
                scene.dispatch(kernel, self.film, plan, part, self._tiles)

            self.kernel = ready(context, scene.shaders_of(render_pass), dispatch)
            refused.pop_all()

    def release(self) -> None:
        self.film.release()
        self._context.programs.give_back(self.kernel)

    def work_on(
        self, context: Context, plan: Plan, scene: DeviceScene, missing: int, seconds: float
    ) -> None:
        """Run one dispatch of about `seconds` towards the `missing` observations."""
        block = plan.settings.block
        planned = self.schedule.next_dispatch(missing, seconds, self.film.samples // block)
        part = planned._replace(samples=block * planned.samples)
        start = time.perf_counter()
        scene.dispatch(self.kernel, self.film, plan, part, self._tiles)
        context.finish()
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
            for pair in _together(aovs):
                self._stages.append(_Stage(context, plan, scene, pair))
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
        self, plan: Plan, scene: DeviceScene, samples: int, policy: DispatchPolicy, seconds: float
    ) -> None:
        """Run one dispatch of about `seconds` towards `samples` per pixel, if any are missing."""
        for stage in self._stages:
            missing = -(-(samples - stage.film.samples) // self._block)
            if missing > 0:
                planned = min(seconds, policy.limit / 2)
                return stage.work_on(self._context, plan, scene, missing, planned)
        return None

    def mean(self, aov: Aov) -> moderngl.Texture | None:
        """Texture of an AOV's mean in kernel numbers and coordinates; None without samples."""
        film, prefix = self._holding(aov)
        return film.sources[f"{prefix}mean"] if film else None

    def pixel(self, aov: Aov, x: int, y: int) -> Array | None:
        """The mean of an AOV in one pixel and its standard error, (2, 3).

        Pixel (0, 0) is upper left. Object numbers and coordinates are the kernel's. None if the AOV
        has no samples there.
        """
        film, prefix = self._holding(aov)
        if film is None:
            return None
        names = f"{prefix}mean", f"{prefix}variance"
        mean, variance = (film.read_output(name, y, y + 1)[0, x] for name in names)
        return np.stack([mean[:3], _standard_error(variance)]) if mean[3] else None

    def _holding(self, aov: Aov) -> tuple[PassFilm | None, str]:
        """The film that holds an AOV and the prefix of its outputs; None without samples."""
        for stage in self._stages:
            if aov in stage.aovs and stage.film.samples:
                return stage.film, SLOTS[stage.aovs.index(aov)]
        return None, ""

    def read(self, scene: Scene) -> AovImages:
        """Read all AOVs back; `scene` must be the plan's scene."""
        found = {
            aov: _image(aov, stage.film, prefix, scene)
            for stage in self._stages
            for aov, prefix in zip(stage.aovs, SLOTS, strict=False)
        }
        return {aov: found[aov] for aov in self.aovs}

    def release(self) -> None:
        """Release the films and give the kernels back."""
        for stage in self._stages:
            stage.release()


def _together(aovs: tuple[Aov, ...]) -> Iterator[tuple[Aov, ...]]:
    """Yield the AOVs of each pass: surface AOVs in pairs, each AOV of whole paths alone."""
    of_surfaces = tuple(aov for aov in aovs if aov not in OF_PATHS)
    yield from (of_surfaces[first : first + 2] for first in range(0, len(of_surfaces), 2))
    yield from ((aov,) for aov in aovs if aov in OF_PATHS)


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


def _image(aov: Aov, film: PassFilm, prefix: str, scene: Scene) -> AovImage:
    """Read one AOV back, with object numbers and positions converted to the scene's."""
    height = film.sources["mean"].height
    mean, variance = (film.read_output(f"{prefix}{n}", 0, height) for n in ("mean", "variance"))
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
