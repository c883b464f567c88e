"""The brightest neighbour of each pixel."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray


def brightest_around(values: NDArray[Any]) -> NDArray[Any]:
    """Maximum of the eight neighbours of each pixel, by channel; -inf for a single pixel."""
    height, width = values.shape[:2]
    framed = np.pad(values, ((1, 1), (1, 1), (0, 0)), constant_values=-math.inf)
    found = np.full_like(values, -math.inf)
    for y, x in ((y, x) for y in range(3) for x in range(3) if (y, x) != (1, 1)):
        np.maximum(found, framed[y : y + height, x : x + width], out=found)
    return found
