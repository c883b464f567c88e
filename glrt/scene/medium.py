"""Media that fill the space between surfaces: fog, milk, smoke, glowing gas."""

from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from glrt.scene.density import Density
from glrt.scene.values import BLACK, Number, Radiance, Triple, Value
from glrt.settings import Cost, Editable

Coefficient = Annotated[float, Field(ge=0, le=1e15)]
Coefficients = tuple[Coefficient, Coefficient, Coefficient]
Turn = Annotated[float, Field(ge=-0.99, le=0.99)]


class Medium(Value):
    """A medium that scatters, absorbs and emits light, by the radiative transfer equation.

    Lengths are those of the world, whatever the transform of the object that holds it.
    """

    scattering: Annotated[Coefficients, Editable(Cost.RESTART, "per unit", (0, 10))] = Field(
        BLACK, description="share of light that is scattered per unit of length, for each channel"
    )
    absorption: Annotated[Coefficients, Editable(Cost.RESTART, "per unit", (0, 10))] = Field(
        BLACK, description="share of light that is absorbed per unit of length, for each channel"
    )
    anisotropy: Annotated[Turn, Editable(Cost.RESTART, "", (-0.99, 0.99))] = Field(
        0.0,
        description="mean cosine of the angle by which scattered light turns (Henyey-Greenstein): "
        "0 scatters evenly, above 0 forward",
    )
    emission: Annotated[Radiance, Editable(Cost.RECOMPILE)] = Field(
        BLACK,
        description="radiance that it emits per unit of length; it does not depend on `absorption`",
    )
    density: Annotated[Density | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="a grid by which scattering, absorption and emission are multiplied; default: "
        "1 everywhere",
    )

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            scattering: Triple = BLACK,
            absorption: Triple = BLACK,
            anisotropy: Number = 0.0,
            emission: Triple = BLACK,
            density: Density | None = None,
        ) -> None: ...

    @property
    def extinction(self) -> Coefficients:
        """Share of light that is scattered or absorbed per unit of length, for each channel."""
        red, green, blue = (s + a for s, a in zip(self.scattering, self.absorption, strict=True))
        return red, green, blue

    @property
    def emits(self) -> bool:
        """Whether it emits light."""
        return any(self.emission)
