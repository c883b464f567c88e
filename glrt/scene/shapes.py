"""Shapes: a frozen model for each kind."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from glrt.scene.values import Direction, Length, Name, Tagged, Vector, are_parallel


class _Object(Tagged):
    name: Name | None = Field(None, description="name of the object in messages and the window")
    material: Name = Field(description="name of one of the materials")


class Sphere(_Object):
    """A sphere."""

    shape: Literal["sphere"] = Field("sphere", description="the kind of shape")
    center: Vector = Field(description="centre, x y z in scene units")
    radius: Length = Field(description="radius in scene units")


class Plane(_Object):
    """An infinite plane; the inside of a dielectric is the half-space behind the normal."""

    shape: Literal["plane"] = Field("plane", description="the kind of shape")
    point: Vector = Field(description="any point on the plane, x y z in scene units")
    normal: Direction = Field(description="normal of the plane, of any length above 0")


class Quad(_Object):
    """A parallelogram; its normal is along edge_u x edge_v."""

    shape: Literal["quad"] = Field("quad", description="the kind of shape")
    corner: Vector = Field(description="one of its corners, x y z in scene units")
    edge_u: Direction = Field(description="vector from the corner to the next, in scene units")
    edge_v: Direction = Field(
        description="vector from the corner to the one before, in scene units"
    )

    @model_validator(mode="after")
    def _has_an_area(self) -> Self:
        if are_parallel(self.edge_u, self.edge_v):
            raise ValueError(
                "edge_u and edge_v are parallel: the quad has no area; change one of them"
            )
        return self


Shape = Annotated[Sphere | Plane | Quad, Field(discriminator="shape")]
