"""Lamps as the kernel chooses among them: rows of the structs `Light` and `Cluster`.

Few lamps are weighed one by one at each point, so each is a cluster of its own. Many are grouped by
place into clusters, and these into parts, which are weighed; within a part a table chooses by flux.
"""

from collections.abc import Sequence
from itertools import accumulate, chain
from typing import Any, NamedTuple

import numpy as np

from glrt.accel.light_clusters import alias_table, grouped, light_probabilities
from glrt.methods.contents import MOST_NEAR, Contents
from glrt.rendering.kernel_structs import CONSTANTS
from glrt.rendering.lamp_power import (
    LAMPS,
    body_of,
    emitted_share,
    power,
    radiance,
    triangle_bodies,
)
from glrt.rendering.pack_tree import SceneTree
from glrt.scene.meshes import Mesh
from glrt.scene.scene import Scene
from glrt.scene.shapes import Shape

Array = np.ndarray[Any, Any]

PARTS, SEVERAL = CONSTANTS["PARTS"], CONSTANTS["SEVERAL"]


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
        if type(shape) in LAMPS and scene.finish(shape).group
    ]
    bodies = [body_of(shapes[number]) for number in found]
    center = np.array([body.center for body in bodies], np.float64).reshape(-1, 3)
    reach2 = np.array([body.reach2 for body in bodies], np.float64)
    flux = [power(scene, shapes[number], body) for number, body in zip(found, bodies, strict=True)]
    if tree and contents.lamp_triangles:
        bright = _bright_triangles(scene, shapes, tree)
        corner = tree.corner_positions(bright)
        across, middle, spread = triangle_bodies(corner)
        found += [len(shapes) + int(number) for number in bright]
        flux += list(_triangle_power(scene, shapes, across, tree.triangles["owner"][bright]))
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


def _triangle_power(scene: Scene, shapes: Sequence[Shape], across: Array, owners: Array) -> Array:
    """As `power`, of triangles with these normals, as long as their areas, of these meshes."""
    found: Array = np.zeros(len(across))
    meshes = [shape for shape in shapes if isinstance(shape, Mesh)]
    for number, mesh in enumerate(meshes):
        own = owners == number
        area = np.linalg.norm(across[own], axis=1)
        found[own] = 2 * area * emitted_share(scene, mesh, across[own]) * radiance(scene, mesh)
    return found


def _bright_triangles(scene: Scene, shapes: Sequence[Shape], tree: SceneTree) -> Array:
    """The numbers of the triangles that emit."""
    meshes = [shape for shape in shapes if isinstance(shape, Mesh)]
    is_bright = np.array([bool(scene.finish(mesh).group) for mesh in meshes])
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
