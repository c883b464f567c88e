"""How far apart floats are: in steps from one float32 to the next."""

from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]


def words(values: Array) -> Array:
    """The bits of 32-bit values, uint32."""
    bits: Array = np.ascontiguousarray(values).view(np.uint32)
    return bits


def ulps(a: Array, b: Array) -> Array:
    """Steps between float32 values, int64; between zeros of both signs there is none."""
    steps: Array = np.abs(_rank(a) - _rank(b))
    return steps


def _rank(values: Array) -> Array:
    """Integers in the order of the floats."""
    bits = words(values).astype(np.int64)
    return np.where(bits < 0x80000000, bits, 0x80000000 - bits)
