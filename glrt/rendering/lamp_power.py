"""What the choice among lamps knows of each: where it is, how far it reaches, what it emits.

A kind of lamp that can be sampled is a row of LAMPS; triangles, which are many of one mesh, have
functions of their own. Other kinds are found by scattering alone.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from glrt.methods.contents import SAMPLED
from glrt.scene.materials import Opaque
from glrt.scene.meshes import Mesh
from glrt.scene.objects import Object
from glrt.scene.scene import Scene
from glrt.scene.shapes import KINDS, Disk, Quad, Shape, Sphere

Array = np.ndarray[Any, Any]


class Body(NamedTuple):
    """What the choice among lamps knows of the shape of one."""

    area: float  # of its bright sides
    center: Array  # (3,), float64
    reach2: float  # mean squared distance of its points from the center
    normal: Array | None = None  # (3,), of any length, of one that is flat


def sphere_body(lamp: Sphere) -> Body:
    """It shines outwards."""
    return Body(4 * math.pi * lamp.radius**2, np.array(lamp.center, np.float64), lamp.radius**2)


def quad_body(lamp: Quad) -> Body:
    """It shines on both sides."""
    u, v = np.array(lamp.edge_u, np.float64), np.array(lamp.edge_v, np.float64)
    center, across = np.array(lamp.corner, np.float64) + (u + v) / 2, np.cross(u, v)
    return Body(2 * float(np.linalg.norm(across)), center, float(u @ u + v @ v) / 12, across)


def disk_body(lamp: Disk) -> Body:
    """It shines on both sides."""
    area, center = 2 * math.pi * lamp.radius**2, np.array(lamp.center, np.float64)
    return Body(area, center, lamp.radius**2 / 2, np.array(lamp.normal, np.float64))


def triangle_bodies(corner: Array) -> tuple[Array, Array, Array]:
    """Normals as long as their areas, centres and reach2 of triangles, corners (n, 3, 3)."""
    across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]) / 2
    center = corner.mean(axis=1)
    reach2 = np.square(corner - center[:, None]).sum(axis=(1, 2)) / 12
    return across, center, reach2


LAMPS: dict[type, Callable[[Any], Body]] = {
    Sphere: sphere_body,
    Quad: quad_body,
    Disk: disk_body,
}

if {KINDS[kind] for kind in SAMPLED} != {*LAMPS, Mesh}:
    raise TypeError(f"lamps of kinds {SAMPLED} are sampled, and {list(LAMPS)} have a body")


def body_of(lamp: Shape) -> Body:
    """Of a lamp whose kind is a row of LAMPS."""
    return LAMPS[type(lamp)](lamp)


def power(scene: Scene, lamp: Shape, body: Body) -> float:
    """Flux of a lamp, up to a factor common to all: area of its bright sides times radiance."""
    normals = None if body.normal is None else body.normal[None]
    return body.area * radiance(scene, lamp) * float(emitted_share(scene, lamp, normals)[0])


def radiance(scene: Scene, lamp: Object) -> float:
    """What it emits, its channels added."""
    red, green, blue = scene.emission_of(lamp)
    return red + green + blue


def emitted_share(scene: Scene, lamp: Object, normals: Array | None) -> Array:
    """(n,): the flux of what has these normals, (n, 3), over that to all directions and sides.

    Without normals it shines all around.
    """
    material = scene.materials[lamp.material]
    cone = material.cone if isinstance(material, Opaque) else None
    count = 1 if normals is None else len(normals)
    if cone is None:
        return np.full(count, 0.5 if lamp.is_one_sided else 1.0)
    if normals is None:
        return np.full(count, cone.solid_angle / (4 * math.pi))
    return cone.irradiance(normals, lamp.is_one_sided) / (2 * math.pi)
