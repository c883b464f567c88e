"""The kept picture, rendered again at the seeds of the current one to compare both.

At equal seeds and samples, the noise of both is the same where nothing changed: there the
difference is zero, and elsewhere it is that of the change.
"""

import moderngl

from glrt.gpu.context import Context
from glrt.plan.plan import Plan, Weights, are_trivial
from glrt.rendering.layer_weights import Mixer
from glrt.rendering.renderer import Renderer
from glrt.settings import Settings, settings_for
from glrt.view.edits.edited_state import State
from glrt.view.state.session import ANNOUNCED


class ReferenceImage:
    """The scene and settings of the kept picture, and a film of it if one is needed."""

    def __init__(self, state: State, mean: float, context: Context) -> None:
        """Render nothing yet; `mean`: mean radiance of the picture over pixels and channels."""
        self.state = state
        self.mean = mean
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

    def fits(self, other: Renderer) -> bool:
        """Whether both pictures have the same size."""
        return (self.state.settings.width, self.state.settings.height) == other.size

    def samples(self, other: Renderer) -> int:
        """Return the samples of each pixel at the seeds of the other picture."""
        if self._shared(other):
            return other.samples
        return self._renderer.samples if self._renderer else 0

    def catch_up(self, other: Renderer, seconds: float) -> None:
        """Render for about `seconds`, up to the samples of the other picture.

        Raises RenderError if the driver has no room for a second film.
        """
        if self._shared(other):
            return self.rest()
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
        renderer = self._renderer
        if not renderer or renderer.samples != other.samples:
            return None
        return renderer.film.mean

    def rest(self) -> None:
        """Release the second film."""
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
