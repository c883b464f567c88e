"""The kind of picture that a session has: whole, coarse, or temporary."""

from glrt.plan.methods import has_ambient
from glrt.plan.plan import Layering, Weights
from glrt.rendering.passes import Resolved
from glrt.rendering.renderer import Renderer
from glrt.settings import TERMS, Aov
from glrt.view.edits.editing import Editing
from glrt.view.state.layer_limits import LayerLimits
from glrt.view.state.moving_picture import MovingPicture


class ShownPicture(Editing):
    """Properties of the picture of a session."""

    renderer: Renderer | None
    moving: MovingPicture
    pipeline: Resolved
    alone: int | None  # the only path length that is shown; None: all
    aovs: tuple[Aov, ...]  # that the view needs
    room: LayerLimits

    @property
    def samples(self) -> int:
        """Samples of each pixel of the picture."""
        return self.renderer.samples if self.renderer else 0

    @property
    def is_reduced(self) -> bool:
        """Whether the renderer works at less than full size."""
        return self.renderer is not None and self.renderer.settings.width != self.settings.width

    @property
    def is_upsampled(self) -> bool:
        """Whether the picture is reconstructed from samples of some pixels."""
        return self.moving.is_coarse(self.renderer)

    @property
    def is_preview(self) -> bool:
        """Whether the picture is coarse: of less than full size, or reconstructed."""
        return self.is_reduced or self.is_upsampled

    @property
    def is_passing(self) -> bool:
        """Whether the picture is temporary: coarse, or by live probes."""
        is_live = self.renderer is not None and self.renderer.probes.hysteresis is not None
        return self.is_preview or is_live

    @property
    def is_shown(self) -> bool:
        """Whether there is something to show; a reduced picture is shown only with its AOVs."""
        if not self.renderer or not (self.samples or self.is_upsampled):
            return False
        has_aovs = not self.renderer.settings.aov or self.renderer.shown[1] > 0
        return has_aovs or not self.is_reduced

    @property
    def layering(self) -> Layering:
        """Content of the film's layers; "none" for fragment shaders, or if there is no room."""
        return "none" if self.pipeline == "fragment" or self.lacks_room else self.state.layering

    @property
    def weighed(self) -> Layering:
        """The layering whose weights show an edit; "none" with terms, or light of no group."""
        has_terms = bool({*self.aovs, *self.settings.aov} & {*TERMS})
        is_mixed = self.layering == "groups" and has_ambient(self.settings)
        return "none" if has_terms or is_mixed else self.layering

    @property
    def lacks_room(self) -> bool:
        """Whether the film is too large for layers: then edits of lamps and bounces restart."""
        return not self.room.fits(self.scene, self.settings, self.state.layering)

    @property
    def weights(self) -> Weights:
        """Weights of the film's layers on the screen: as edited, or of one path length alone."""
        assert self.renderer
        plan = self.renderer.plan
        is_alone = self.alone is not None and plan.layering == "lengths" and plan.layers
        return plan.alone(self.alone or 0) if is_alone else plan.weights
