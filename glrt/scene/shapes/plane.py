"""Infinite planes."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from pydantic import Field

from glrt.scene.shapes.base import (
    UP,
    Array,
    Cornerless,
    about_axis,
    to_planes,
    unsigned,
)
from glrt.scene.shapes.faces import STEPS, Faces, circle, flat_face
from glrt.scene.shapes.flat_faces import FlatFace
from glrt.scene.shapes.texture_axes import TextureAxes, axes_across
from glrt.scene.values import Direction, Triple, Vector


class Plane(Cornerless):
    """An infinite plane; the inside of a dielectric is the half-space behind the normal."""

    shape: Literal["plane"] = Field("plane", description="the kind of shape")
    point: Vector = Field(description="any point on the plane, x y z in scene units")
    normal: Direction = Field(description="normal of the plane, of any length above 0")

    has_inside = True
    has_coordinates = True
    anchor = "point"
    directions = ("normal",)
    extents = ()

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            point: Triple,
            normal: Triple,
            material: str,
            name: str | None = None,
            group: str | None = None,
            medium: str | None = None,
            hidden: bool = False,
        ) -> None: ...

    @property
    def middle(self) -> Vector:
        """The point by which the plane is given."""
        return self.point

    @property
    def reach(self) -> float:
        """Infinite: no ball holds a plane."""
        return math.inf

    @property
    def row(self) -> list[float]:
        """Point and normal: 6 numbers."""
        return [*self.point, *self.normal]

    @property
    def placement(self) -> Array:
        """Axes and origin, (3, 4), at its point, without a scale."""
        return about_axis(self.normal, self.point)

    def outline(self, about: Array) -> Array:
        """Return the normal and the height over `about`, (1, 4)."""
        normal = unsigned(self.normal)
        return np.array([[*normal, normal @ (np.array(self.point) - about)]])

    @property
    def texture_axes(self) -> TextureAxes:
        """Axes in scene units from the point."""
        return TextureAxes(np.array(self.point, np.float64), *axes_across(self.normal))

    @property
    def flat_faces(self) -> Sequence[FlatFace]:
        """The plane itself."""
        normal = np.array(self.normal) / np.linalg.norm(self.normal)
        return [FlatFace(np.array(self.point), np.zeros(3), np.zeros(3), normal, False)]

    def holds(self, point: Array) -> bool:
        """Return whether a point, (3,), lies behind the plane."""
        return bool((point - np.array(self.point)) @ np.asarray(self.normal) < 0)

    @property
    def faces(self) -> Faces:
        """A square about its point, with edges of length 1: a plane has no end."""
        axis = np.array(self.normal) / np.linalg.norm(self.normal)
        ring = circle(np.array(self.point), axis, math.sqrt(0.5))
        return flat_face(ring[:: STEPS // 4, 0])

    @classmethod
    def example(cls, place: Array, size: float) -> dict[str, Any]:
        """Return the fields of a floor below the place."""
        return {"point": place - size * UP, "normal": UP}

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Return infinite boxes, (n, 3) each corner."""
        endless = np.full((len(rows), 3), math.inf)
        return -endless, endless

    @classmethod
    def gaps(cls, rows: Array, point: Array) -> Array:
        """Return distances from a point, (3,), to n planes, (n,)."""
        away = ((point - rows[:, :3]) * rows[:, 3:]).sum(axis=1)
        return np.asarray(np.abs(away) / np.linalg.norm(rows[:, 3:], axis=1))

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """Return the distances to planes from either side, (n,); inf for a miss."""
        return to_planes(rows[:, :3], rows[:, 3:], origin, direction)
