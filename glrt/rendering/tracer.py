"""A plan on the driver: its scene, its film, and the kernel between them."""

import math
import time
from contextlib import ExitStack
from dataclasses import replace

import moderngl

from glrt.gpu.context import Context
from glrt.gpu.program import Resource, tile_count
from glrt.gpu.programs import AnyKernel
from glrt.image.aovs import AovImages
from glrt.image.film_state import FilmState
from glrt.image.particle_film import ParticleFilm
from glrt.plan.plan import Plan, Weights
from glrt.rendering.aov_tracer import AovTracer, Subject
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.film import Extent, Film
from glrt.rendering.kernel_switch import KernelSwitch
from glrt.rendering.particle_tracer import ParticleTracer, particles_for
from glrt.rendering.pass_film import Array
from glrt.rendering.pipelines import Fast, KernelOptions, Tier
from glrt.rendering.probe_supply import ProbeSupply
from glrt.rendering.raster import Raster
from glrt.rendering.schedule import (
    HEADLESS,
    DispatchPolicy,
    DispatchRange,
    Schedule,
    dispatch_limits,
    iterations_per_sample,
    whole_frame,
)
from glrt.settings import Cost, Settings


class Tracer:
    """Adds the samples of a plan to a film, a dispatch at a time."""

    def __init__(
        self,
        context: Context,
        plan: Plan,
        options: KernelOptions,
        before: "Tracer | None" = None,
        hysteresis: float | None = None,
    ) -> None:
        """Create the resources of a plan; the film of `before` is reused if it fits.

        With a hysteresis, probes continue from those of `before`. Raises SceneError for a scene
        beyond the driver, and RenderError. After an error nothing is held, and `before` has lost at
        most its incomplete frame.
        """
        self._context, self._plan, self._options = context, plan, options
        self._rounds, self.most_samples = dispatch_limits(context, plan)
        self._tiers: set[Tier] = set()  # tiers of the kernels that added samples
        self._tiles = tile_count(*plan.settings.size)
        with ExitStack() as refused:
            scene = DeviceScene(context, plan, options, before.device_scene if before else None)
            self.device_scene: DeviceScene = scene
            refused.callback(scene.release)
            extent = Extent.of(plan.settings, plan.layers, scene.keeps_reservoirs)
            probes = before.probes if before and scene.has_kernel_of(before.device_scene) else None
            self.probes: ProbeSupply = ProbeSupply(context, plan, scene, probes, hysteresis)
            refused.callback(self.probes.release, probes)
            kept = before.film if before and before.film.extent == extent else None
            self.film: Film = kept or Film(context.gl, extent)
            if not kept:
                refused.callback(self.film.release)
            if before:
                before.drop_frame()  # the first dispatch writes to it
            self._raster = Raster(context, plan, scene)
            refused.callback(self._raster.release)
            self.most_samples = self._raster.at_once(self.most_samples)
            self.switch: KernelSwitch = self._compiled()
            refused.callback(self.switch.release)
            self.particles: ParticleTracer | None = particles_for(context, plan, scene)
            if self.particles:
                refused.callback(self.particles.release)
            self.aovs: AovTracer = self._aovs_for(plan.settings, before)
            refused.pop_all()
        if not before:
            self.restart()

    def replaced_for(
        self,
        plan: Plan,
        hysteresis: float | None = None,
        keeps_samples: bool = False,
        kind: "type[Tracer] | None" = None,
    ) -> tuple["Tracer", Cost]:
        """A tracer for another plan, of another `kind` if given, and the cost of the change.

        It has no samples unless it keeps them. It takes over this tracer's film if that fits, and
        releases the rest. Errors are those of the constructor; after one, this tracer is unchanged.
        """
        after = (kind or type(self))(self._context, plan, self._options, self, hysteresis)
        is_same = after.device_scene.has_kernel_of(self.device_scene)
        if is_same and self.switch.fast:
            after.switch.take_up(self.switch.fast, after.device_scene.faster)
        if self.film is not after.film:
            self.film.release()
        self.aovs.release(after.aovs)
        self.probes.release(after.probes)
        self._release_own()
        if not keeps_samples:
            after.film.restart(plan.first_sample)
            after.aovs.restart(plan)
        return after, Cost.RESTART if is_same else Cost.RECOMPILE

    @property
    def tier(self) -> str:
        """Tier of the kernels that added samples; on software drivers both give the same bits."""
        if self._context.is_software or not self._tiers:
            return self.device_scene.tier
        return " and ".join(sorted(self._tiers))

    def drop_frame(self) -> None:
        """Discard the frame that is under way."""
        self.switch.schedule.drop()

    def restart(self) -> None:
        """Discard all samples and begin again."""
        self.drop_frame()
        self.film.restart(self._plan.first_sample)
        if self.particles:
            self.particles.restart(self._plan.first_sample)
        self.probes.restart()
        self.aovs.restart(self._plan)
        self._tiers.clear()

    def begin_at(self, first_sample: int) -> None:
        """Discard all samples and begin again at sample number `first_sample`."""
        self._plan = replace(self._plan, first_sample=first_sample)
        self.restart()

    def use_aovs(self, settings: Settings) -> None:
        """Gather other AOVs; after an error, as of the constructor, the AOVs are unchanged."""
        if settings.gathered != self.aovs.aovs:
            after = self._aovs_for(settings, self)
            after.restart(self._plan)
            self.aovs.release(after)
            self.aovs = after

    @property
    def is_behind(self) -> bool:
        """Whether particles or AOVs have fewer samples than the picture."""
        return self._lacks_particles or self.aovs.is_behind(self.film.samples)

    def catch_up(self) -> None:
        """Gather the particles and the AOVs of all samples."""
        while self.is_behind:
            self._work_behind(HEADLESS, math.inf)

    def aov_images(self) -> AovImages:
        """The AOVs of all samples."""
        self.catch_up()
        return self.aovs.read(self._plan.scene)

    def with_particles(
        self, radiance: Array, stderr: Array, weights: Weights, first: int = 0, waits: bool = False
    ) -> tuple[Array, Array, ParticleFilm | None]:
        """Rows of the film under weights plus the light of particles, and the two films apart.

        With `waits`, or before the first observation of particles, all missing ones are gathered.
        """
        if not self.particles:
            return radiance, stderr, None
        self._catch_up_particles(waits)
        return self.particles.added_to(radiance, stderr, weights, first)

    @property
    def shown_particles(self) -> moderngl.Texture | None:
        """Texture of the light of particles: a mean over complete observations, or None."""
        self._catch_up_particles()
        return self.particles.film.sources["mean"] if self.particles else None

    def _catch_up_particles(self, waits: bool = False) -> None:
        if waits or not (self.particles and self.particles.film.samples):
            while self._lacks_particles:
                self._work_behind(HEADLESS, math.inf)

    def resume(
        self, samples: int, mean: Array, film_state: FilmState, particles: ParticleFilm | None
    ) -> None:
        """Continue from a picture that a kernel of the same tier has rendered."""
        self.drop_frame()
        self.film.write(samples, particles.camera if particles else mean, film_state)
        if self.particles and particles:
            self.particles.resume(samples, particles)
        self.aovs.restart(self._plan)
        self._tiers = {self.device_scene.tier}

    def use_fast(self, tier: Fast) -> bool:
        """Switch to a faster kernel; False if this one is as fast, or if there is none."""
        shaders = None if self.switch.fast == tier else self.device_scene.faster(tier)
        if shaders:
            self.switch.use_fast(shaders, tier)
        return shaders is not None

    def step(self, samples: int) -> None:
        """Add `samples` to every pixel at once, or in portions if they prove too many."""
        self.drop_frame()
        target = self.film.samples + samples
        while self.film.samples < target:
            self.probes.work_on(self.film.next_sample)
            wanted = self.probes.together(self.film.next_sample, target - self.film.samples)
            most = min(self.film.at_once(self.most_samples), wanted)
            self._at_once(self.film.next_at_once(most))
            if self.probes.tracer or self.particles:
                self.catch_up()  # AOVs see the probes of the picture

    def work_on(self, remaining: int, policy: DispatchPolicy, seconds: float) -> None:
        """Run one dispatch: of particles or AOVs that lag behind, of probes, or of the picture."""
        planned, next_sample = min(seconds, policy.limit / 2), self.film.next_sample
        if self.is_behind:
            self._work_behind(policy, seconds)
        elif self.probes.lack(next_sample):
            self.probes.work_on(next_sample, planned)
        else:
            self._work_on_picture(self.probes.together(next_sample, remaining), planned, policy)

    def _work_on_picture(self, remaining: int, planned: float, policy: DispatchPolicy) -> None:
        schedule, start = self.switch.schedule, time.perf_counter()
        remaining = self.film.next_at_once(remaining)
        part = schedule.next_dispatch(remaining, planned, self.film.samples, policy)
        self._dispatch(self.switch.kernel, part)
        self._context.finish()
        if self._fits(part.samples) and schedule.record(part, time.perf_counter() - start):
            self._advance(part.samples)

    def release(self) -> None:
        """Release all OpenGL resources."""
        for part in (self.film, self.probes, self.aovs):
            part.release()
        self._release_own()

    def _release_own(self) -> None:
        """Release what no other tracer takes over."""
        for part in (self.particles, self._raster, self.switch, self.device_scene):
            if part:
                part.release()

    def _aovs_for(self, settings: Settings, before: "Tracer | None" = None) -> AovTracer:
        """The AOV tracer for settings: that of `before` if it serves them, else a new one."""
        plan = replace(self._plan, settings=settings)
        served = before.aovs if before and before.aovs.serve(plan) else None
        if before and served and self.device_scene.has_kernel_of(before.device_scene):
            served.check(plan)
            return served
        return AovTracer(self._context, plan, self.device_scene, served)

    @property
    def _lacks_particles(self) -> bool:
        return bool(self.particles and self.particles.is_behind(self.film.samples))

    def _work_behind(self, policy: DispatchPolicy, seconds: float) -> None:
        if self.particles and self._lacks_particles:
            self.particles.work_on(policy, seconds)
        else:
            subject = Subject(self._plan, self.device_scene, self.probes.resources)
            self.aovs.work_on(subject, self.film.samples, policy, seconds)

    def _compiled(self) -> KernelSwitch:
        rounds = iterations_per_sample(self._plan)
        schedule = Schedule(self._tiles, self.film.at_once(self.most_samples), rounds)
        return KernelSwitch(self._context, self.device_scene.shaders, schedule, self._dispatch)

    def _at_once(self, samples: int) -> None:
        """Add samples to every pixel at once; add none if they prove too many."""
        for part in whole_frame(samples, self._tiles):
            self._dispatch(self.switch.kernel, part)
        self._context.finish()
        if self._fits(samples):
            self._advance(samples)

    def _advance(self, samples: int) -> None:
        self.film.advance(samples)
        self._tiers.add(self.switch.fast or self.device_scene.tier)

    def _fits(self, samples: int) -> bool:
        """Whether the frame lost no sample to the loop limit, or has one, counted on the film."""
        # Rounds of rays through a tree are not known before. Other frames are repeated with fewer.
        fits = self._rounds is None or not self.device_scene.lost_any() or samples == 1
        if not fits:
            self.most_samples = samples // 2
            self.switch.schedule.limit(self.most_samples)
        return fits

    def _dispatch(self, kernel: AnyKernel, part: DispatchRange) -> None:
        own = self._own(part)
        self.device_scene.dispatch(kernel, self.film, self._plan, part, self._tiles, own)

    def _own(self, part: DispatchRange) -> dict[str, Resource]:
        drawn = self._raster.drawn(self.film, part.samples)
        return {**self.probes.resources, **self.film.resources, **drawn}
