"""The interface of a temporal mode, which makes a picture from a film and earlier views."""

from typing import NamedTuple, Protocol

import moderngl

from glrt.rendering.history.gbuffer import Surfaces
from glrt.rendering.renderer import Renderer


class Fresh(NamedTuple):
    """The film of the current view, as a temporal mode reads it."""

    light: moderngl.Texture  # RGB radiance under the weights that are shown
    mean: moderngl.Texture  # a: finite samples of each pixel
    samples: int
    end: float  # samples from which on the film is shown alone
    source: Renderer | None = None  # traces more samples under the same weights; None: it cannot


class Resolver(Protocol):
    """A temporal mode. Textures are RGBA32F of the size of the view, row 0 on top."""

    def arrive(self, now: Surfaces, before: Surfaces | None, is_same_light: bool) -> None:
        """Begin a view; `before` is None if nothing of the previous view can be used."""

    def show(self, now: Surfaces, fresh: Fresh) -> moderngl.Texture:
        """The picture, radiance in RGB; valid until the next call."""

    def release(self) -> None:
        """Release all OpenGL resources."""
