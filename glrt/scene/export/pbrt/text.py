"""Directives of pbrt and their parameters, as text."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from glrt.scene.export.placing import Vector

Parameters = Mapping[str, Any]  # values by type and name, as {"float eta": 1.5}


def directive(name: str, *texts: str) -> str:
    """Return a directive with texts in quotes."""
    return " ".join([name, *map(string, texts)])


def with_parameters(start: str, parameters: Parameters) -> str:
    """Return a directive with parameters after `start`."""
    return " ".join([start, *(f'"{key}" {_value(it)}' for key, it in parameters.items())])


def string(text: str) -> str:
    """Return a text in quotes."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def comment(text: str) -> str:
    """Return a line that pbrt skips."""
    return f"# {' '.join(text.split())}"


def numbers(values: Any) -> str:
    """Return numbers, or rows of numbers, with spaces between them."""
    flat = np.ravel(values)
    if flat.dtype.kind in "iu":
        return " ".join(map(str, flat.tolist()))
    return " ".join(repr(float(it) + 0.0) for it in flat)


def transform(matrix: Vector) -> str:
    """Return the directive that applies a matrix, (4, 4), of column vectors."""
    return f"ConcatTransform [ {numbers(np.asarray(matrix, np.float64).T)} ]"


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return string(value)
    if isinstance(value, list) and value and isinstance(value[0], str):
        return f"[ {' '.join(map(string, value))} ]"
    return f"[ {numbers(value)} ]"
