"""Numbers, vectors and colours of a scene, with their ranges.

Lengths are in scene units, angles in degrees, and colours in linear sRGB. Coordinates are
right-handed, with y up.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, ConfigDict, Field, model_validator

from glrt.settings import Frozen

# The squares of lengths and radiances must be normal float32 numbers, which end at 1e-38 and 3e38.
SMALLEST = 1e-15
LARGEST = 1e15

# Sine of an angle below which the cross product of two float32 vectors is mostly rounding error.
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


def require_tag(schema: dict[str, Any]) -> None:
    """Require the tag in a schema: its default is for Python alone, and a file must name it."""
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

Angle = Annotated[float, Field(ge=-360_000, le=360_000)]  # degrees

BLACK = (0.0, 0.0, 0.0)
WHITE = (1.0, 1.0, 1.0)

# Values that Python code may give for a number, and for a vector or a colour.
Number = float | np.floating[Any] | np.integer[Any]
Triple = Sequence[Number] | NDArray[np.floating[Any]] | NDArray[np.integer[Any]]

_HUGE = 10**400  # beyond every range; Python refuses to print much longer integers
_PLAIN = {float, str}  # types that stay as they are: a scene is full of them
_LISTS = (list, tuple)
_TABLES = (dict, Mapping)  # isinstance takes several times as long with Mapping alone


def plain(value: Any, depth: int = 8) -> Any:
    """Return the value as strict validation needs it: Python's own numbers, and tuples for lists.

    numpy's arrays count as lists, its numbers as numbers. Integers are limited to a size that can
    be printed. A scene is 5 levels deep, down to the numbers of an object; levels below `depth` are
    left out, as they are wrong anyway.
    """
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, _LISTS):
        items = value if depth else ()
        return tuple([x if type(x) in _PLAIN else plain(x, depth - 1) for x in items])
    if isinstance(value, _TABLES):
        pairs = value.items() if depth else ()
        return {key: x if type(x) in _PLAIN else plain(x, depth - 1) for key, x in pairs}
    return _number(value)


def _number(value: Any) -> Any:
    if isinstance(value, float | np.floating):
        return float(value)
    if isinstance(value, int | np.integer) and not isinstance(value, bool):
        return max(-_HUGE, min(int(value), _HUGE))
    return bool(value) if isinstance(value, np.bool_) else value


class Value(Frozen):
    """A value of a scene: it accepts what scene files accept, and numpy's arrays and numbers.

    Its fields have the types that it holds. An `__init__` for type checkers alone declares what it
    accepts.
    """

    model_config = ConfigDict(strict=True)

    @model_validator(mode="before")
    @classmethod
    def _is_plain(cls, data: Any) -> Any:
        return plain(data)


class Tagged(Value):
    """A value with a tag, by which a scene file names its kind."""

    model_config = ConfigDict(json_schema_extra=require_tag)
