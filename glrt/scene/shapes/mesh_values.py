"""Factors and matrices of meshes, with their ranges."""

from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, BeforeValidator, WithJsonSchema

from glrt.scene.values import LARGEST, SMALLEST, Coordinate, Vector


def _three(value: Any) -> Any:
    return (value, value, value) if isinstance(value, float | int) else value


def _without_zeros(value: Vector) -> Vector:
    if min(map(abs, value)) < SMALLEST:
        raise ValueError(
            f"must be numbers of at least {SMALLEST:g}, or below -{SMALLEST:g} to mirror: 0 makes "
            "the mesh flat"
        )
    return value


_NUMBER = {"type": "number", "minimum": -LARGEST, "maximum": LARGEST}
_FACTORS = {"anyOf": [_NUMBER, {"type": "array", "items": _NUMBER, "minItems": 3, "maxItems": 3}]}
Factors = Annotated[
    Vector,
    BeforeValidator(_three),
    AfterValidator(_without_zeros),
    WithJsonSchema(_FACTORS),
]


def _with_a_volume(rows: Any) -> Any:
    if rows[3] != (0, 0, 0, 1):
        raise ValueError("must end with the row 0, 0, 0, 1")
    lengths = np.linalg.norm(np.array(rows)[:3, :3], axis=0)
    if lengths.min() < SMALLEST or abs(np.linalg.det(np.array(rows)[:3, :3] / lengths)) < _FLATTEST:
        raise ValueError("must not make the mesh flat: its columns lie in a plane")
    return rows


_FLATTEST = 1e-9  # volume between unit columns
_Row = tuple[Coordinate, Coordinate, Coordinate, Coordinate]
Matrix = Annotated[tuple[_Row, _Row, _Row, _Row], AfterValidator(_with_a_volume)]
