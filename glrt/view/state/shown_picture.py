"""The kind of picture that a session has: whole, coarse, or temporary."""

from glrt.rendering.renderer import Renderer
from glrt.view.edits.editing import Editing
from glrt.view.state.moving_picture import MovingPicture


class ShownPicture(Editing):
    """Properties of the picture of a session."""

    renderer: Renderer | None
    moving: MovingPicture

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
