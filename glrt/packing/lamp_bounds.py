"""Place and extent of lamps, by which the kernel chooses among them.

Each kind of shape that can be sampled has its `lamp_body`. Triangles of meshes have a function of
their own, since they are many. Paths find other kinds by scattering alone.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from glrt.scene.shapes.kinds import Shape

Array = np.ndarray[Any, Any]


class Bodies(NamedTuple):
    """Places and extents of n lamps, a column for each field of LampBody."""

    area: Array  # (n,)
    center: Array  # (n, 3)
    spread2: Array  # (n,)
    reach: Array  # (n,)
    normal: Array  # (n, 3)


def triangle_bodies(corner: Array) -> Bodies:
    """Return the bodies of triangles with these corners, (n, 3, 3)."""
    across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    center = corner.mean(axis=1)
    apart2 = np.square(corner - center[:, None]).sum(axis=2)
    reach = np.sqrt(apart2.max(axis=1))
    return Bodies(np.linalg.norm(across, axis=1), center, apart2.sum(axis=1) / 12, reach, across)


def bodies_of(lamps: Sequence[Shape]) -> Bodies:
    """Return the bodies of lamps that have one."""
    found = [body for lamp in lamps if (body := lamp.lamp_body)]
    columns = list(zip(*found, strict=True)) or [()] * len(Bodies._fields)
    area, center, spread2, reach, normal = (np.array(column, np.float64) for column in columns)
    return Bodies(area, center.reshape(-1, 3), spread2, reach, normal.reshape(-1, 3))


def joined(first: Bodies, second: Bodies) -> Bodies:
    """Return the bodies of the first lamps, then those of the second."""
    return Bodies(*map(np.concatenate, zip(first, second, strict=True)))
