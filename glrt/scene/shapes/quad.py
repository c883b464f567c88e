"""Parallelograms."""

import math
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from glrt.scene.shapes.base import (
    Array,
    LampBody,
    Sided,
    to_planes,
)
from glrt.scene.shapes.faces import Faces, flat_face
from glrt.scene.shapes.texture_axes import TextureAxes
from glrt.scene.values import Direction, Triple, Vector, are_parallel


class Quad(Sided):
    """A parallelogram; its normal is along edge_u x edge_v."""

    shape: Literal["quad"] = Field("quad", description="the kind of shape")
    corner: Vector = Field(description="one of its corners, x y z in scene units")
    edge_u: Direction = Field(description="vector from the corner to the next, in scene units")
    edge_v: Direction = Field(
        description="vector from the corner to the one before, in scene units"
    )

    has_inside = False
    has_coordinates = True
    anchor = "corner"
    directions = extents = ("edge_u", "edge_v")

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            corner: Triple,
            edge_u: Triple,
            edge_v: Triple,
            material: str,
            name: str | None = None,
            group: str | None = None,
            medium: str | None = None,
            hidden: bool = False,
            emission_side: Literal["both", "front"] = "both",
        ) -> None: ...

    @model_validator(mode="after")
    def _has_an_area(self) -> Self:
        if are_parallel(self.edge_u, self.edge_v):
            raise ValueError(
                "edge_u and edge_v are parallel: the quad has no area; change one of them"
            )
        return self

    @property
    def middle(self) -> Vector:
        """The point where the diagonals cross."""
        x, y, z = np.array(self.corner) + np.add(self.edge_u, self.edge_v) / 2
        return (float(x), float(y), float(z))

    @property
    def reach(self) -> float:
        """Half of the longer diagonal."""
        diagonals = np.add(self.edge_u, self.edge_v), np.subtract(self.edge_u, self.edge_v)
        return float(max(np.linalg.norm(diagonal) for diagonal in diagonals)) / 2

    @property
    def row(self) -> list[float]:
        """Corner and edges: 9 numbers."""
        return [*self.corner, *self.edge_u, *self.edge_v]

    @property
    def placement(self) -> Array:
        """Axes and origin, (3, 4): both edges, and a normal that grows as they do."""
        across = np.cross(self.edge_u, self.edge_v)
        normal = across / math.sqrt(float(np.linalg.norm(across)))
        return np.column_stack([self.edge_u, self.edge_v, normal, self.middle])

    def outline(self, about: Array) -> Array:
        """Return the corners relative to `about`, (4, 3)."""
        corners: Array = self.polygons[0] - about
        return corners

    @property
    def polygons(self) -> Array:
        """The parallelogram itself, (1, 4, 3)."""
        u, v = np.array(self.edge_u), np.array(self.edge_v)
        corners: Array = np.array(self.corner) + np.array([[0 * u, u, u + v, v]])
        return corners

    @property
    def lamp_body(self) -> LampBody:
        """Place and extent as a lamp, with the area of both sides."""
        u, v = np.array(self.edge_u, np.float64), np.array(self.edge_v, np.float64)
        center, across = np.array(self.corner, np.float64) + (u + v) / 2, np.cross(u, v)
        area, spread2 = 2 * float(np.linalg.norm(across)), float(u @ u + v @ v) / 12
        return LampBody(area, center, spread2, self.reach, across)

    @property
    def texture_axes(self) -> TextureAxes:
        """Axes along the edges from the corner."""
        edge_u, edge_v = np.array(self.edge_u, np.float64), np.array(self.edge_v, np.float64)
        normal = np.cross(edge_u, edge_v)
        area = normal @ normal
        dual_u, dual_v = np.cross(edge_v, normal) / area, np.cross(normal, edge_u) / area
        return TextureAxes(np.array(self.corner, np.float64), dual_u, dual_v)

    @property
    def faces(self) -> Faces:
        """One face."""
        corner, u, v = np.array(self.corner), np.array(self.edge_u), np.array(self.edge_v)
        return flat_face(np.array([corner, corner + u, corner + u + v, corner + v]))

    @classmethod
    def example(cls, place: Array, size: float) -> dict[str, Any]:
        """Return the fields of a square that faces up."""
        along, across = np.array([0.0, 0.0, size]), np.array([size, 0.0, 0.0])
        return {"corner": place - along - across, "edge_u": 2 * along, "edge_v": 2 * across}

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Return low and high corners of boxes around the corners, (n, 3) each."""
        u, v = rows[:, 3:6], rows[:, 6:]
        corners = rows[:, :3] + np.stack([0 * u, u, v, u + v])
        return corners.min(axis=0), corners.max(axis=0)

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """Return the distances to quads from either side, (n,); inf for a miss."""
        corner, u, v = rows[:, :3], rows[:, 3:6], rows[:, 6:]
        normal = np.cross(u, v)
        distance = to_planes(corner, normal, origin, direction)
        offset = origin + distance[:, None] * direction - corner
        square = np.square(normal).sum(axis=1)
        a = (np.cross(offset, v) * normal).sum(axis=1) / square
        b = (np.cross(u, offset) * normal).sum(axis=1) / square
        return np.where((a >= 0) & (a <= 1) & (b >= 0) & (b <= 1), distance, math.inf)
