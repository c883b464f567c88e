"""Values of dictionaries in the words of Mitsuba.

Others are texts, numbers, points (lists), and matrices (arrays, (4, 4), of column vectors). The key
COMMENT holds a text for readers of a file.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Words = dict[str, Any]

COMMENT = "#"
MARK = "id"  # the key of a name by which other parts refer to a plug-in


class Named(NamedTuple):
    """A plug-in that stands elsewhere in the scene."""

    mark: str


class Pixels(NamedTuple):
    """An image."""

    values: NDArray[np.float32]  # (H, W, 1 or 3), linear, row 0 on top


class Voxels(NamedTuple):
    """A grid in the unit cube."""

    values: NDArray[np.float32]  # (z, y, x, 3)


def color(value: Any) -> Words:
    """Return a colour or a radiance, (3,)."""
    red, green, blue = value
    return {"type": "rgb", "value": [float(red), float(green), float(blue)]}
