"""Flat disks."""

import math
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from pydantic import Field

from glrt.scene.shapes.base import (
    UP,
    Array,
    LampBody,
    Sided,
    about_axis,
    ring,
    to_planes,
    unsigned,
)
from glrt.scene.shapes.faces import Faces, circle, flat_face
from glrt.scene.shapes.texture_axes import TextureAxes, axes_across
from glrt.scene.values import Direction, Length, Number, Triple, Vector


class Disk(Sided):
    """A flat disk, perpendicular to its normal."""

    shape: Literal["disk"] = Field("disk", description="the kind of shape")
    center: Vector = Field(description="centre, x y z in scene units")
    normal: Direction = Field(description="normal of the disk, of any length above 0")
    radius: Length = Field(description="radius in scene units")

    has_inside = False
    has_coordinates = True
    anchor = "center"
    directions = ("normal",)
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
            medium: str | None = None,
            hidden: bool = False,
            emission_side: Literal["both", "front"] = "both",
        ) -> None: ...

    @property
    def middle(self) -> Vector:
        """Centre of the disk."""
        return self.center

    @property
    def reach(self) -> float:
        """Radius of the disk."""
        return self.radius

    @property
    def row(self) -> list[float]:
        """Centre, normal and radius: 7 numbers."""
        return [*self.center, *self.normal, self.radius]

    @property
    def placement(self) -> Array:
        """Axes and origin, (3, 4): the disk has unit radius there."""
        return about_axis(self.normal, self.center, self.radius, self.radius)

    def outline(self, about: Array) -> Array:
        """Return centre relative to `about`, radius and normal, (1, 7)."""
        place = np.array(self.center) - about
        return np.array([[*place, self.radius, *unsigned(self.normal)]])

    @property
    def polygons(self) -> Array:
        """One polygon in the rim, (1, k, 3)."""
        normal = np.array(self.normal) / np.linalg.norm(self.normal)
        return ring(np.array(self.center), normal, self.radius)[None]

    @property
    def lamp_body(self) -> LampBody:
        """Place and extent as a lamp, with the area of both sides."""
        area, center = 2 * math.pi * self.radius**2, np.array(self.center, np.float64)
        normal = np.array(self.normal, np.float64)
        return LampBody(area, center, self.radius**2 / 2, self.radius, normal)

    @property
    def texture_axes(self) -> TextureAxes:
        """Axes over the square around the disk."""
        u, v = axes_across(self.normal)
        center = np.array(self.center, np.float64)
        corner = center - self.radius * (u + v)
        return TextureAxes(corner, u / (2 * self.radius), v / (2 * self.radius))

    @property
    def faces(self) -> Faces:
        """One face, with many corners."""
        axis = np.array(self.normal) / np.linalg.norm(self.normal)
        return flat_face(circle(np.array(self.center), axis, self.radius)[:, 0])

    @classmethod
    def example(cls, place: Array, size: float) -> dict[str, Any]:
        """Return the fields of a disk that faces up."""
        return {"center": place, "normal": UP, "radius": size}

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Return low and high corners of boxes around the rim, (n, 3) each."""
        normal = rows[:, 3:6] / np.linalg.norm(rows[:, 3:6], axis=1)[:, None]
        reach = rows[:, 6:] * np.sqrt(np.maximum(1 - normal**2, 0))
        return rows[:, :3] - reach, rows[:, :3] + reach

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """Return the distances to disks from either side, (n,); inf for a miss."""
        distance = to_planes(rows[:, :3], rows[:, 3:6], origin, direction)
        offset = origin + distance[:, None] * direction - rows[:, :3]
        return np.where(np.linalg.norm(offset, axis=1) <= rows[:, 6], distance, math.inf)
