"""Flat disks."""

import math
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from pydantic import Field

from glrt.scene.shapes.base import (
    UP,
    Array,
    Sided,
    ring,
    to_planes,
    unsigned,
)
from glrt.scene.shapes.faces import Faces, circle, flat_face
from glrt.scene.values import Direction, Length, Number, Triple, Vector


class Disk(Sided):
    """A flat disk about its normal."""

    shape: Literal["disk"] = Field("disk", description="the kind of shape")
    center: Vector = Field(description="centre, x y z in scene units")
    normal: Direction = Field(description="normal of the disk, of any length above 0")
    radius: Length = Field(description="radius in scene units")

    has_inside = False
    anchor = "center"
    extents = ("radius",)

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            center: Triple,
            normal: Triple,
            radius: Number,
            material: str,
            name: str | None = None,
            group: str | None = None,
            hidden: bool = False,
            emission_side: Literal["both", "front"] = "both",
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
        """Centre, normal and radius."""
        return [*self.center, *self.normal, self.radius]

    def outline(self, about: Array) -> Array:
        """Centre, radius and normal."""
        place = np.array(self.center) - about
        return np.array([[*place, self.radius, *unsigned(self.normal)]])

    @property
    def polygons(self) -> Array:
        """One in its rim."""
        normal = np.array(self.normal) / np.linalg.norm(self.normal)
        return ring(np.array(self.center), normal, self.radius)[None]

    @property
    def faces(self) -> Faces:
        """One, with many corners."""
        axis = np.array(self.normal) / np.linalg.norm(self.normal)
        return flat_face(circle(np.array(self.center), axis, self.radius)[:, 0])

    @classmethod
    def example(cls, place: Array, size: float) -> dict[str, Any]:
        """A disk that faces up."""
        return {"center": place, "normal": UP, "radius": size}

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Boxes around the rim."""
        normal = rows[:, 3:6] / np.linalg.norm(rows[:, 3:6], axis=1)[:, None]
        reach = rows[:, 6:] * np.sqrt(np.maximum(1 - normal**2, 0))
        return rows[:, :3] - reach, rows[:, :3] + reach

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """From either side."""
        distance = to_planes(rows[:, :3], rows[:, 3:6], origin, direction)
        offset = origin + distance[:, None] * direction - rows[:, :3]
        return np.where(np.linalg.norm(offset, axis=1) <= rows[:, 6], distance, math.inf)
