"""Shapes: a frozen model for each kind, with its geometry for the host.

What the kernel knows of a shape stands in shaders_glsl/shapes/ and glrt/rendering/pack_shapes.py.
docs/extending.md says how a kind is added.
"""

import math
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, get_args

import numpy as np
from pydantic import Field, model_validator

from glrt.scene.cylinder import Cylinder
from glrt.scene.meshes import Mesh
from glrt.scene.objects import (
    Array,
    Cornerless,
    Sided,
    along_and_rest,
    ring,
    to_planes,
    unsigned,
)
from glrt.scene.solids import Box
from glrt.scene.values import Direction, Length, Number, Triple, Vector, are_parallel


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

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Of its ends along the axes."""
        return rows[:, :3] - rows[:, 3:], rows[:, :3] + rows[:, 3:]

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """To the near side; from inside to the far side."""
        along, rest = along_and_rest(rows, origin, direction)
        near, far = along - rest, along + rest
        return np.where(near > 0, near, np.where(far > 0, far, math.inf))


class Plane(Cornerless):
    """An infinite plane; the inside of a dielectric is the half-space behind the normal."""

    shape: Literal["plane"] = Field("plane", description="the kind of shape")
    point: Vector = Field(description="any point on the plane, x y z in scene units")
    normal: Direction = Field(description="normal of the plane, of any length above 0")

    has_inside = True
    anchor = "point"
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
            hidden: bool = False,
        ) -> None: ...

    @property
    def middle(self) -> Vector:
        """The point that it is given by."""
        return self.point

    @property
    def reach(self) -> float:
        """No ball holds a plane."""
        return math.inf

    @property
    def row(self) -> list[float]:
        """Point and normal."""
        return [*self.point, *self.normal]

    def outline(self, about: Array) -> Array:
        """Normal and height."""
        normal = unsigned(self.normal)
        return np.array([[*normal, normal @ (np.array(self.point) - about)]])

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Infinite."""
        endless = np.full((len(rows), 3), math.inf)
        return -endless, endless

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """From either side."""
        return to_planes(rows[:, :3], rows[:, 3:], origin, direction)


class Quad(Sided):
    """A parallelogram; its normal is along edge_u x edge_v."""

    shape: Literal["quad"] = Field("quad", description="the kind of shape")
    corner: Vector = Field(description="one of its corners, x y z in scene units")
    edge_u: Direction = Field(description="vector from the corner to the next, in scene units")
    edge_v: Direction = Field(
        description="vector from the corner to the one before, in scene units"
    )

    has_inside = False
    anchor = "corner"
    extents = ("edge_u", "edge_v")

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
        """Where its diagonals cross."""
        x, y, z = np.array(self.corner) + np.add(self.edge_u, self.edge_v) / 2
        return (float(x), float(y), float(z))

    @property
    def reach(self) -> float:
        """Half of the longer diagonal."""
        diagonals = np.add(self.edge_u, self.edge_v), np.subtract(self.edge_u, self.edge_v)
        return float(max(np.linalg.norm(diagonal) for diagonal in diagonals)) / 2

    @property
    def row(self) -> list[float]:
        """Corner and edges."""
        return [*self.corner, *self.edge_u, *self.edge_v]

    def outline(self, about: Array) -> Array:
        """Its corners."""
        corners: Array = self.polygons[0] - about
        return corners

    @property
    def polygons(self) -> Array:
        """Itself."""
        u, v = np.array(self.edge_u), np.array(self.edge_v)
        corners: Array = np.array(self.corner) + np.array([[0 * u, u, u + v, v]])
        return corners

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Of its corners."""
        u, v = rows[:, 3:6], rows[:, 6:]
        corners = rows[:, :3] + np.stack([0 * u, u, v, u + v])
        return corners.min(axis=0), corners.max(axis=0)

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """From either side."""
        corner, u, v = rows[:, :3], rows[:, 3:6], rows[:, 6:]
        normal = np.cross(u, v)
        distance = to_planes(corner, normal, origin, direction)
        offset = origin + distance[:, None] * direction - corner
        square = np.square(normal).sum(axis=1)
        a = (np.cross(offset, v) * normal).sum(axis=1) / square
        b = (np.cross(u, offset) * normal).sum(axis=1) / square
        return np.where((a >= 0) & (a <= 1) & (b >= 0) & (b <= 1), distance, math.inf)


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

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Of its rim."""
        normal = rows[:, 3:6] / np.linalg.norm(rows[:, 3:6], axis=1)[:, None]
        reach = rows[:, 6:] * np.sqrt(np.maximum(1 - normal**2, 0))
        return rows[:, :3] - reach, rows[:, :3] + reach

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """From either side."""
        distance = to_planes(rows[:, :3], rows[:, 3:6], origin, direction)
        offset = origin + distance[:, None] * direction - rows[:, :3]
        return np.where(np.linalg.norm(offset, axis=1) <= rows[:, 6], distance, math.inf)


Shape = Annotated[
    Sphere | Plane | Quad | Disk | Box | Cylinder | Mesh, Field(discriminator="shape")
]

KINDS: dict[str, Any] = {  # the model of each kind, in the order of the kernel's numbering
    kind.model_fields["shape"].default: kind for kind in get_args(get_args(Shape)[0])
}
