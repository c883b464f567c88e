"""Spheres."""

import math
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from pydantic import Field

from glrt.scene.shapes.base import (
    Array,
    Cornerless,
    along_and_rest,
)
from glrt.scene.values import Length, Number, Triple, Vector


class Sphere(Cornerless):
    """A sphere."""

    shape: Literal["sphere"] = Field("sphere", description="the kind of shape")
    center: Vector = Field(description="centre, x y z in scene units")
    radius: Length = Field(description="radius in scene units")

    has_inside = True
    anchor = "center"
    extents = ("radius",)

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            center: Triple,
            radius: Number,
            material: str,
            name: str | None = None,
            group: str | None = None,
            hidden: bool = False,
        ) -> None: ...

    @property
    def middle(self) -> Vector:
        """Its centre."""
        return self.center

    @property
    def reach(self) -> float:
        """Its radius."""
        return self.radius

    @property
    def row(self) -> list[float]:
        """Centre and radius."""
        return [*self.center, self.radius]

    def outline(self, about: Array) -> Array:
        """Centre and radius."""
        return np.array([[*(np.array(self.center) - about), self.radius]])

    @property
    def faces(self) -> None:
        """It is a ball."""
        return None

    @classmethod
    def example(cls, place: Array, size: float) -> dict[str, Any]:
        """A ball of that radius."""
        return {"center": place, "radius": size}

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Boxes around the ball."""
        return rows[:, :3] - rows[:, 3:], rows[:, :3] + rows[:, 3:]

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """To the near side; from inside to the far side."""
        along, rest = along_and_rest(rows, origin, direction)
        near, far = along - rest, along + rest
        return np.where(near > 0, near, np.where(far > 0, far, math.inf))
