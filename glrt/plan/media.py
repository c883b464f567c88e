"""Facts about the media of a scene: which are used, and where each begins."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from glrt.scene.scene import Scene
from glrt.scene.volumes import Bounds, bounds_of, medium_around


@dataclass(frozen=True)
class MediaFacts:
    """Facts about the media of a scene, derived when they are first used."""

    scene: Scene

    @cached_property
    def names(self) -> list[str]:
        """Names of the media that fill an object, or all of space; their rows in the kernel."""
        return self.scene.media_in_use

    @cached_property
    def grids(self) -> list[str]:
        """Names of the media whose density varies; the rows of their grids in the kernel."""
        return [name for name in self.names if self.scene.media[name].density is not None]

    @cached_property
    def transfers(self) -> list[str]:
        """Names of the media with a transfer function."""
        return [name for name in self.names if self.scene.media[name].transfer is not None]

    @cached_property
    def bounds(self) -> tuple[Bounds, ...]:
        """The bounds of all volumes, in a scene that uses media."""
        shown = set(self.scene.shown)
        return tuple(it for it in bounds_of(self.scene) if it.number in shown and self.names)

    @cached_property
    def around_camera(self) -> str | None:
        """Name of the medium around the camera; None for vacuum."""
        return medium_around(self.scene, np.array(self.scene.camera.position, np.float64))
