"""Whether a driver has room for the layers of a film, which are side by side in one texture."""

from glrt.plan.methods import traits_of
from glrt.plan.plan import Layering, prepare
from glrt.scene.scene import Scene
from glrt.settings import Settings


class LayerLimits:
    """Sizes of films with layers that fit: below the largest texture, and any refused size."""

    def __init__(self, largest: int) -> None:
        """`largest` is the largest width and height of a texture, in pixels."""
        self.largest = largest
        self._refused = float("inf")  # pixels of all layers
        self._known: tuple[Scene, Settings, Layering, int] | None = None

    def fits(self, scene: Scene, settings: Settings, layering: Layering) -> bool:
        """Whether a film with this layering is possible; one without layers always is.

        Probes hold the light of all lamps together, so a method that uses them cannot separate it.
        """
        layers = self.layers(scene, settings, layering)
        is_narrow = layers * settings.width <= self.largest and 2 * settings.height <= self.largest
        is_small = layers * settings.width * settings.height < self._refused
        is_apart = layering == "none" or not traits_of(settings).has_probes
        return is_apart and (not layers or (is_narrow and is_small))

    def refuse(self, scene: Scene, settings: Settings, layering: Layering) -> bool:
        """Remember that the driver refused a film; returns whether one without layers may fit."""
        layers = self.layers(scene, settings, layering)
        if layers:
            self._refused = layers * settings.width * settings.height
        return layers > 0

    def layers(self, scene: Scene, settings: Settings, layering: Layering) -> int:
        """Return the number of layers; the last is cached, as a frame asks for it several times."""
        known = self._known
        if not (known and known[0] is scene and known[1] is settings and known[2] == layering):
            count = prepare(scene, settings, layering).layers
            known = self._known = (scene, settings, layering, count)
        return known[3]
