"""Scene + Settings -> samples on a film, step by step."""

import math
import time
from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np

from glrt.blocks import Tier
from glrt.context import Choice, Context, Pipeline, open_context
from glrt.display import displayed
from glrt.errors import UsageError
from glrt.film import Film
from glrt.image import Image
from glrt.kernel import tile_count
from glrt.mix import Mixer, mixed
from glrt.pipelines import resolve
from glrt.recipe import Recipe, traced
from glrt.relight import ONE, Layering, Weights, are_trivial, plan_for
from glrt.resume import fitting
from glrt.scene import Scene
from glrt.schedule import (
    HEADLESS_LIMIT,
    INTERACTIVE_LIMIT,
    INTERACTIVE_PATIENCE,
    Portion,
    Schedule,
    iterations_per_sample,
    most_samples,
    whole_frame,
)
from glrt.selftest import usable_rounds
from glrt.settings import Cost, Settings, settings_for
from glrt.turns import AnyKernel, Turns
from glrt.uploaded import Uploaded
from glrt.version import VERSION

ENOUGH = 0.75  # of a budget of time: the rest is not worth another dispatch


class Renderer:
    """Renders a scene a few samples at a time.

    A different scene or setting given to `update` restarts, or does not, by its cost class.
    """

    def __init__(
        self,
        scene: Scene,
        settings: Settings | None = None,
        context: Context | Choice = "auto",
        tier: Tier = "generic",
        pipeline: Pipeline = "auto",
        layering: Layering = "none",
        **overrides: Any,
    ) -> None:
        """Open OpenGL, compile the kernel, allocate the film.

        `overrides` are fields of Settings; the rest comes from the scene's `[render]`. The tier
        "baked" writes up to 32 shapes into the kernel: faster, but each edit of them compiles.
        The pipeline is compute, or fragment for drivers without compute shaders (OpenGL 4.1).
        `layering` by "groups" lets lamps change without a restart, by "lengths" fewer bounces.
        Raises ContextError, RenderError, and SceneError for a scene beyond the driver.
        """
        self.scene = scene
        self.settings = settings_for(settings or scene.render, **overrides)
        self._owns_context = not isinstance(context, Context)
        self.context = context if isinstance(context, Context) else open_context(context, pipeline)
        self.pipeline = resolve("compute" if layering != "none" else pipeline, self.context)
        self._wanted_tier = tier
        self._mixer = Mixer(self.context.gl)
        self.plan = plan_for(self.scene, self.settings, layering)
        most_samples = self._most_samples(self.scene, self.settings)
        with self.context.gl:
            self._upload(most_samples)
            self._film = Film(self.context.gl, *self.size, self.settings.block, self.plan.layers)
            self._compile()

    @property
    def samples(self) -> int:
        """How many samples each pixel has."""
        return self._film.samples

    @property
    def work(self) -> float:
        """Samples a pixel, and the share that is done of those in the frame that has begun."""
        return self.samples + self._turns.schedule.begun

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture in pixels: of the crop, if there is one."""
        return (self.settings.crop or (0, 0, self.settings.width, self.settings.height))[2:]

    @property
    def film(self) -> Film:
        """What has been gathered."""
        return self._film

    def weighed(self, weights: Weights) -> moderngl.Texture:
        """The film under weights, for the display pass: until the next call, in this context."""
        return self._film.mean if are_trivial(weights) else self._mixer.draw(self._film, weights)

    def restart(self) -> None:
        """Begin to accumulate anew."""
        self._turns.schedule.drop()
        with self.context.gl:
            self._film.restart(*self.size, self.settings.block, self.plan.layers)

    def update(
        self, scene: Scene | None = None, layering: Layering | None = None, **changes: Any
    ) -> Cost | None:
        """Go on with another scene or other settings; returns what that cost, None for nothing.

        The one place where accumulation starts again. What is refused changes nothing.
        """
        layering = layering or self.plan.layering
        after = scene or self.scene, settings_for(self.settings, **changes)
        if (*after, layering) == (self.scene, self.settings, self.plan.layering):
            return None
        if relit := self.plan.relit(*after, layering):
            cost = Cost.FREE if relit == self.plan else Cost.RELIGHT
            (self.scene, self.settings), self.plan = after, relit
            return cost
        most_samples = self._most_samples(*after)
        (self.scene, self.settings), self.plan = after, plan_for(*after, layering)
        before = self._uploaded
        with self.context.gl:
            before.release()
            self._upload(most_samples)
            if not (self._uploaded.is_read_alike(before) and self._uploaded.has_shapes_of(before)):
                self._turns.take_back()
            self._film.restart(*self.size, self.settings.block, self.plan.layers)
            if self._uploaded.is_read_alike(before):
                self._turns.schedule.restart(self._tiles, most_samples, after[1].bounces)
                return Cost.RESTART
            self._turns.release()
            self._compile()
            return Cost.RECOMPILE

    def bake(self) -> bool:
        """Go on, to the same bits, by a faster kernel that has the shapes written into it.

        When a shape changes, or the place of the camera, the kernel from before goes on at once.
        False where there is none: this one has them, or they are too many.
        """
        shaders = None if self._turns.is_passed else self._uploaded.baked()
        if shaders:
            with self.context.gl:
                self._turns.pass_to(shaders)
        return shaders is not None

    @property
    def is_baked(self) -> bool:
        """Whether the kernel that runs has the shapes written into it."""
        return self.tier == "baked" or self._turns.is_passed

    def step(self, samples: int) -> None:
        """Add `samples` samples to every pixel at once, or as many at once as prove to fit."""
        if not 1 <= samples <= self.most_samples:
            raise UsageError(
                f"a dispatch of this scene takes 1 to {self.most_samples} samples, not {samples}"
            )
        self._turns.schedule.drop()
        target = self.samples + samples
        with self.context.gl:
            while self.samples < target:
                self._at_once(min(self.most_samples, target - self.samples))

    def advance(self, seconds: float, samples: int | None = None) -> bool:
        """Work for about `seconds`, up to `samples` samples a pixel (default: the settings').

        Returns whether the picture changed: a frame, one sample of each pixel or more, may take
        several calls. Until it is complete the picture stays as it was.
        """
        target = samples or self.settings.samples
        before, start, spent = self.samples, time.perf_counter(), 0.0
        while self.samples < target and spent <= ENOUGH * seconds:
            left = min(seconds - spent, INTERACTIVE_LIMIT / 2)
            self._work(target - self.samples, left, INTERACTIVE_PATIENCE)
            spent = time.perf_counter() - start
        return self.samples != before

    def render(
        self, samples: int | None = None, goes_on: Callable[["Renderer"], bool] | None = None
    ) -> "Renderer":
        """Step until each pixel has `samples` (default: the settings'), or `goes_on` says no.

        `goes_on` is asked after each dispatch, of which a frame may need several.
        """
        target = samples or self.settings.samples
        while self.samples < target:
            self._work(target - self.samples, HEADLESS_LIMIT / 2)
            if goes_on and not goes_on(self):
                break
        return self

    def image(self, weights: Weights | None = None) -> Image:
        """The picture so far, with its standard error and its recipe; `weights` show it so."""
        weights = weights or self.plan.weights
        with self.context.gl:
            radiance, stderr, gathered = mixed(self._film, weights)
        return Image(radiance, stderr, self.samples, self._recipe(weights), gathered)

    def resume(self, image: Image) -> "Renderer":
        """Go on from a picture, to the bits of one render; UsageError says why not, if not."""
        gathered = fitting(image, self._recipe((ONE,)))
        self._turns.schedule.drop()
        with self.context.gl:
            self._film.write(image.samples, image.radiance, gathered)
        return self

    def display(self) -> np.ndarray[Any, Any]:
        """The picture so far through the display pass: (H, W, 3) uint8 sRGB, row 0 on top."""
        with self.context.gl:
            return displayed(self.context.gl, self.weighed(self.plan.weights), self.settings)

    def nonfinite(self) -> int:
        """How many samples were dropped because they were not finite."""
        with self.context.gl:
            return self._film.dropped()

    def release(self) -> None:
        """Free what the driver holds, the context too unless it was given."""
        with self.context.gl:
            for part in (self._film, self._turns, self._mixer, self._uploaded):
                part.release()
        if self._owns_context:
            self.context.gl.release()

    def _recipe(self, weights: Weights) -> Recipe:
        return Recipe(
            scene=self.scene,
            settings=self.settings,
            samples=self.samples,
            version=VERSION,
            renderer=self.context.renderer,
            tier=self.tier,
            pipeline=self.pipeline,
            traced=traced(self.plan, weights),
        )

    def _most_samples(self, scene: Scene, settings: Settings) -> int:
        """How many samples a dispatch may take; SceneError if not one."""
        iterations = iterations_per_sample(scene, settings)
        self._rounds = usable_rounds(self.context, iterations)
        return most_samples(iterations, self._rounds, iterations_per_sample(scene, settings, 0))

    def _upload(self, most_samples: int) -> None:
        kind, gl = (self.pipeline, self._wanted_tier), self.context.gl
        self._uploaded = Uploaded(gl, self.plan, *kind, self._parts())
        self.tier = self._uploaded.tier
        self._tiles, self.most_samples = tile_count(*self.size), most_samples

    def _parts(self) -> dict[str, str]:
        """Texts that stand in for shader files."""
        return {}

    def _compile(self) -> None:
        schedule = Schedule(self._tiles, self.most_samples)
        self._turns = Turns(self.context, self._uploaded.shaders, schedule, self._dispatch)
        self.compile_seconds = self._turns.compile_seconds
        self.longest_dispatch = 0.0  # seconds, apart from the first one

    def _at_once(self, samples: int) -> None:
        """Samples of every pixel at once; none if they prove too many."""
        for portion in whole_frame(samples, self._tiles):
            self._dispatch(self._turns.kernel, portion)
        self.context.finish()
        if self._fits(samples):
            self._film.advance(samples)

    def _fits(self, samples: int) -> bool:
        """Whether no sample of this frame was lost to the loop limit, or fewer would not help.

        Rays through a tree take as many rounds as they take. A frame that lost some is done again
        with fewer samples at once; what is lost then is counted on the film.
        """
        if self._rounds is None or not self._uploaded.lost_any() or samples == 1:
            return True
        self.most_samples = samples // 2
        self._turns.schedule.limit(self.most_samples)
        return False

    def _work(self, remaining: int, seconds: float, patience: float = math.inf) -> None:
        """One dispatch that the schedule plans; all those of a frame read the same source."""
        portion = self._turns.schedule.next_portion(remaining, seconds, self.samples, patience)
        start = time.perf_counter()
        with self.context.gl:
            self._dispatch(self._turns.kernel, portion)
            self.context.finish()
            taken = time.perf_counter() - start
            self.longest_dispatch = max(self.longest_dispatch, taken)
            if self._fits(portion.samples) and self._turns.schedule.record(portion, taken):
                self._film.advance(portion.samples)

    def _dispatch(self, kernel: AnyKernel, portion: Portion) -> None:
        images = self._film.images()
        self._uploaded.dispatch(kernel, images, self.plan, self.samples, portion, self._tiles)
