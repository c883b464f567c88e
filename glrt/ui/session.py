"""What the window edits: a scene and its settings, and the renderer that follows them.

Edits are gathered and reach the renderer once a frame. It knows no window.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from glrt.context import Context
from glrt.errors import GlrtError
from glrt.image import Image
from glrt.needs import needs_of
from glrt.renderer import Renderer
from glrt.scene import Scene
from glrt.settings import Cost, Settings, settings_for
from glrt.ui.history import History

ANNOUNCED = 2  # frames that say what is about to stop them
STILL = 0.25  # seconds without a move after which the full size is rendered
COARSEST = 8  # pixels of the frame, in width and height, that share one of a preview


@dataclass(frozen=True)
class State:
    """What is edited, and what undo brings back."""

    scene: Scene
    settings: Settings


class Session:
    """A renderer that follows edits, a frame at a time."""

    def __init__(
        self,
        scene: Scene,
        settings: Settings,
        context: Context,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """Nothing is compiled before the first frames, which say that it will be."""
        self.state = self.opened = State(scene, settings_for(settings, crop=None))
        self.history: History[State] = History()
        self.renderer: Renderer | None = None
        self.paused = False
        self.busy = ""  # what the next frame will wait for
        self.problem = ""  # the last refusal, for the user
        self.restarts = 0
        self.rendering = 0.0  # seconds that were spent on the samples so far
        self.last_cost: Cost | None = None
        self._context = context
        self._clock = clock
        self._announced = 0
        self._moved = -STILL
        self._coarseness = 1
        self._budget = 0.0  # seconds: of the last frame
        self._pixel_seconds = 0.0  # for a sample of a pixel

    @property
    def scene(self) -> Scene:
        """The scene as edited."""
        return self.state.scene

    @property
    def settings(self) -> Settings:
        """The settings as edited, at full size."""
        return self.state.settings

    @property
    def samples(self) -> int:
        """Samples of each pixel of the picture."""
        return self.renderer.samples if self.renderer else 0

    @property
    def is_preview(self) -> bool:
        """Whether the renderer is at less than full size."""
        return self.renderer is not None and self.renderer.settings.width != self.settings.width

    @property
    def is_done(self) -> bool:
        """Whether nothing remains to be rendered."""
        waits = self.paused and self.samples > 0
        current = self.renderer is not None and self._wanted() == self._given(self.renderer)
        return current and (waits or self.samples >= self.settings.samples)

    def edit(self, scene: Scene | None = None, gesture: str = "", **changes: Any) -> None:
        """Take another scene or settings from the next frame on; a refusal is told, not raised."""
        try:
            after = State(scene or self.scene, settings_for(self.settings, **changes))
        except GlrtError as error:
            self.problem = str(error)
            return
        if after != self.state:
            self.history.record(self.state, gesture)
            self._follow(after)

    def undo(self) -> None:
        """Take back the last gesture."""
        self._follow(self.history.undo(self.state))

    def redo(self) -> None:
        """Do again what was taken back."""
        self._follow(self.history.redo(self.state))

    def restart(self) -> None:
        """Begin to accumulate anew."""
        if self.renderer:
            self.renderer.restart()
            self._begin()

    def advance(self, seconds: float, count: int = 0) -> None:
        """A frame: bring edits to the renderer, then render for a time or `count` samples."""
        self._budget = seconds
        if self._is_settled() and self.renderer:
            most = 1 if self.paused else self.settings.samples
            if count:
                most = min(most, self.samples + count)
            self._render(self.renderer, most, seconds)

    def image(self) -> Image:
        """The picture so far, with its error and its recipe."""
        assert self.renderer
        return self.renderer.image()

    def release(self) -> None:
        """Free what the driver holds."""
        if self.renderer:
            self.renderer.release()

    def _follow(self, after: State) -> None:
        if after.scene.camera != self.scene.camera:
            self._moved = self._clock()
            self._coarseness = self._fitting()
        self.state = after

    def _fitting(self) -> int:
        """The power of two that makes a sample of the whole frame fit into a frame's time."""
        seconds = self._pixel_seconds * self.settings.width * self.settings.height
        factor = 1
        while factor < COARSEST and seconds > self._budget * factor**2:
            factor *= 2
        return factor

    def _render(self, renderer: Renderer, target: int, seconds: float) -> None:
        """Dispatch until `target` samples or the end of the time; at least once if one is due."""
        start = now = self._clock()
        count = 1
        while renderer.samples < target and (now == start or now < start + seconds):
            count = min(count, target - renderer.samples, renderer.most_samples)
            renderer.step(count)
            before, now = now, self._clock()
            self._learn(renderer, count, now - before)
            fitting = (start + seconds - now) * count / max(1e-9, now - before)
            count = max(1, min(2 * count, int(fitting)))
        self.rendering += now - start

    def _learn(self, renderer: Renderer, count: int, seconds: float) -> None:
        width, height = renderer.size
        measured = seconds / (count * width * height)
        known = self._pixel_seconds or measured
        self._pixel_seconds = known + 0.3 * (measured - known)

    def _is_settled(self) -> bool:
        """Whether the renderer has all edits; what compiles is announced first."""
        is_behind = not self.renderer or self._wanted() != self._given(self.renderer)
        if is_behind and self._compiles() and self._announced < ANNOUNCED:
            self.busy = "Compiling a kernel for this scene"
            self._announced += 1
            return False
        self.busy, self._announced = "", 0
        if is_behind:
            try:
                self._apply()
            except GlrtError as error:
                self._refuse(error)
        return self.renderer is not None

    def _apply(self) -> None:
        wanted = self._wanted()
        if not self.renderer:
            self.renderer = Renderer(wanted.scene, wanted.settings, self._context)
            return self._begin()
        self.last_cost = self.renderer.update(wanted.scene, **dict(wanted.settings))
        if self.last_cost in (Cost.RESTART, Cost.RECOMPILE):
            self._begin()
        return None

    def _begin(self) -> None:
        assert self.renderer
        self.restarts += 1
        self.rendering = 0.0

    def _refuse(self, error: GlrtError) -> None:
        """Tell, and go back to what the renderer has; without one there is nothing to do."""
        self.problem = str(error)
        if not self.renderer:
            raise error
        self.state = State(self.renderer.scene, self.settings_of(self.renderer))

    def settings_of(self, renderer: Renderer) -> Settings:
        """The renderer's settings at full size."""
        size = {"width": self.settings.width, "height": self.settings.height}
        return settings_for(renderer.settings, **size)

    def _compiles(self) -> bool:
        if not self.renderer:
            return True
        before = needs_of(self.renderer.scene, self.renderer.settings)
        return needs_of(self.scene, self.settings) != before

    def _wanted(self) -> State:
        """What the renderer is to have: while the camera moves, a size that keeps up."""
        settings = self.settings
        factor = self._coarseness
        if factor > 1 and self._clock() - self._moved < STILL:
            size = {name: max(1, getattr(settings, name) // factor) for name in ("width", "height")}
            settings = settings_for(settings, **size)
        return State(self.scene, settings)

    @staticmethod
    def _given(renderer: Renderer) -> State:
        return State(renderer.scene, renderer.settings)
