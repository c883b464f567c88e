"""What the window edits, as one value."""

from dataclasses import dataclass, replace
from typing import Any

from glrt.plan.plan import Layering
from glrt.scene.scene import Scene
from glrt.settings import Aov, Settings, settings_for


@dataclass(frozen=True)
class State:
    """What is edited, and what undo brings back."""

    scene: Scene
    settings: Settings
    by_length: bool = False  # layers by the length of paths, so that bounces are weighed

    @property
    def layering(self) -> Layering:
        """What the layers of the film are to hold, if it keeps any."""
        return "lengths" if self.by_length else "groups"

    def moves(self, before: Scene) -> bool:
        """Whether the scene differs from another one in what lies where."""
        return (self.scene.camera, self.scene.objects) != (before.camera, before.objects)

    def showing(self, *aovs: Aov) -> "State":
        """With AOVs beside those of the settings."""
        settings = settings_for(self.settings, aov=(*self.settings.aov, *aovs))
        return replace(self, settings=settings)

    def sized(self, width: int, height: int) -> "State":
        """At another size."""
        size: dict[str, Any] = {"width": width, "height": height}
        return replace(self, settings=settings_for(self.settings, **size))

    def coarser(self, factor: float) -> "State":
        """With so many pixels, in width and height, as one."""
        width, height = (max(1, round(side / factor)) for side in self.settings.size)
        return self.sized(width, height) if factor > 1 else self
