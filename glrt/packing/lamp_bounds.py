"""Place and extent of lamps, by which the kernel chooses among them.

Each kind of lamp that can be sampled has a row in LAMPS. Triangles of meshes have a function of
their own, since they are many. Paths find other kinds by scattering alone.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from glrt.plan.facts import SAMPLED
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.kinds import KINDS, Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere

Array = np.ndarray[Any, Any]


class Body(NamedTuple):
    """Place and extent of one lamp."""

    area: float  # of both sides; of the outside alone for a sphere
    center: Array  # (3,), float64
    spread2: float  # mean squared distance of its points from the center
    reach: float  # the largest such distance
    normal: Array  # (3,), of any length; 0 for a sphere


class Bodies(NamedTuple):
    """Places and extents of n lamps, a column for each field of Body."""

    area: Array  # (n,)
    center: Array  # (n, 3)
    spread2: Array  # (n,)
    reach: Array  # (n,)
    normal: Array  # (n, 3)


def sphere_body(lamp: Sphere) -> Body:
    """Return the body of a sphere, which emits outwards."""
    area, center = 4 * math.pi * lamp.radius**2, np.array(lamp.center, np.float64)
    return Body(area, center, lamp.radius**2, lamp.radius, np.zeros(3))


def quad_body(lamp: Quad) -> Body:
    """Return the body of a parallelogram, with the area of both sides."""
    u, v = np.array(lamp.edge_u, np.float64), np.array(lamp.edge_v, np.float64)
    center, across = np.array(lamp.corner, np.float64) + (u + v) / 2, np.cross(u, v)
    area, spread2 = 2 * float(np.linalg.norm(across)), float(u @ u + v @ v) / 12
    return Body(area, center, spread2, lamp.reach, across)


def disk_body(lamp: Disk) -> Body:
    """Return the body of a disk, with the area of both sides."""
    area, center = 2 * math.pi * lamp.radius**2, np.array(lamp.center, np.float64)
    return Body(area, center, lamp.radius**2 / 2, lamp.radius, np.array(lamp.normal, np.float64))


def triangle_bodies(corner: Array) -> Bodies:
    """Return the bodies of triangles with these corners, (n, 3, 3)."""
    across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    center = corner.mean(axis=1)
    apart2 = np.square(corner - center[:, None]).sum(axis=2)
    reach = np.sqrt(apart2.max(axis=1))
    return Bodies(np.linalg.norm(across, axis=1), center, apart2.sum(axis=1) / 12, reach, across)


LAMPS: dict[type, Callable[[Any], Body]] = {
    Sphere: sphere_body,
    Quad: quad_body,
    Disk: disk_body,
}

if {KINDS[kind] for kind in SAMPLED} != {*LAMPS, Mesh}:
    raise TypeError(f"lamps of kinds {SAMPLED} are sampled, and {list(LAMPS)} have a body")


def bodies_of(lamps: Sequence[Shape]) -> Bodies:
    """Return the bodies of lamps whose kinds are rows of LAMPS."""
    found = [LAMPS[type(lamp)](lamp) for lamp in lamps]
    columns = list(zip(*found, strict=True)) or [()] * len(Bodies._fields)
    area, center, spread2, reach, normal = (np.array(column, np.float64) for column in columns)
    return Bodies(area, center.reshape(-1, 3), spread2, reach, normal.reshape(-1, 3))


def joined(first: Bodies, second: Bodies) -> Bodies:
    """Return the bodies of the first lamps, then those of the second."""
    return Bodies(*map(np.concatenate, zip(first, second, strict=True)))
