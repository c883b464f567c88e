"""What makes a picture of a film and of the views before: a mode of `temporal`."""

from typing import NamedTuple, Protocol

import moderngl

from glrt.rendering.history.gbuffer import Surfaces
from glrt.rendering.renderer import Renderer


class Fresh(NamedTuple):
    """The film of this view."""

    light: moderngl.Texture  # RGB radiance under the weights that are shown
    mean: moderngl.Texture  # a: finite samples of each pixel
    samples: int
    end: float  # samples from which on it is shown alone
    source: Renderer | None = None  # of more samples under the same weights; None: there are none


class Resolver(Protocol):
    """A temporal mode: textures are RGBA32F of the size of the view, row 0 on top."""

    def arrive(self, now: Surfaces, before: Surfaces | None, is_same_light: bool) -> None:
        """Begin a view; `before` is None if nothing of the view before can be used."""

    def show(self, now: Surfaces, fresh: Fresh) -> moderngl.Texture:
        """The picture, radiance in RGB; valid until the next call."""

    def release(self) -> None:
        """Free what the driver holds."""
