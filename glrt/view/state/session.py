"""The scene and settings that the window edits, and the renderer that follows them.

Edits are collected and reach the renderer once a frame. Nothing here needs the window.
"""

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from glrt.core.errors import GlrtError, RenderError, UsageError
from glrt.gpu.context import Context, Pipeline
from glrt.image.image import Image
from glrt.rendering.pipelines import resolve
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.surface_view import NEEDED
from glrt.scene.scene import Scene
from glrt.settings import OF_PATHS, Aov, Cost, Settings, settings_for
from glrt.view.edits.edited_state import State
from glrt.view.state.awaited_kernel import AwaitedKernel
from glrt.view.state.idle_kernel import IdleKernel
from glrt.view.state.layer_limits import LayerLimits
from glrt.view.state.live_probes import kept_by_probes
from glrt.view.state.moving_picture import MovingPicture
from glrt.view.state.preview_noise import FirstSurface
from glrt.view.state.preview_size import Preview
from glrt.view.state.shown_picture import ShownPicture
from glrt.view.state.upsampled_work import UpsampledWork

ANNOUNCED = 2  # frames that announce a compilation before it blocks them
LONGEST = 1.0  # seconds that a frame may take for a number of samples that the user chose


class Session(ShownPicture):
    """Edited scene and settings, and a renderer that follows the edits frame by frame."""

    def __init__(
        self,
        scene: Scene,
        settings: Settings,
        context: Context,
        clock: Callable[[], float] = time.perf_counter,
        pipeline: Pipeline = "auto",
        rest: IdleKernel | None = None,
    ) -> None:
        """Compile nothing yet; the first frames announce that a kernel will be compiled."""
        self.rest = rest
        self.ahead: AwaitedKernel | None = None  # compiles what edits need, in another process
        self.pipeline = resolve(pipeline, context)
        super().__init__(State(scene, settings_for(settings, crop=None, adaptive="off")))
        self.renderer: Renderer | None = None
        self.paused = False
        self.waits = False  # whether it gets no samples, so that another picture catches up
        self.alone: int | None = None  # the only path length that is shown; None: all
        self.aovs: tuple[Aov, ...] = ()  # that the view needs
        self.refused: tuple[Aov, ...] = ()  # that the driver refused
        self.stop: int | None = None  # samples at which a frame is to end
        self.surface, self.moving = FirstSurface(), MovingPicture(context.gl)
        self.busy = ""  # notice on what the next frame waits for
        self.restarts = 0
        self.rendering = 0.0  # seconds that were spent on the samples so far
        self.last_cost: Cost | None = None
        self.taken = 0.0  # processor seconds in which the last edit reached the renderer
        self.room = LayerLimits(int(context.gl.info["GL_MAX_TEXTURE_SIZE"]))
        self.context, self._clock = context, clock
        self._announced, self._preview = 0, Preview(clock)
        self._upsampled = UpsampledWork(self.moving, self._preview, clock)
        self._full_size = self.state.settings.size  # of the last edit that was applied

    @property
    def known_from(self) -> int:
        """Number of samples from which on an error is known: those of two observations."""
        return (self.renderer or self).settings.division.least_known

    @property
    def is_behind(self) -> bool:
        """Whether the renderer lacks an edit."""
        if self.renderer is None:
            return True
        given = State(self.renderer.scene, self.renderer.settings)
        is_other = given != self._wanted() or self.renderer.plan.layering != self.layering
        return is_other or self.renderer.probes.hysteresis != self._hysteresis

    @property
    def lag(self) -> float:
        """Share of the light in live probes that is from before the last edit; else 0."""
        return self.renderer.probes.lag if self.renderer else 0.0

    @property
    def _hysteresis(self) -> float | None:
        """Hysteresis of the probes for the next picture; None if they are not live."""
        return kept_by_probes(self.settings, self._preview.is_under_way)

    @property
    def is_done(self) -> bool:
        """Whether nothing remains to be rendered."""
        waits = self.paused and self.samples > 0
        is_short = self.renderer is None or self.renderer.lacks(self.settings.samples)
        is_short |= self._hysteresis is not None
        return not self.is_behind and not self.is_preview and (waits or not is_short)

    def restart(self) -> None:
        """Restart the picture from its first sample."""
        if self.renderer:
            self.renderer.restart()
            self.moving.forget()
            self._begin()

    def advance(self, seconds: float, count: int = 0) -> None:
        """Render a frame: apply edits, then render for `seconds`, or `count` samples if given."""
        start = self._clock()
        if self._apply_pending(seconds) and self.renderer:
            target = self.samples if self.waits else 1 if self.paused else self.settings.samples
            if count:
                target, seconds = min(target, self.samples + count), max(seconds, LONGEST)
            target = min(target, self.stop or target)
            is_short = self.renderer.lacks(target)
            if is_short and not (self.rest and self.rest.follow(self.renderer, self.restarts)):
                self._render(self.renderer, target, seconds, self._clock() - start)

    def reload_shaders(self) -> None:
        """Compile the shaders again, within `files_reread`; a RenderError keeps the old kernel."""
        if not self.renderer:
            return
        fresh = self._open(self._wanted())
        self.renderer.release()
        self.renderer, self.problem = fresh, ""
        self._begin()

    def _open(self, state: State) -> Renderer:
        ways: dict[str, Any] = {"pipeline": self.pipeline, "layering": self.layering}
        return Renderer(state.scene, state.settings, self.context, apart="moved", **ways)

    def image(self) -> Image:
        """Return picture, error and recipe, without AOVs of the view; UsageError for a preview."""
        if self.is_preview:
            raise UsageError("There is no picture of all pixels yet.")
        assert self.renderer
        return self.renderer.image(self.weights).with_aovs(self.settings.aov)

    def release(self) -> None:
        """Release all OpenGL objects."""
        for process in (self.rest, self.ahead):
            if process:
                process.end()
        self.moving.release()
        if self.renderer:
            self.renderer.release()

    def _render(self, renderer: Renderer, target: int, seconds: float, edit: float) -> None:
        start = self._clock()
        if renderer.samples and not self.is_preview:  # the frame of the first sample did enough
            refusal = self.moving.prepare(renderer, self.weights, at_once=False)
            self.problem = refusal or self.problem
            took, start = self._clock() - start, self._clock()
            edit += took
            self._preview.expect(took)  # the surfaces of the view, which an edit finds again
        work = self._upsampled if self._upsamples else self._preview
        work.work(renderer, target, seconds, edit)
        self.rendering += self._clock() - start
        if self.is_shown:
            self._preview.deliver()
        if self.is_done:  # no frame follows
            self.problem = self.moving.prepare(renderer, self.weights) or self.problem

    def _apply_pending(self, seconds: float) -> bool:
        """Apply edits, after announcing a compilation; returns whether there is a renderer."""
        cost = self._pending_cost()
        if cost is Cost.RECOMPILE and self._announced < ANNOUNCED:
            self.busy = "Compiling a kernel for this scene"
            self._announced += 1
            return False
        if self._waits_for_kernel(cost):
            self.busy = "Compiling a kernel for this scene"
            return False
        self.busy, self._announced = "", 0
        if cost is Cost.RESTART:
            pixels = self.settings.width * self.settings.height
            if self._preview.goes_on(pixels, seconds):
                return True
            self._preview.begin(pixels, seconds)
            self.moving.begin()
            self.surface.is_apt = bool(self.renderer and self.state.moves(self.renderer.scene))
        if self.is_behind:
            start, used = self._clock(), time.process_time()
            try:
                self._apply()
                self.taken = time.process_time() - used
                if self.ahead:
                    self.ahead.took(self.taken)
                self._full_size = self.settings.size
                if cost is Cost.RESTART:
                    self._preview.edited(self._clock() - start)
            except GlrtError as error:
                if not self.surface.refuse():  # else the next frame tries without
                    self._refuse(error)
        elif self.samples and not (self.paused or self.waits) and self._hysteresis is not None:
            self._go_on()
        return self.renderer is not None

    def _waits_for_kernel(self, cost: Cost | None) -> bool:
        """Whether the edit waits for a kernel that another process compiles."""
        if not self.ahead:
            return False
        renderer = self.renderer
        has_aovs = renderer and {*self.aovs} <= {*renderer.settings.aov}
        if cost is not Cost.RECOMPILE and has_aovs:
            self.ahead.end()
            return False
        before = renderer.device_scene.tree if renderer else None
        return self.ahead.holds(self._wanted(), self.layering, before)

    @property
    def _upsamples(self) -> bool:
        """Whether the present picture is, or is to be, reconstructed from samples of some pixels.

        That lasts until each pixel has been sampled, also after the last edit.
        """
        is_plain = not self.aovs and self.alone is None
        return is_plain and self._upsampled.is_due(self.renderer)

    def _go_on(self) -> None:
        """Begin another picture of the same scene, by live probes."""
        self.moving.begin()
        if self._update_renderer() is None and self.renderer:  # nothing changed, not even the seed
            self.renderer.restart()
            self._begin()

    def _apply(self) -> None:
        layering = self.layering
        try:
            self._update_renderer()
        except RenderError:
            if not self.room.refuse(self.scene, self.settings, layering):
                raise
            self._update_renderer()

    def _update_renderer(self) -> Cost | None:
        wanted, cost = self._wanted(), None
        if not self.renderer:
            self.renderer, cost = self._open(wanted), Cost.RECOMPILE
        else:
            edits = dict(wanted.settings)
            refusal = self.moving.leave(self.renderer, self.weights, wanted.settings)
            self.problem = refusal or self.problem
            scene, way = wanted.scene, (self.layering, self._hysteresis)
            cost = self.last_cost = self.renderer.update(scene, *way, **edits)
        if cost in (Cost.RESTART, Cost.RECOMPILE):
            self._begin()
        self.problem = self.moving.arrive(self.renderer, cost) or self.problem
        return cost

    def _begin(self) -> None:
        self.restarts, self.rendering = self.restarts + 1, 0.0

    def _refuse(self, error: GlrtError) -> None:
        """Report an error and go back to the renderer's state; without a renderer, raise it."""
        self.problem, self.refused = str(error), self.aovs
        self._preview.end()
        if not self.renderer:
            raise error
        own = self.settings.model_dump(include={"aov", "seed"})
        settings = settings_for(self.renderer.settings, **own)
        by_length = self.renderer.plan.layering == "lengths"
        before = replace(self._with(self.renderer.scene, settings), by_length=by_length)
        self.state = before.sized(*self._full_size)

    def _pending_cost(self) -> Cost | None:
        """Return the cost of edits that the renderer lacks; the size of a preview is no edit."""
        renderer = self.renderer
        if not renderer:
            return Cost.RECOMPILE
        if not self.is_behind:
            return None
        wanted = self.moving.alike(self._wanted(), renderer.settings, self.settings.seed)
        if not {*wanted.settings.aov} & {*OF_PATHS} <= {*renderer.settings.aov}:
            return Cost.RECOMPILE  # another kernel of paths
        cost = renderer.plan.cost_of(wanted.scene, wanted.settings, self.layering)
        is_resized = self._full_size != self.settings.size
        return Cost.RESTART if is_resized and cost is not Cost.RECOMPILE else cost

    def _wanted(self) -> State:
        """Return the state to render; while edits restart it, at a size that keeps frames fast."""
        factor = 1.0 if self._upsamples else self._preview.factor
        shown = self.aovs or (NEEDED if factor > 1 and self.surface.is_wanted else ())
        state = State(self.scene, self.settings).showing(*shown).coarser(factor)
        is_moving = self._preview.is_under_way or self._upsamples or self._hysteresis is not None
        return self.moving.reseeded(state) if is_moving else state
