"""What there is to see: a frozen model for each kind of shape."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from glrt.scene.values import Direction, Length, Name, Tagged, Vector, are_parallel


class _Object(Tagged):
    name: Name | None = Field(None, description="what to call the object in messages, one line")
    material: Name = Field(description="name of one of the materials")


class Sphere(_Object):
    """A sphere."""

    shape: Literal["sphere"] = Field("sphere", description="the kind of shape")
    center: Vector = Field(description="its middle, x y z in scene units")
    radius: Length = Field(description="its radius in scene units, above 0")


class Plane(_Object):
    """An infinite plane; of a dielectric, the half-space behind the normal is inside."""

    shape: Literal["plane"] = Field("plane", description="the kind of shape")
    point: Vector = Field(description="any point on it, x y z in scene units")
    normal: Direction = Field(description="a direction across it, of any length but zero")


class Quad(_Object):
    """A parallelogram whose normal lies along edge_u x edge_v."""

    shape: Literal["quad"] = Field("quad", description="the kind of shape")
    corner: Vector = Field(description="one of its corners, x y z in scene units")
    edge_u: Direction = Field(description="from the corner to its neighbour, in scene units")
    edge_v: Direction = Field(description="from the corner to the other neighbour, in scene units")

    @model_validator(mode="after")
    def _has_an_area(self) -> Self:
        if are_parallel(self.edge_u, self.edge_v):
            raise ValueError("edge_u and edge_v are parallel, so the quad is flat; turn one")
        return self


Shape = Annotated[Sphere | Plane | Quad, Field(discriminator="shape")]
