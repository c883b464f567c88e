"""Transfer functions: what a density of a scientific volume looks like."""

from typing import TYPE_CHECKING, Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from glrt.scene.values import Coordinate, Length, Number, Radiance, Triple, Value
from glrt.settings import Cost, Editable

MOST_KNOTS = 32  # of a function: a ray looks at each where it looks at the grid
MOST_OPACITY = 1 - 2**-24  # in float32: the largest below 1

Opacity = Annotated[float, Field(ge=0, lt=1)]
Knots = Field(min_length=1, max_length=MOST_KNOTS)
Floats = NDArray[np.float64]


class Transfer(Value):
    """A function from density to colour and opacity, for direct volume rendering.

    It is piecewise linear between its knots, and even beyond them. Two knots of one value are a
    step: the second is that of the value. A place of opacity o has the extinction -ln(1 - o) over
    `length`, and emits its colour times that. It scatters no light.
    """

    values: Annotated[tuple[Coordinate, ...], Knots] = Field(
        description="densities of the knots, none below the one before"
    )
    colors: Annotated[tuple[Radiance, ...], Knots] = Field(
        description="radiance of what is opaque, for each knot"
    )
    opacities: Annotated[tuple[Opacity, ...], Knots] = Field(
        description="share of light that is lost over `length`, for each knot, below 1"
    )
    length: Annotated[Length, Editable(Cost.RESTART, "", (0.01, 10))] = Field(
        description="length over which `opacities` hold, in scene units"
    )

    if TYPE_CHECKING:

        def __init__(
            self, *, values: Triple, colors: Any, opacities: Triple, length: Number
        ) -> None: ...

    @model_validator(mode="after")
    def _has_knots(self) -> Self:
        counts = [len(self.values), len(self.colors), len(self.opacities)]
        if len(set(counts)) > 1:
            raise ValueError(
                "has {} values, {} colors and {} opacities; give one of each for a knot".format(
                    *counts
                )
            )
        if any(after < before for before, after in zip(self.values, self.values[1:], strict=False)):
            raise ValueError("values must not fall from knot to knot; sort the knots by value")
        return self

    def extinction(self, low: Floats, high: Floats) -> Floats:
        """Return the largest extinction at densities from `low` to `high`, per unit of length."""
        found = np.maximum(*(np.interp(it, self.values, self.opacities) for it in (low, high)))
        for value, opacity in zip(self.values, self.opacities, strict=True):
            is_within = (low <= value) & (value <= high)
            found = np.where(is_within, np.maximum(found, opacity), found)
        extinction: Floats = -np.log1p(-np.minimum(found, MOST_OPACITY)) / self.length
        return extinction
