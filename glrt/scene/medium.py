"""Media that fill the space between surfaces: fog, milk, smoke, glowing gas."""

from typing import TYPE_CHECKING, Annotated, Self

import numpy as np
from pydantic import Field, model_validator

from glrt.scene.density import Density
from glrt.scene.transfer import Transfer
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
    transfer: Annotated[Transfer | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="colour and opacity by density, for a scientific volume, in place of "
        "scattering, absorption and emission",
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
            transfer: Transfer | None = None,
        ) -> None: ...

    @model_validator(mode="after")
    def _is_of_one_kind(self) -> Self:
        own = ("scattering", "absorption", "anisotropy", "emission")
        given = [name for name in own if np.any(getattr(self, name))]
        if self.transfer and given:
            raise ValueError(
                f"transfer takes the place of {' and '.join(given)}; leave one of them out"
            )
        if self.transfer and self.density is None:
            raise ValueError("transfer needs density, the grid whose values it shows")
        return self

    @property
    def extinction(self) -> Coefficients:
        """Share of light that is scattered or absorbed per unit of length, for each channel."""
        red, green, blue = (s + a for s, a in zip(self.scattering, self.absorption, strict=True))
        return red, green, blue

    @property
    def emits(self) -> bool:
        """Whether it emits light; a transfer function may, whatever its colours."""
        return self.transfer is not None or any(self.emission)

    @property
    def emissions(self) -> tuple[Radiance, ...]:
        """Its emission, or the colours of its transfer function."""
        return self.transfer.colors if self.transfer else (self.emission,)

    def with_emissions(self, emissions: tuple[Radiance, ...]) -> "Medium":
        """Return the medium with other `emissions`, as many."""
        if self.transfer:
            transfer = self.transfer.model_copy(update={"colors": emissions})
            return self.model_copy(update={"transfer": transfer})
        return self.model_copy(update={"emission": emissions[0]})
