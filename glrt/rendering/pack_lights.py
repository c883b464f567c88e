"""Lamps as the kernel chooses among them: rows of the structs `Light` and `Cluster`.

Few lamps are weighed one by one at each point, so each is a cluster of its own. Many are grouped by
place into clusters, and these into parts, which are weighed; within a part a table chooses by flux.
"""

import math
from collections.abc import Callable, Sequence
from itertools import accumulate, chain
from typing import Any, NamedTuple

import numpy as np

from glrt.accel.light_clusters import alias_table, grouped, light_probabilities
from glrt.methods.contents import MOST_NEAR, SAMPLED, Contents, is_light
from glrt.rendering.kernel_structs import CONSTANTS
from glrt.rendering.pack_tree import SceneTree
from glrt.scene.meshes import Mesh
from glrt.scene.scene import Scene
from glrt.scene.shapes import KINDS, Disk, Quad, Shape, Sphere

Array = np.ndarray[Any, Any]

PARTS, SEVERAL = CONSTANTS["PARTS"], CONSTANTS["SEVERAL"]


class Body(NamedTuple):
    """What the choice among lamps knows of one."""

    area: float  # of its bright sides
    center: Array  # (3,), float64
    reach2: float  # mean squared distance of its points from the center


def sphere_body(lamp: Sphere) -> Body:
    """It shines outwards."""
    return Body(4 * math.pi * lamp.radius**2, np.array(lamp.center, np.float64), lamp.radius**2)


def quad_body(lamp: Quad) -> Body:
    """It shines on both sides."""
    u, v = np.array(lamp.edge_u, np.float64), np.array(lamp.edge_v, np.float64)
    center = np.array(lamp.corner, np.float64) + (u + v) / 2
    return Body(2 * float(np.linalg.norm(np.cross(u, v))), center, float(u @ u + v @ v) / 12)


def disk_body(lamp: Disk) -> Body:
    """It shines on both sides."""
    area = 2 * math.pi * lamp.radius**2
    return Body(area, np.array(lamp.center, np.float64), lamp.radius**2 / 2)


def triangle_bodies(corner: Array) -> tuple[Array, Array, Array]:
    """Area, centre and reach2 of triangles with these corners, (n, 3, 3); both sides shine."""
    across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    center = corner.mean(axis=1)
    reach2 = np.square(corner - center[:, None]).sum(axis=(1, 2)) / 12
    return np.linalg.norm(across, axis=1), center, reach2


# The kinds of lamps that are sampled, but for triangles, which are many of one mesh. Others are
# found by scattering alone.
LAMPS: dict[type, Callable[[Any], Body]] = {
    Sphere: sphere_body,
    Quad: quad_body,
    Disk: disk_body,
}

if {KINDS[kind] for kind in SAMPLED} != {*LAMPS, Mesh}:
    raise TypeError(f"lamps of kinds {SAMPLED} are sampled, and {list(LAMPS)} have a body")


class Lamps(NamedTuple):
    """The lamps that can be sampled, those of a part of a cluster side by side; float64."""

    shapes: list[int]  # their numbers
    probability: Array  # (n,): share of the flux, above 0
    center: Array  # (n, 3), in the scene's coordinates
    reach2: Array  # (n,): mean squared distance of their points from the center
    parts: list[list[slice]]  # of each cluster


def lamps_of(
    scene: Scene, shapes: Sequence[Shape], contents: Contents, tree: SceneTree | None
) -> Lamps:
    """The lamps among the shapes that can be sampled; their number is their place in the list.

    Triangles of the tree that emit are numbered after all shapes.
    """
    found = [
        number
        for number, shape in enumerate(shapes)
        if type(shape) in LAMPS and is_light(scene.materials[shape.material])
    ]
    bodies = [LAMPS[type(shapes[number])](shapes[number]) for number in found]
    center = np.array([body.center for body in bodies], np.float64).reshape(-1, 3)
    reach2 = np.array([body.reach2 for body in bodies], np.float64)
    flux = [power(scene, shapes[number]) for number in found]
    if tree and contents.lamp_triangles:
        bright = _bright_triangles(scene, shapes, tree)
        corner = tree.corner_positions(bright)
        area, middle, spread = triangle_bodies(corner)
        emission = _mesh_emission(scene, shapes)[tree.triangles["owner"][bright]]
        found += [len(shapes) + int(number) for number in bright]
        flux += list(area * emission)
        center, reach2 = np.concatenate([center, middle]), np.concatenate([reach2, spread])
    probability = light_probabilities(flux)
    clusters = [
        [cluster[part] for part in grouped(center[cluster], probability[cluster], PARTS)]
        for cluster in grouped(center, probability, MOST_NEAR)
    ]
    order = np.concatenate([np.arange(0), *chain(*clusters)])
    ends = accumulate(len(part) for part in chain(*clusters))
    return Lamps(
        [found[index] for index in order],
        probability[order],
        center[order],
        reach2[order],
        [[slice((end := next(ends)) - len(part), end) for part in parts] for parts in clusters],
    )


def _mesh_emission(scene: Scene, shapes: Sequence[Shape]) -> Array:
    """Radiance of each mesh, its channels added."""
    meshes = [shape for shape in shapes if isinstance(shape, Mesh)]
    return np.array([sum(scene.emission(mesh.material)) for mesh in meshes])


def _bright_triangles(scene: Scene, shapes: Sequence[Shape], tree: SceneTree) -> Array:
    """The numbers of the triangles that emit."""
    meshes = [shape for shape in shapes if isinstance(shape, Mesh)]
    is_bright = np.array([is_light(scene.materials[mesh.material]) for mesh in meshes])
    numbers: Array = np.flatnonzero(is_bright[tree.triangles["owner"]])
    return numbers


def pack_lights(lamps: Lamps, dtype: np.dtype[Any]) -> Array:
    """Rows of the struct Light."""
    rows = np.zeros(len(lamps.shapes), dtype)
    rows["shape"] = lamps.shapes
    for cluster, parts in enumerate(lamps.parts):
        for number, members in enumerate(parts):
            flux = lamps.probability[members]
            rows["share"][members] = flux / flux.sum()
            keep, alias = alias_table(flux / flux.sum())
            part = len(lamps.parts) + PARTS * cluster + number
            rows["keep"][members] = keep
            rows["alias"][members] = part << 16 | members.start + alias  # of 65,536 at most
    return rows


def pack_clusters(lamps: Lamps, eye: Array, dtype: np.dtype[Any]) -> Array:
    """Rows of the struct Cluster; of many lamps, those of their parts behind them."""
    count = len(lamps.parts)
    rows = np.zeros(count * (1 + PARTS if len(lamps.shapes) > count else 1), dtype)
    rows["shape"], rows["reach2"] = SEVERAL, 1  # a part without lamps has the weight 0 / 1
    for row, parts in zip(rows, lamps.parts, strict=False):
        _fill(row, lamps, slice(parts[0].start, parts[-1].stop), eye)
    for cluster, parts in enumerate(lamps.parts if len(rows) > count else []):
        first = count + PARTS * cluster
        for row, members in zip(rows[first:], parts, strict=False):
            _fill(row, lamps, members, eye)
    return rows


def _fill(row: Any, lamps: Lamps, members: slice, eye: Array) -> None:
    """The row of a cluster or a part with these lamps."""
    share = lamps.probability[members] / lamps.probability[members].sum()
    center = share @ (lamps.center[members] - eye)
    apart2 = ((lamps.center[members] - eye - center) ** 2).sum(axis=1)
    row["center"], row["reach2"] = center, share @ (apart2 + lamps.reach2[members])
    row["probability"] = lamps.probability[members].sum()
    row["first"], row["count"] = members.start, len(share)
    row["shape"] = lamps.shapes[members.start] if len(share) == 1 else SEVERAL


def power(scene: Scene, shape: Shape) -> float:
    """Flux of a lamp, up to a factor common to all: area of its bright sides times radiance."""
    return LAMPS[type(shape)](shape).area * sum(scene.emission(shape.material))
