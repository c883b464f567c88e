"""Lamps as the kernel chooses among them: rows of the structs `Light` and `Cluster`.

Few lamps are weighed one by one at each point, so each is a cluster of its own. Many are grouped by
place into clusters, and each cluster is divided into parts. The kernel weighs the clusters, then
the parts of the chosen one; within a part, a table chooses a lamp by flux.
"""

from collections.abc import Iterator, Sequence
from itertools import accumulate, chain
from typing import Any, NamedTuple

import numpy as np

from glrt.accel.light_clusters import alias_table, grouped, light_probabilities
from glrt.packing.emission_cones import Aims, aims_of, around_all
from glrt.packing.kernel_structs import CONSTANTS
from glrt.packing.lamp_bounds import Bodies, bodies_of, joined, triangle_bodies
from glrt.packing.scene_tree import SceneTree
from glrt.plan.facts import MOST_NEAR, SceneFacts
from glrt.plan.particles import is_sampled
from glrt.scene.scene import Scene
from glrt.scene.shapes.base import Object
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh

Array = np.ndarray[Any, Any]

PARTS, SEVERAL = CONSTANTS["PARTS"], CONSTANTS["SEVERAL"]


class Lamps(NamedTuple):
    """The lamps that can be sampled, in float64; lamps of one part of a cluster are adjacent."""

    shapes: list[int]  # the kernel's numbers of their shapes
    probability: Array  # (n,): share of the flux, above 0
    bodies: Bodies  # in the scene's coordinates
    aims: Aims | None  # None where all emit to all sides
    parts: list[list[slice]]  # for each cluster, the lamps of each part


def lamps_of(facts: SceneFacts, shapes: Sequence[Shape], tree: SceneTree | None) -> Lamps:
    """Return the lamps among the shapes that can be sampled.

    The number of a shape is its place in the list. Emitting triangles of the BVH are numbered after
    all shapes.
    """
    scene = facts.scene
    found = [
        number
        for number, shape in enumerate(shapes)
        if shape.lamp_body and is_sampled(scene.materials[shape.material])
    ]
    lamps: list[Shape] = [shapes[number] for number in found]
    bodies = bodies_of(lamps)
    flux = bodies.area * np.array([radiance(scene, lamp) for lamp in lamps])
    if tree and facts.lamp_triangles:
        bright = _bright_triangles(scene, shapes, tree)
        triangles = triangle_bodies(tree.corner_positions(bright))
        meshes = [shape for shape in shapes if isinstance(shape, Mesh)]
        owners = tree.triangles["owner"][bright]
        emission = np.array([radiance(scene, mesh) for mesh in meshes])
        found += [len(shapes) + int(number) for number in bright]
        lamps += [meshes[owner] for owner in owners]
        flux = np.concatenate([flux, triangles.area * emission[owners]])
        bodies = joined(bodies, triangles)
    probability = light_probabilities(flux)
    clusters = [
        [cluster[part] for part in grouped(bodies.center[cluster], probability[cluster], PARTS)]
        for cluster in grouped(bodies.center, probability, MOST_NEAR)
    ]
    order = np.concatenate([np.arange(0), *chain(*clusters)])
    ends = accumulate(len(part) for part in chain(*clusters))
    aims = aims_of(scene, lamps, bodies.normal) if facts.is_aimed else None
    return Lamps(
        [found[index] for index in order],
        probability[order],
        Bodies(*(column[order] for column in bodies)),
        aims and aims.of(order),
        [[slice((end := next(ends)) - len(part), end) for part in parts] for parts in clusters],
    )


def radiance(scene: Scene, lamp: Object) -> float:
    """Return the radiance of a lamp where it is brightest, summed over the channels."""
    red, green, blue = scene.emission_of(lamp)
    return red + green + blue


def _bright_triangles(scene: Scene, shapes: Sequence[Shape], tree: SceneTree) -> Array:
    """Return the numbers of the triangles that emit and can be sampled."""
    meshes = [shape for shape in shapes if isinstance(shape, Mesh)]
    is_bright = np.array([is_sampled(scene.materials[mesh.material]) for mesh in meshes])
    numbers: Array = np.flatnonzero(is_bright[tree.triangles["owner"][: tree.shared]])
    return numbers


def pack_lights(lamps: Lamps, dtype: np.dtype[Any]) -> Array:
    """Return rows of the struct Light."""
    rows = np.zeros(len(lamps.shapes), dtype)
    rows["shape"] = lamps.shapes
    for cluster, parts in enumerate(lamps.parts):
        for number, members in enumerate(parts):
            flux = lamps.probability[members]
            rows["share"][members] = flux / flux.sum()
            keep, alias = alias_table(flux / flux.sum())
            part = len(lamps.parts) + PARTS * cluster + number
            rows["keep"][members] = keep
            rows["alias"][members] = part << 16 | members.start + alias  # below 65,536
    return rows


def pack_clusters(lamps: Lamps, eye: Array, dtype: np.dtype[Any]) -> Array:
    """Return rows of the struct Cluster; with many lamps, rows of parts follow the clusters."""
    rows = np.zeros(_row_count(lamps), dtype)
    rows["shape"], rows["reach2"] = SEVERAL, 1  # a part without lamps has the weight 0 / 1
    for number, members in _members(lamps):
        row, share = rows[number], _shares(lamps, members)
        center, apart2 = _middle(lamps, members, eye)
        row["center"] = center
        row["reach2"] = share @ (apart2 + lamps.bodies.spread2[members])
        row["probability"] = lamps.probability[members].sum()
        row["first"], row["count"] = members.start, len(share)
        row["shape"] = lamps.shapes[members.start] if len(share) == 1 else SEVERAL
    return rows


def pack_aims(lamps: Lamps, eye: Array, dtype: np.dtype[Any]) -> Array:
    """Return rows of the struct Aim, one for each of Cluster; none if all lamps emit everywhere."""
    if lamps.aims is None:
        return np.zeros(0, dtype)
    rows = np.zeros(_row_count(lamps), dtype)
    for number, members in _members(lamps):
        row, aim = rows[number], around_all(lamps.aims.of(members))
        row["axis"], row["outer"], row["slope"] = (column[0] for column in aim)
        _, apart2 = _middle(lamps, members, eye)
        row["reach"] = (np.sqrt(apart2) + lamps.bodies.reach[members]).max()
    return rows


def _row_count(lamps: Lamps) -> int:
    count = len(lamps.parts)
    return count * (1 + PARTS if len(lamps.shapes) > count else 1)


def _members(lamps: Lamps) -> Iterator[tuple[int, slice]]:
    """Yield the row of each cluster and part, and its lamps."""
    count = len(lamps.parts)
    for cluster, parts in enumerate(lamps.parts):
        yield cluster, slice(parts[0].start, parts[-1].stop)
    for cluster, parts in enumerate(lamps.parts if _row_count(lamps) > count else []):
        for number, members in enumerate(parts):
            yield count + PARTS * cluster + number, members


def _shares(lamps: Lamps, members: slice) -> Array:
    share: Array = lamps.probability[members] / lamps.probability[members].sum()
    return share


def _middle(lamps: Lamps, members: slice, eye: Array) -> tuple[Array, Array]:
    """Return the flux's mean place, relative to the eye, and squared distances from it, (n,)."""
    places = lamps.bodies.center[members] - eye
    center = _shares(lamps, members) @ places
    return center, ((places - center) ** 2).sum(axis=1)
