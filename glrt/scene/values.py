"""Numbers, vectors and colours of a scene, with their ranges.

Lengths in scene units, angles in degrees, colours in linear sRGB, right-handed, y up.
"""

import math
from typing import Annotated, Any

from pydantic import AfterValidator, ConfigDict, Field

from glrt.settings import Frozen

# The squares of lengths and radiances must be normal float32 numbers, which end at 1e-38 and 3e38.
SMALLEST = 1e-15
LARGEST = 1e15

# Sine of an angle: below it the cross product of two float32 vectors is mostly rounding error.
PARALLEL_SINE = 1e-6


def length_of(vector: "Vector") -> float:
    return math.hypot(*vector)


def are_parallel(a: "Vector", b: "Vector") -> bool:
    cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return length_of(cross) <= PARALLEL_SINE * length_of(a) * length_of(b)


def _with_a_length(vector: "Vector") -> "Vector":
    if length_of(vector) < SMALLEST:
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


class Tagged(Frozen):
    """A value whose kind a scene file names."""

    model_config = ConfigDict(json_schema_extra=_require_tag)
