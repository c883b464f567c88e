"""AOVs on the driver: of first surfaces and of whole paths, gathered as the picture grows.

Whole observations are gathered: a picture that ends inside one has AOVs of all its samples.
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
    """A pass for one or two AOVs: its kernel, its film, and what its dispatches took."""

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
        """One dispatch; so many observations are missing."""
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
    """Gathers the AOVs that settings ask for."""

    def __init__(self, context: Context, plan: Plan, scene: DeviceScene) -> None:
        """Allocate films, and compile.

        Raises SceneError if an observation is beyond the driver's loop limit, and RenderError.
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
        """Whether films and kernels do for other settings, if the kernel of the scene does."""
        wanted = settings.size, settings.block, settings.gathered
        return wanted == (self._size, self._block, self.aovs)

    def check(self, plan: Plan) -> None:
        """SceneError if an observation of a plan is beyond the driver's loop limit."""
        for stage in self._stages:
            _most_observations(self._context, plan, stage.aovs)

    def restart(self, plan: Plan) -> None:
        """Forget everything, and begin a plan that these kernels serve."""
        for stage in self._stages:
            stage.schedule.limit(_most_observations(self._context, plan, stage.aovs))
            stage.film.restart(plan.first_sample)

    @property
    def samples(self) -> int:
        """Samples of each pixel in the AOV that has fewest; 0 if there is none."""
        return min((stage.film.samples for stage in self._stages), default=0)

    def is_behind(self, samples: int) -> bool:
        """Whether an AOV has fewer samples than a picture."""
        return any(stage.film.samples < samples for stage in self._stages)

    def work_on(
        self, plan: Plan, scene: DeviceScene, samples: int, policy: DispatchPolicy, seconds: float
    ) -> None:
        """One dispatch towards so many samples, in about `seconds`; nothing if they are there."""
        for stage in self._stages:
            missing = -(-(samples - stage.film.samples) // self._block)
            if missing > 0:
                planned = min(seconds, policy.limit / 2)
                return stage.work_on(self._context, plan, scene, missing, planned)
        return None

    def mean(self, aov: Aov) -> moderngl.Texture | None:
        """The texture that holds an AOV so far, in the kernel's terms; None if it is empty."""
        film, prefix = self._holding(aov)
        return film.sources[f"{prefix}mean"] if film else None

    def pixel(self, aov: Aov, x: int, y: int) -> Array | None:
        """The mean of an AOV in one pixel, and its standard error, in the kernel's terms: (2, 3).

        (0, 0) is upper left. None if the AOV is empty, or nothing was met there.
        """
        film, prefix = self._holding(aov)
        if film is None:
            return None
        names = f"{prefix}mean", f"{prefix}variance"
        mean, variance = (film.read_output(name, y, y + 1)[0, x] for name in names)
        return np.stack([mean[:3], _standard_error(variance)]) if mean[3] else None

    def _holding(self, aov: Aov) -> tuple[PassFilm | None, str]:
        """The film that holds an AOV, and the prefix of its outputs; None if it is empty."""
        for stage in self._stages:
            if aov in stage.aovs and stage.film.samples:
                return stage.film, SLOTS[stage.aovs.index(aov)]
        return None, ""

    def read(self, scene: Scene) -> AovImages:
        """The AOVs so far; the scene is that of the plan."""
        found = {
            aov: _image(aov, stage.film, prefix, scene)
            for stage in self._stages
            for aov, prefix in zip(stage.aovs, SLOTS, strict=False)
        }
        return {aov: found[aov] for aov in self.aovs}

    def release(self) -> None:
        """Free what the driver holds."""
        for stage in self._stages:
            stage.release()


def _together(aovs: tuple[Aov, ...]) -> Iterator[tuple[Aov, ...]]:
    """Those that share a pass: two at most, and each of whole paths alone."""
    of_surfaces = tuple(aov for aov in aovs if aov not in OF_PATHS)
    yield from (of_surfaces[first : first + 2] for first in range(0, len(of_surfaces), 2))
    yield from ((aov,) for aov in aovs if aov in OF_PATHS)


def _most_observations(context: Context, plan: Plan, aovs: tuple[Aov, ...]) -> int:
    """How many observations a dispatch takes; SceneError if not even one."""
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
    """Of the loops of one camera ray: as many as are likely, and those that are certain."""
    return 1 + rounds_of_search(plan.facts), 1 + rounds_of_search(plan.facts, 0)


def _rounds_of_paths(plan: Plan) -> tuple[int, int]:
    """The same of a whole path."""
    more = rounds_for_particles(plan)
    return iterations_per_sample(plan) + more, iterations_per_sample(plan, 0) + more


def _image(aov: Aov, film: PassFilm, prefix: str, scene: Scene) -> AovImage:
    """One AOV read back: numbers of the kernel become those of the scene."""
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
    """Of means over observations, whose number is the last channel; NaN for fewer than two."""
    count = variance[..., 3:]
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.sqrt(variance[..., :3] / (count - 1))
    return np.where(count >= 2, error, np.float32(np.nan)).astype(np.float32)
