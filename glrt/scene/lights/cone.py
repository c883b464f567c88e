"""The cone of directions that a lamp lights."""

import math
from typing import TYPE_CHECKING, Annotated, Self

import numpy as np
from pydantic import Field, model_validator

from glrt.scene.shapes.base import Array
from glrt.scene.values import Direction, Number, Triple, Value
from glrt.settings import Editable

HalfAngle = Annotated[float, Field(ge=0, le=180), Editable(unit="degrees", slider=(0, 90))]


class Cone(Value):
    """The directions that a lamp lights, the same at each of its points; it makes a spotlight.

    With v = 1 - cos of the angle to the axis, the share of the emission is s^2 (3 - 2 s), where s
    falls evenly in v from 1 at `inner` to 0 at `outer`.
    """

    axis: Direction = Field(description="where it points, in the axes of the scene, of any length")
    inner: HalfAngle = Field(0.0, description="half angle from the axis up to which all is emitted")
    outer: HalfAngle = Field(
        45.0, description="half angle beyond which nothing is, not below `inner`"
    )

    if TYPE_CHECKING:

        def __init__(self, *, axis: Triple, inner: Number = 0, outer: Number = 45) -> None: ...

    @model_validator(mode="after")
    def _opens(self) -> Self:
        if self.inner > self.outer:
            raise ValueError("inner is above outer; change one of them")
        if self.outer < NARROWEST:
            raise ValueError(f"outer must be at least {NARROWEST:g} degrees: nothing is lit")
        return self

    @property
    def unit_axis(self) -> Array:
        """The axis with length 1, (3,)."""
        axis: Array = np.array(self.axis) / math.hypot(*self.axis)
        return axis

    @property
    def versines(self) -> tuple[float, float]:
        """1 - cos of the inner and of the outer half angle, with all digits for small angles."""
        return _versine(self.inner), _versine(self.outer)

    def shares(self, directions: Array) -> Array:
        """Return the share of the emission in each direction, (n,), for unit directions, (n, 3)."""
        inner, outer = self.versines
        versines = np.square(directions - self.unit_axis).sum(axis=1) / 2
        if inner == outer:
            return np.where(versines < outer, 1.0, 0.0)
        s: Array = np.clip((outer - versines) / (outer - inner), 0, 1)
        return s * s * (3 - 2 * s)

    @property
    def solid_angle(self) -> float:
        """The integral of the share over all directions, in steradians."""
        return math.pi * sum(self.versines)


NARROWEST = 1e-3  # degrees: below, directions in float32 miss the cone


def _versine(degrees: float) -> float:
    return 2 * math.sin(math.radians(degrees) / 2) ** 2
