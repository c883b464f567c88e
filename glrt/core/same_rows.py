"""Whether two arrays hold the same bits."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


def same_rows(left: NDArray[Any], right: NDArray[Any]) -> bool:
    """Return whether two arrays of one type, contiguous, hold the same bits.

    Rows that lie in the same place are not compared: 50 MB, the tree of a million triangles, take
    10 to 600 ms.
    """
    if left.shape != right.shape:
        return False
    if left is right or _place_of(left) == _place_of(right):
        return True
    return np.array_equal(left.view(np.uint8), right.view(np.uint8))


def _place_of(rows: NDArray[Any]) -> tuple[object, ...]:
    """Return where an array lies in memory, and how: two views of one array agree."""
    return rows.ctypes.data, rows.strides, rows.dtype
