"""Spheres."""

import math
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from pydantic import Field

from glrt.scene.shapes.base import (
    Array,
    Cornerless,
    LampBody,
    along_and_rest,
)
from glrt.scene.values import Length, Number, Triple, Vector


class Sphere(Cornerless):
    """A sphere."""

    shape: Literal["sphere"] = Field("sphere", description="the kind of shape")
    center: Vector = Field(description="centre, x y z in scene units")
    radius: Length = Field(description="radius in scene units")

    has_inside = True
    has_coordinates = True
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
            medium: str | None = None,
            hidden: bool = False,
        ) -> None: ...

    @property
    def middle(self) -> Vector:
        """Centre of the sphere."""
        return self.center

    @property
    def reach(self) -> float:
        """Radius of the sphere."""
        return self.radius

    @property
    def row(self) -> list[float]:
        """Centre and radius: 4 numbers."""
        return [*self.center, self.radius]

    def outline(self, about: Array) -> Array:
        """Return centre relative to `about`, and radius, (1, 4)."""
        return np.array([[*(np.array(self.center) - about), self.radius]])

    @property
    def lamp_body(self) -> LampBody:
        """Place and extent as a lamp, which emits outwards."""
        area, center = 4 * math.pi * self.radius**2, np.array(self.center, np.float64)
        return LampBody(area, center, self.radius**2, self.radius, np.zeros(3))

    @property
    def faces(self) -> None:
        """None: a sphere has no flat faces."""
        return None

    @classmethod
    def example(cls, place: Array, size: float) -> dict[str, Any]:
        """Return the fields of a sphere with radius `size`."""
        return {"center": place, "radius": size}

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Return low and high corners of boxes around the spheres, (n, 3) each."""
        return rows[:, :3] - rows[:, 3:], rows[:, :3] + rows[:, 3:]

    @classmethod
    def gaps(cls, rows: Array, point: Array) -> Array:
        """Return distances from a point, (3,), to n spheres, (n,); negative inside."""
        return np.asarray(np.linalg.norm(point - rows[:, :3], axis=1) - rows[:, 3])

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """Return the distances to the near side, or from inside to the far side, (n,)."""
        along, rest = along_and_rest(rows, origin, direction)
        near, far = along - rest, along + rest
        return np.where(near > 0, near, np.where(far > 0, far, math.inf))
