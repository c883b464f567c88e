"""Facts about how the materials of a scene scatter light: the lobes that a kernel needs."""

from collections.abc import Mapping
from dataclasses import dataclass

from glrt.scene.materials.kinds import Material, glass_of
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.nothing import Nothing
from glrt.scene.materials.principled import Principled


@dataclass(frozen=True)
class LobeFacts:
    """Facts about materials, by their names."""

    materials: Mapping[str, Material]

    @property
    def conductors(self) -> list[str]:
        """Names of the metals whose reflectance depends on the angle."""
        return [n for n, it in self.materials.items() if isinstance(it, Metal) and it.conductor]

    @property
    def coated(self) -> list[str]:
        """Names of the principled materials with a clear coat."""
        return [name for name, it in self._principled.items() if it.clearcoat > 0]

    @property
    def anisotropic(self) -> list[str]:
        """Names of the metals and principled materials that are rougher in one direction."""
        found = self.materials.items()
        return [n for n, it in found if isinstance(it, Metal | Principled) and it.anisotropy > 0]

    @property
    def iridescent(self) -> list[str]:
        """Names of the principled materials under a thin film."""
        return [name for name, it in self._principled.items() if it.film]

    @property
    def sheened(self) -> list[str]:
        """Names of the principled materials with sheen."""
        return [name for name, it in self._principled.items() if any(it.sheen)]

    @property
    def translucent(self) -> list[str]:
        """Names of the principled materials whose matte base lets light through."""
        return [name for name, it in self._principled.items() if it.diffuse_transmission > 0]

    @property
    def transmitting(self) -> list[str]:
        """Names of the principled materials that are partly glass."""
        return [name for name, it in self._principled.items() if it.glass]

    @property
    def dispersing(self) -> list[str]:
        """Names of the materials of glass that refracts each color by an index of its own."""
        found = ((name, glass_of(it)) for name, it in self.materials.items())
        return [name for name, glass in found if glass and glass.spread > 0]

    @property
    def holed(self) -> list[str]:
        """Names of the principled materials with holes: an alpha below 1 or from a texture."""
        return [name for name, it in self._principled.items() if it.has_holes]

    @property
    def passed(self) -> list[str]:
        """Names of the materials that light may pass straight: with holes, or no surface."""
        own = self.materials.items()
        return [*self.holed, *(name for name, it in own if isinstance(it, Nothing))]

    @property
    def _principled(self) -> dict[str, Principled]:
        return {n: it for n, it in self.materials.items() if isinstance(it, Principled)}
