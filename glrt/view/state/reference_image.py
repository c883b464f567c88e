"""The picture that is kept to compare with, rendered again at the seeds of the current one.

At equal seeds and samples the noise of both is the same where nothing changed: there the
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
    """What a picture was rendered from, and a film of it where one is needed."""

    def __init__(self, state: State, mean: float, context: Context) -> None:
        """`mean`: radiance of the picture, over pixels and channels. Nothing is rendered yet."""
        self.state = state
        self.mean = mean
        self.busy = ""  # what the next frame will wait for
        self._context = context
        self._renderer: Renderer | None = None
        self._mixer = Mixer(context.gl)
        self._announced = 0
        self._asked: Plan | None = None
        self._answer: Weights | None = None

    def take(self, state: State) -> None:
        """Another picture in the place of this one, which was rendered from `state`."""
        self.rest()
        self.state, self._asked, self._answer = state, None, None

    def fits(self, other: Renderer) -> bool:
        """Whether the pictures have one size."""
        return (self.state.settings.width, self.state.settings.height) == other.size

    def samples(self, other: Renderer) -> int:
        """Samples of each pixel at the seeds of the other picture."""
        if self._shared(other):
            return other.samples
        return self._renderer.samples if self._renderer else 0

    def catch_up(self, other: Renderer, seconds: float) -> None:
        """Work for about so many seconds, up to the samples of the other picture.

        RenderError if the driver has no room for a second film.
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
        """Radiance with as many samples as the other picture; None while it has fewer."""
        weights = self._shared(other)
        if weights:
            trivial = are_trivial(weights)
            return other.film.mean if trivial else self._mixer.draw(other.film, weights)
        renderer = self._renderer
        if not renderer or renderer.samples != other.samples:
            return None
        return renderer.film.mean

    def rest(self) -> None:
        """Give the second film back."""
        if self._renderer:
            self._renderer.release()
        self._renderer, self.busy, self._announced = None, "", 0

    def release(self) -> None:
        """Free what the driver holds."""
        self.rest()
        self._mixer.release()

    def _shared(self, other: Renderer) -> Weights | None:
        """Weights by which the other's film shows the kept picture; None if it cannot."""
        plan = other.plan
        if plan is not self._asked:
            relit = plan.relit(self.state.scene, self._settings(other), plan.layering)
            self._asked, self._answer = plan, relit.weights if relit else None
        return self._answer

    def _settings(self, other: Renderer) -> Settings:
        return settings_for(self.state.settings, seed=other.settings.seed)

    def _open(self, other: Renderer) -> Renderer | None:
        """Say that a kernel will be compiled, then compile it."""
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
