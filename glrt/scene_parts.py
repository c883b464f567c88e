"""The parts of a scene as frozen values: camera, background, materials, shapes.

Lengths in scene units, angles in degrees, colours in linear sRGB, right-handed, y up.
"""

import math
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, ConfigDict, Field, model_validator

from glrt.settings import Cost, Frozen

# The squares of lengths and radiances must be normal float32 numbers, which end at 1e-38 and 3e38.
SMALLEST = 1e-15
LARGEST = 1e15

# Sine of an angle: below it the cross product of two float32 vectors is mostly rounding error.
PARALLEL_SINE = 1e-6

# Alpha of GGX: a narrower lobe is finer than the rounding of a float32 direction, 6e-8.
SMOOTHEST = 1e-8


def _length(vector: "Vector") -> float:
    return math.hypot(*vector)


def _are_parallel(a: "Vector", b: "Vector") -> bool:
    cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return _length(cross) <= PARALLEL_SINE * _length(a) * _length(b)


def _with_a_length(vector: "Vector") -> "Vector":
    if _length(vector) < SMALLEST:
        raise ValueError(f"must not be zero: its length must be at least {SMALLEST:g}")
    return vector


def _require_tag(schema: dict[str, Any]) -> None:
    """The tag has a default for Python alone; a file must name it."""
    tags = [key for key, value in schema["properties"].items() if "const" in value]
    schema["required"] = tags + schema.get("required", [])


Name = Annotated[str, Field(min_length=1, pattern=r"^[^\x00-\x1f\x7f]*$")]

Coordinate = Annotated[float, Field(ge=-LARGEST, le=LARGEST)]
Length = Annotated[float, Field(ge=SMALLEST, le=LARGEST)]
Vector = tuple[Coordinate, Coordinate, Coordinate]
Direction = Annotated[Vector, AfterValidator(_with_a_length)]

Fraction = Annotated[float, Field(ge=0, le=1)]
Color = tuple[Fraction, Fraction, Fraction]

Intensity = Annotated[float, Field(ge=0, le=LARGEST)]
Radiance = tuple[Intensity, Intensity, Intensity]

BLACK = (0.0, 0.0, 0.0)


class Camera(Frozen):
    """A pinhole or a thin lens."""

    position: Vector = Field(description="where the camera stands, x y z in scene units")
    look_at: Vector = Field(description="the point in the middle of the frame, in scene units")
    up: Direction = Field(
        (0.0, 1.0, 0.0), description="the direction that is up in the frame, of any length"
    )
    fov: float = Field(
        45.0,
        gt=0,
        lt=180,
        description="vertical angle of view in degrees, between 0 and 180",
        json_schema_extra={"unit": "degrees", "slider": [1, 150]},
    )
    focus_distance: Length | None = Field(
        None,
        description="distance of the plane in focus along the view axis, in scene units, above 0; "
        "default: the distance to look_at",
    )
    defocus_angle: float = Field(
        0.0,
        ge=0,
        lt=180,
        description="full angle of the lens seen from the point in focus, in degrees, "
        "from 0 (a pinhole) to below 180",
        json_schema_extra={"unit": "degrees", "slider": [0, 20], "cost": Cost.RECOMPILE.value},
    )

    @property
    def view(self) -> Vector:
        """From the position to the point looked at, in scene units."""
        eye, target = self.position, self.look_at
        return (target[0] - eye[0], target[1] - eye[1], target[2] - eye[2])

    @property
    def resolved_focus_distance(self) -> float:
        """Distance of the plane in focus along the view axis, in scene units."""
        return _length(self.view) if self.focus_distance is None else self.focus_distance

    @model_validator(mode="after")
    def _has_a_frame(self) -> Self:
        if _length(self.view) < SMALLEST:
            raise ValueError("position and look_at are the same point; move one of them")
        if _are_parallel(self.view, self.up):
            raise ValueError("up is parallel to the view; choose another direction for up")
        return self


class Background(Frozen):
    """The light that arrives from infinity: one colour, or a vertical gradient."""

    color: Radiance | None = Field(
        None,
        description="radiance from every direction, 0 to 1e15 each; default black",
        json_schema_extra={"cost": Cost.RECOMPILE.value},
    )
    bottom: Radiance | None = Field(
        None,
        description="radiance from straight below, 0 to 1e15 each; needs top",
        json_schema_extra={"cost": Cost.RECOMPILE.value},
    )
    top: Radiance | None = Field(
        None,
        description="radiance from straight above, 0 to 1e15 each; needs bottom",
        json_schema_extra={"cost": Cost.RECOMPILE.value},
    )

    @property
    def gradient(self) -> tuple[Radiance, Radiance]:
        """Radiance from straight below and from straight above, whichever way they were given."""
        flat = self.color or BLACK
        return (self.bottom or flat, self.top or flat)

    @model_validator(mode="after")
    def _is_given_one_way(self) -> Self:
        if (self.bottom is None) != (self.top is None):
            raise ValueError("bottom and top go together; give both, or color alone")
        if self.color is not None and self.top is not None:
            raise ValueError("color excludes bottom and top; give color alone, or both of these")
        return self


class _Tagged(Frozen):
    model_config = ConfigDict(json_schema_extra=_require_tag)


class Lambertian(_Tagged):
    """A matte surface that scatters alike in all directions."""

    type: Literal["lambertian"] = Field("lambertian", description="the kind of material")
    color: Color = Field(description="albedo, 0 to 1 each")


class Metal(_Tagged):
    """A mirror, sharp or rough (GGX)."""

    type: Literal["metal"] = Field("metal", description="the kind of material")
    color: Color = Field(description="reflectance, the same at all angles, 0 to 1 each")
    roughness: Fraction = Field(
        0.0,
        description="from 0, a mirror, to 1; its square is the alpha of GGX",
        json_schema_extra={"cost": Cost.RECOMPILE.value},
    )

    @property
    def alpha(self) -> float:
        """The alpha of GGX; 0 for a mirror, and for what a float32 cannot tell from one."""
        alpha = self.roughness**2
        return alpha if alpha >= SMOOTHEST else 0.0


class Dielectric(_Tagged):
    """Clear glass or liquid with exact unpolarised Fresnel reflection."""

    type: Literal["dielectric"] = Field("dielectric", description="the kind of material")
    ior: Length = Field(
        1.5,
        description="index of refraction, inside over outside, above 0",
        json_schema_extra={"slider": [1, 3]},
    )


class Light(_Tagged):
    """A lamp that emits alike in all directions, from both sides of its surface."""

    type: Literal["light"] = Field("light", description="the kind of material")
    emission: Radiance = Field(description="radiance at intensity 1, 0 to 1e15 each")
    color: Color = Field(BLACK, description="albedo of the lamp itself, 0 to 1 each")
    group: Name | None = Field(
        None, description="light group that it is dimmed with; default: the material's name"
    )


Material = Annotated[Lambertian | Metal | Dielectric | Light, Field(discriminator="type")]


class _Object(_Tagged):
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
        if _are_parallel(self.edge_u, self.edge_v):
            raise ValueError("edge_u and edge_v are parallel, so the quad is flat; turn one")
        return self


Shape = Annotated[Sphere | Plane | Quad, Field(discriminator="shape")]
