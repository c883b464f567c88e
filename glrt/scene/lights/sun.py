"""The sun: a disc at infinity."""

import math
from typing import TYPE_CHECKING, Annotated, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from glrt.scene.values import Direction, Number, Radiance, Triple, Value
from glrt.settings import Cost, Editable


class Sun(Value):
    """A disc at infinity, equally bright at all its points; its light group is `sun`.

    Its place is given by `elevation` and `azimuth`, or by `direction`.
    """

    elevation: Annotated[
        float | None, Field(ge=-90, le=90), Editable(Cost.RESTART, "degrees", (-90, 90))
    ] = Field(None, description="angle above the horizon in degrees")
    azimuth: Annotated[
        float | None, Field(ge=-360, le=360), Editable(Cost.RESTART, "degrees", (-180, 180))
    ] = Field(None, description="angle from -z towards +x in degrees; default: 0")
    direction: Annotated[Direction | None, Editable(Cost.RESTART)] = Field(
        None, description="from the scene towards the sun, of any length above 0"
    )
    angle: Annotated[float, Field(ge=1e-3, le=90), Editable(Cost.RESTART, "degrees", (0.1, 20))] = (
        Field(0.53, description="diameter of the disc in degrees")
    )
    irradiance: Annotated[Radiance | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="what a surface receives that faces it, 0 or more each; default with a clear "
        "sky: what its model says; without one it is required",
    )

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            elevation: Number | None = None,
            azimuth: Number | None = None,
            direction: Triple | None = None,
            angle: Number = 0.53,
            irradiance: Triple | None = None,
        ) -> None: ...

    @model_validator(mode="after")
    def _stands_in_one_place(self) -> Self:
        if (self.direction is None) == (self.elevation is None):
            raise ValueError("must stand in one place: give elevation and azimuth, or direction")
        if self.azimuth is not None and self.direction is not None:
            raise ValueError("direction excludes azimuth; give direction alone, or elevation too")
        return self

    @property
    def towards(self) -> NDArray[np.float64]:
        """The unit vector to the middle of the sun, (3,)."""
        if self.direction is not None:
            given = np.array(self.direction, np.float64)
            unit: NDArray[np.float64] = given / np.linalg.norm(given)
            return unit
        high, around = math.radians(self.elevation or 0.0), math.radians(self.azimuth or 0.0)
        flat = math.cos(high)
        return np.array([flat * math.sin(around), math.sin(high), -flat * math.cos(around)])

    @property
    def versine(self) -> float:
        """1 - cos of half the angle of the disc."""
        return 2 * math.sin(math.radians(self.angle) / 4) ** 2

    def radiance(self, irradiance: Radiance) -> Radiance:
        """Return the radiance of its points: the irradiance over pi sin^2 of half its angle."""
        area = math.pi * math.sin(math.radians(self.angle) / 2) ** 2
        red, green, blue = irradiance
        return (red / area, green / area, blue / area)
