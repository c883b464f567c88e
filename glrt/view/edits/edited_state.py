"""The scene and settings that the window edits, as one immutable value."""

from dataclasses import dataclass, replace
from typing import Any

from glrt.plan.plan import Layering
from glrt.scene.scene import Scene
from glrt.settings import Aov, RenderSettings, Settings, settings_for


@dataclass(frozen=True)
class State:
    """The edited scene and settings; undo restores an earlier state."""

    scene: Scene
    settings: Settings
    by_length: bool = False  # whether layers hold path lengths, so that bounces are weighted
    locked: frozenset[int] = frozenset()  # numbers of the objects that no edit changes

    @property
    def layering(self) -> Layering:
        """Content of the film's layers, if it has any: path lengths or light groups."""
        return "lengths" if self.by_length else "groups"

    def moves(self, before: Scene) -> bool:
        """Whether the camera or the objects differ from those of another scene."""
        return (self.scene.camera, self.scene.objects) != (before.camera, before.objects)

    def showing(self, *aovs: Aov) -> "State":
        """Return the state with more AOVs than those of its settings."""
        settings = settings_for(self.settings, aov=(*self.settings.aov, *aovs))
        return replace(self, settings=settings)

    def sized(self, width: int, height: int) -> "State":
        """Return the state with another size of the picture, in pixels."""
        size: dict[str, Any] = {"width": width, "height": height}
        return replace(self, settings=settings_for(self.settings, **size))

    def coarser(self, factor: float) -> "State":
        """Return the state with width and height divided by `factor`; unchanged up to 1."""
        width, height = (max(1, round(side / factor)) for side in self.settings.size)
        return self.sized(width, height) if factor > 1 else self


def plain(settings: RenderSettings) -> Settings:
    """Return the settings of a file as the window opens it: a whole picture, as it is rendered.

    Its film shows the samples of each pixel alone, so pixels do not share random numbers.
    """
    alone = {"sampler": "sobol"} if getattr(settings, "sampler", "") == "shared" else {}
    return settings_for(settings, crop=None, denoise="none", adaptive="off", **alone)
