"""The kept picture, at the seeds and samples of the current one, to compare both.

At equal seeds and samples, the noise of both is the same where nothing changed: there the
difference is zero, and elsewhere it is that of the change. The kept picture has the samples that
it was kept with; for another number it is rendered again.
"""

from typing import NamedTuple

import moderngl
import numpy as np

from glrt.gpu.context import Context, checked
from glrt.plan.plan import Plan, Weights, are_trivial
from glrt.rendering.layer_weights import Mixer
from glrt.rendering.pass_film import Array
from glrt.rendering.renderer import Renderer
from glrt.settings import Settings, settings_for
from glrt.view.edits.edited_state import State
from glrt.view.state.session import ANNOUNCED


class Kept(NamedTuple):
    """A picture as it was kept."""

    radiance: Array  # (H, W, 3) float32
    samples: int  # of each pixel
    seed: int


class ReferenceImage:
    """The scene and settings of the kept picture, with a film of its own where that is needed."""

    def __init__(self, state: State, kept: Kept, context: Context) -> None:
        """Render nothing yet."""
        self.state = state
        self.mean = float(kept.radiance.mean(dtype=np.float64))  # over pixels and channels
        self._kept: Kept | None = kept
        self._texture: moderngl.Texture | None = None  # of its radiance
        self.busy = ""  # notice on what the next frame waits for
        self._context = context
        self._renderer: Renderer | None = None
        self._mixer = Mixer(context.gl)
        self._announced = 0
        self._asked: Plan | None = None
        self._answer: Weights | None = None

    def take(self, state: State) -> None:
        """Replace the kept picture by one that was rendered from `state`."""
        self.rest()
        self.state, self._asked, self._answer = state, None, None
        self._kept = None

    def fits(self, other: Renderer) -> bool:
        """Whether both pictures have the same size."""
        return (self.state.settings.width, self.state.settings.height) == other.size

    def samples(self, other: Renderer) -> int:
        """Return the samples of each pixel at the seeds of the other picture."""
        if self._shared(other) or self._fits_as_kept(other):
            return other.samples
        return self._renderer.samples if self._renderer else 0

    def catch_up(self, other: Renderer, seconds: float) -> None:
        """Render for about `seconds`, up to the samples of the other picture.

        Raises RenderError if the driver has no room for a second film.
        """
        if self._shared(other):
            return self.rest()
        if self._fits_as_kept(other):
            return self._end()
        renderer = self._renderer or self._open(other)
        if not renderer:
            return None
        if renderer.settings.seed != other.settings.seed:
            renderer.update(seed=other.settings.seed)
        if renderer.samples > other.samples:
            renderer.restart()
        if renderer.samples < other.samples:
            renderer.advance(seconds, other.samples)
        return None

    def light(self, other: Renderer) -> moderngl.Texture | None:
        """Return radiance with as many samples as the other picture; None while it has fewer."""
        weights = self._shared(other)
        if weights:
            trivial = are_trivial(weights)
            return other.film.mean if trivial else self._mixer.draw(other.film, weights)
        if self._fits_as_kept(other):
            return self.as_kept
        renderer = self._renderer
        if not renderer or renderer.samples != other.samples:
            return None
        return renderer.film.mean

    @property
    def as_kept(self) -> moderngl.Texture | None:
        """Radiance of the picture as it was kept; None if it is another one now, see `take`.

        Raises RenderError if the driver has no room for it.
        """
        if self._kept and not self._texture:
            height, width, _ = self._kept.radiance.shape
            texels = np.dstack([self._kept.radiance, np.ones((height, width), np.float32)])
            with checked(self._context.gl, f"a kept picture of {width} x {height} pixels"):
                self._texture = self._context.gl.texture((width, height), 4, texels, dtype="f4")
        return self._texture

    @property
    def samples_as_kept(self) -> int:
        """Samples of each pixel of `as_kept`; 0 without one."""
        return self._kept.samples if self._kept else 0

    def _fits_as_kept(self, other: Renderer) -> bool:
        """Whether the picture as it was kept has the seed and the samples of the other one."""
        own = self._kept and (self._kept.samples, self._kept.seed)
        return own == (other.samples, other.settings.seed)

    def rest(self) -> None:
        """Release all films; they are made again where they are needed."""
        self._end()
        if self._texture:
            self._texture.release()
        self._texture = None

    def _end(self) -> None:
        """Release the film of another number of samples."""
        if self._renderer:
            self._renderer.release()
        self._renderer, self.busy, self._announced = None, "", 0

    def release(self) -> None:
        """Release all OpenGL objects."""
        self.rest()
        self._mixer.release()

    def _shared(self, other: Renderer) -> Weights | None:
        """Return weights by which the other film shows the kept picture; None if it cannot."""
        plan = other.plan
        if plan is not self._asked:
            relit = plan.relit(self.state.scene, self._settings(other), plan.layering)
            self._asked, self._answer = plan, relit.weights if relit else None
        return self._answer

    def _settings(self, other: Renderer) -> Settings:
        return settings_for(self.state.settings, seed=other.settings.seed)

    def _open(self, other: Renderer) -> Renderer | None:
        """Announce for some frames, with None, that a kernel will be compiled; then compile it."""
        self.busy = "Compiling a kernel for the kept picture"
        self._announced += 1
        if self._announced <= ANNOUNCED:
            return None
        settings, context = self._settings(other), self._context
        self._renderer = Renderer(
            self.state.scene, settings, context, pipeline=other.pipeline, apart=other.plan.apart
        )
        self.busy = ""
        return self._renderer
