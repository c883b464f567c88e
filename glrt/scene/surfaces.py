"""What all materials have, and those that light does not pass."""

from typing import Annotated, ClassVar

from pydantic import Field

from glrt.scene.cone import Cone
from glrt.scene.values import BLACK, Color, Name, Radiance, Tagged
from glrt.settings import Cost, Editable

# Alpha of GGX: a narrower lobe is finer than the rounding of a float32 direction, 6e-8.
SMOOTHEST = 1e-8

RADIANCE = "radiance at intensity 1, 0 or more each, from both sides of the surface"


class Surface(Tagged):
    """What every material has."""

    type: str = Field(description="the kind of material")

    is_transparent: ClassVar[bool]  # nothing is seen of it but by following light through it

    @property
    def emits(self) -> bool:
        """Whether an object of this material is a lamp."""
        return False


class Opaque(Surface):
    """What every material has that light does not pass."""

    color: Color | None = Field(description="share of light that is reflected")
    emission: Annotated[Radiance, Editable(Cost.RECOMPILE)] = Field(
        BLACK, description=f"{RADIANCE}; black: it is no lamp"
    )
    group: Name | None = Field(
        None,
        description="light group whose intensity its emission follows; default: the name of the "
        "material",
    )
    cone: Annotated[Cone | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="directions that its emission lights, `{ axis, inner, outer }`; default: all",
    )

    is_transparent = False

    @property
    def emits(self) -> bool:
        """Whether some of its emission is not black."""
        return any(self.emission)


def alpha_of(roughness: float) -> float:
    """The alpha of GGX; 0 for what a float32 cannot tell from a mirror."""
    alpha = roughness**2
    return alpha if alpha >= SMOOTHEST else 0.0
