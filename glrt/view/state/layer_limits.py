"""Whether a driver has room for the layers of a film, which lie side by side in one texture."""

from glrt.plan.methods import METHODS
from glrt.plan.plan import Layering, prepare
from glrt.scene.scene import Scene
from glrt.settings import Settings


class LayerLimits:
    """What fits; a size that the driver has refused does not."""

    def __init__(self, largest: int) -> None:
        """`largest` is the width and the height that a texture can have, in pixels."""
        self.largest = largest
        self._refused = float("inf")  # pixels of all layers
        self._known: tuple[Scene, Settings, Layering, int] | None = None

    def fits(self, scene: Scene, settings: Settings, layering: Layering) -> bool:
        """Whether a film of these layers can be had; one without layers always fits here.

        Probes hold the light of all lamps in one: a method that has them cannot tell it apart.
        """
        layers = self.layers(scene, settings, layering)
        is_narrow = layers * settings.width <= self.largest and 2 * settings.height <= self.largest
        is_small = layers * settings.width * settings.height < self._refused
        is_apart = layering == "none" or not METHODS[settings.method].has_probes
        return is_apart and (not layers or (is_narrow and is_small))

    def refuse(self, scene: Scene, settings: Settings, layering: Layering) -> bool:
        """The driver would not; returns whether a film without layers is worth a trial."""
        layers = self.layers(scene, settings, layering)
        if layers:
            self._refused = layers * settings.width * settings.height
        return layers > 0

    def layers(self, scene: Scene, settings: Settings, layering: Layering) -> int:
        """How many; kept, since a frame asks several times, and a scene may have many objects."""
        known = self._known
        if not (known and known[0] is scene and known[1] is settings and known[2] == layering):
            count = prepare(scene, settings, layering).layers
            known = self._known = (scene, settings, layering, count)
        return known[3]
