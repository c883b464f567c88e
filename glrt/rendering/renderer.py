"""Render a scene with settings: samples on a film, step by step."""

import math
import time
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import replace
from typing import Any, Unpack

import moderngl
import numpy as np

from glrt.core.errors import UsageError
from glrt.core.version import VERSION
from glrt.denoise.filters import with_filter
from glrt.gpu.context import Choice, Context, Pipeline, open_context
from glrt.image import shared_numbers
from glrt.image.image import Image
from glrt.image.layer_sums import LayerSums
from glrt.image.partition import Partition, one_part, wanted_range
from glrt.image.recipe import Recipe, lasting, traced
from glrt.image.resume import fitting
from glrt.plan.plan import ONE, Layering, Weights
from glrt.rendering.adaptive_tracer import kind_of
from glrt.rendering.first_half import Halver, check_rest
from glrt.rendering.layer_weights import Mixer, gathered, mixed
from glrt.rendering.pipelines import PLAIN, Fast, KernelOptions, Tier, Variant, resolve
from glrt.rendering.progress import Progress
from glrt.rendering.schedule import ENOUGH, HEADLESS, INTERACTIVE, DispatchPolicy
from glrt.rendering.screen.display import displayed
from glrt.rendering.shutter import Shutter
from glrt.rendering.tracer import Tracer
from glrt.scene.instancing import Apart
from glrt.scene.scene import Scene
from glrt.setting_options import SettingOptions
from glrt.settings import Cost, Settings, settings_for


class Renderer(Progress):
    """Renders a scene a few samples at a time; `update` changes the scene or the settings."""

    def __init__(
        self,
        scene: Scene,
        settings: Settings | None = None,
        context: Context | Choice = "auto",
        tier: Tier = "generic",
        pipeline: Pipeline = "auto",
        layering: Layering = "none",
        variant: Variant = PLAIN,
        part: tuple[int, int] | None = None,
        decisions: Mapping[str, str] = {},
        apart: Apart = "repeated",
        opens_shutter: bool = False,
        **overrides: Unpack[SettingOptions],
    ) -> None:
        """Open OpenGL, compile the kernel and allocate the film.

        `overrides` are fields of Settings; the rest is in `settings`, or in the scene's `[render]`.
        The tier "baked" writes up to 64 shapes into the kernel: faster, but each edit of them
        compiles; "complete" writes lamps, too. "placed" compiles for no edit of places. The
        pipeline is compute, or fragment for OpenGL 4.1. A `variant` of the kernel is an experiment.
        `layering` by "groups" lets lamps change without a restart, by "lengths" it lets the bounces
        be fewer. A `part` (k, n) renders the k-th of n parts of the samples, from k = 1. `apart`
        selects meshes with trees of their own: moved without a new tree, but slower to trace.
        `decisions` are stored in recipes: what chose a setting for the user, by its name. With
        `opens_shutter` the camera's shutter blurs what its animation moves. Raises
        UsageError for settings that do not go together, ContextError, RenderError, SceneError.
        """
        if not isinstance(scene, Scene):
            raise UsageError(f"a Scene is wanted, got {scene!r}: glrt.load reads one")
        self.scene = scene
        self.settings = with_filter(settings_for(settings or scene.render, **overrides))
        self._decisions = decisions, self.settings
        self._part: Partition | None = one_part(*part, self.settings) if part else None
        self._shutter = Shutter(scene, self.settings, opens_shutter, apart)
        wanted = layering, part is not None
        self._shutter.check(*wanted, pipeline == "fragment")
        self.plan = self._shutter.plan(layering, self._samples.start)
        self._owns_context = not isinstance(context, Context)
        self.context = context if isinstance(context, Context) else open_context(context, pipeline)
        with ExitStack() as refused:
            if self._owns_context:
                refused.callback(self.context.gl.release)
            self.pipeline = resolve(pipeline, self.context)
            self._shutter.check(*wanted, self.pipeline == "fragment")
            with self.context.gl:
                kept: Tier = "generic" if self._shutter.is_open else tier  # between samples
                options = KernelOptions(self.pipeline, kept, variant)
                self._tracer: Tracer = kind_of(self.plan)(self.context, self.plan, options)
            refused.pop_all()
        self._mixer = Mixer(self.context.gl)
        self._halver = Halver()

    @property
    def wanted_samples(self) -> int:
        """Samples per pixel to render: those of the settings, or of the part."""
        return len(self._samples)

    def begin_part(self, number: int) -> None:
        """Begin the part `number` of the same render, without samples."""
        assert self._part
        self._part = one_part(number, self._part.count, self.settings)
        self.plan = replace(self.plan, first_sample=self._samples.start)
        self._tracer.begin_at(self._samples.start)
        self._halver.restart()

    @property
    def _samples(self) -> range:
        return wanted_range(self._part, self.settings)

    def _check_part(self, samples: int) -> None:
        if self._part and samples > self.wanted_samples:
            raise UsageError(f"Part {self._part} has {self.wanted_samples} samples, not {samples}.")

    def weighed(self, weights: Weights) -> moderngl.Texture:
        """Texture of the film under weights, valid until the next call; needs a current context."""
        return self._mixer.draw(self.film, weights, self._tracer.shown_particles)

    def restart(self) -> None:
        """Discard all samples and begin again."""
        self._tracer.restart()
        self._halver.restart()

    def update(
        self,
        scene: Scene | None = None,
        layering: Layering | None = None,
        hysteresis: float | None = None,
        **changes: Unpack[SettingOptions],
    ) -> Cost | None:
        """Change scene or settings, and keep what still fits; returns the cost, None for no change.

        With a hysteresis, probes continue from picture to picture: see ProbeSupply.
        """
        layering = layering or self.plan.layering
        after = scene or self.scene, with_filter(settings_for(self.settings, **changes))
        is_same = hysteresis == self.probes.hysteresis
        if is_same and (*after, layering) == (self.scene, self.settings, self.plan.layering):
            return None
        shutter = self._shutter.after(*after)
        shutter.check(layering, self._part is not None, self.pipeline == "fragment")
        self._halver.restart()
        wanted = wanted_range(self._part, after[1])
        is_other_part = self._part is not None and wanted != self._samples
        can_relight = is_same and not is_other_part
        plan = shutter.relit(self.plan, layering, self._shutter) if can_relight else None
        if plan:
            cost = Cost.FREE if plan == self.plan else Cost.RELIGHT
            with self.context.gl:
                self._tracer.use_aovs(after[1])
        else:
            plan = shutter.plan(layering, wanted.start, self.plan)
            with self.context.gl:
                self._tracer, cost = self._tracer.replaced_for(plan, hysteresis, kind=kind_of(plan))
        (self.scene, self.settings), self._shutter, self.plan = after, shutter, plan
        return cost

    def bake(self, tier: Fast = "baked") -> bool:
        """Switch to a faster kernel that has the shapes written into it; the bits stay the same.

        After an edit of what is written, a slower kernel continues at once. The tier "placed"
        writes no places: it stays where the camera or shapes are moved. Returns False if there is
        no faster kernel: this one is as fast, or the shapes are too many.
        """
        with self.context.gl:
            return self._tracer.use_fast(tier)

    def step(self, samples: int) -> None:
        """Add `samples` to every pixel, at once if they fit; UsageError above `most_samples`."""
        if not (most := self.most_samples) >= samples >= 1:
            raise UsageError(f"a dispatch of this scene takes 1 to {most} samples, not {samples}")
        self._check_part(self.samples + samples)
        with self.context.gl:
            while samples:
                together = self._followed(samples)
                self._tracer.step(together)
                self._complete()
                samples -= together

    def advance(self, seconds: float, samples: int | None = None) -> bool:
        """Work for about `seconds`, up to `samples` per pixel (default: the settings').

        Returns whether the picture changed: one frame of it may take several calls.
        """
        target = self.wanted_samples if samples is None else samples
        self._check_part(target)
        before, start, spent = self.shown, time.perf_counter(), 0.0
        while self.lacks(target) and spent <= ENOUGH * seconds:
            self._work(target - self.samples, INTERACTIVE, seconds - spent)
            spent = time.perf_counter() - start
        return self.shown != before

    def render(
        self, samples: int | None = None, goes_on: Callable[["Renderer"], bool] | None = None
    ) -> "Renderer":
        """Render until each pixel has `samples` in all (default: the settings'); return self.

        `goes_on` is called after each dispatch; the render stops early if it returns False.
        """
        target = self.wanted_samples if samples is None else samples
        self._check_part(target)
        while self.lacks(target):
            if self._halver.wants(self.settings, self.samples, target):
                self._halver.keep(self.image_for_halves())
            stop = self._halver.next_stop(self.settings, self.samples, target)
            self._work(stop - self.samples, HEADLESS)
            if goes_on and not goes_on(self):
                break
        return self

    def image(self, weights: Weights | None = None) -> Image:
        """The picture so far, with standard error and recipe; `weights` scale its layers."""
        if self.settings.denoise == "none":
            return self._halver.finished(self.plain_image(weights))
        done = self._halver.finished(self.image_for_halves(weights))
        return replace(done, film_state=None) if self.plan.layers else done

    def plain_image(self, weights: Weights | None = None) -> Image:
        """The picture without denoising, with all gathered AOVs, a denoiser's guides among them."""
        self.probes.check()
        weights = weights or self.plan.weights
        with self.context.gl:
            self._complete()
            aovs = self._tracer.aov_images()
            mean, noise, state = mixed(self.film, weights)
            if state and self.settings.division.is_shared:
                mean, noise = shared_numbers.picture(mean, state.groups, aovs)
            waiting = self._tracer.with_particles(mean, noise, weights, waits=True)
        radiance, stderr, films = waiting
        return Image(radiance, stderr, self.samples, self._recipe(weights), state, aovs, films)

    def image_for_halves(self, weights: Weights | None = None) -> Image:
        """Like `plain_image`, for a denoiser also of films with layers; no render can resume it."""
        image = self.plain_image(weights)
        if image.film_state:
            return image
        with self.context.gl:
            known = gathered(self.film, weights or self.plan.weights)
        if isinstance(known, LayerSums):
            return replace(image, sums=known)
        return replace(image, film_state=known)

    def resume(self, image: Image) -> "Renderer":
        """Continue from a picture, to the bits of one render; UsageError says why it cannot."""
        film_state = fitting(image, self._recipe((ONE,)))
        with self.context.gl:
            self._tracer.resume(image.samples, image.radiance, film_state, image.particles)
        self._halver.restart()
        check_rest(self.settings, image.samples)
        return self

    def display(self) -> np.ndarray[Any, Any]:
        """The picture so far through the display pass: (H, W, 3) uint8 sRGB, row 0 on top."""
        with self.context.gl:
            return displayed(self.context.gl, self.weighed(self.plan.weights), self.settings)

    def release(self) -> None:
        """Release all OpenGL resources; the context too, unless it was given."""
        with self.context.gl:
            self._tracer.release()
            self._mixer.release()
        if self._owns_context:
            self.context.gl.release()

    def _recipe(self, weights: Weights) -> Recipe:
        return Recipe(
            scene=self.scene.exposed if self._shutter.is_open else self.scene.still,
            settings=self.settings,
            samples=self.samples,
            version=VERSION,
            renderer=self.context.renderer,
            tier=self._tracer.tier,
            pipeline=self.pipeline,
            traced=traced(self.plan, weights),
            partition=self._part,
            decisions=lasting(*self._decisions, self.settings),
            apart="large" if self.plan.apart == "large" else "repeated",
        )

    def _work(self, remaining: int, policy: DispatchPolicy, seconds: float = math.inf) -> None:
        with self.context.gl:
            together = self._followed(remaining)
            self._tracer.work_on(together, policy, seconds)

    def _complete(self) -> None:
        """Gather the AOVs of all samples, while each of these sees a scene of its own."""
        while self._shutter.is_open and self._tracer.is_behind:
            self._work(1, HEADLESS)

    def _followed(self, samples: int) -> int:
        """How many of `samples` see the scene that the driver now has for the first of them."""
        if plan := self._shutter.next_plan(self.next_sample, self.plan):
            known, compiled = self.device_scene.seconds, self._tracer.switch.compile_seconds
            self._tracer, _ = self._tracer.replaced_for(plan, keeps_samples=True)
            self.plan = plan
            self._tracer.switch.compile_seconds += compiled
            seconds = self.device_scene.seconds.items()
            self.device_scene.seconds = {name: known[name] + more for name, more in seconds}
        return min(samples, 1) if self._shutter.is_open else samples
