"""Meshes with a BVH of their own, and their placements: the struct Instance.

Such a BVH lies in the frame of its mesh: the coordinates of the file, relative to the middle of the
box around the mesh, in cells of its grid. It stays the same wherever the mesh stands, and rays are
transformed to that frame.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from glrt.accel.shape_tree import Boxes, build
from glrt.accel.wide_tree import LEAF, LINK_BITS, SLOT, Grid, grid_of
from glrt.core.errors import SceneError
from glrt.core.text import counted
from glrt.packing import tree_cache
from glrt.packing.kernel_structs import CONSTANTS, STRUCTS
from glrt.packing.triangles import Triangles, pack_triangles
from glrt.scene.instancing import distinct
from glrt.scene.shapes.mesh import Mesh

Array = np.ndarray[Any, Any]

INSTANCE = CONSTANTS["INSTANCE"]
ROUNDED = 1 + 2.0**-20  # factor by which boxes are enlarged, since corners are float32
MOST_HEIGHT = 10  # levels of a mesh's own BVH; the BVH of the scene has the rest
MOST_NUMBERS = 1 << 31  # limit for the numbers of shapes and triangles together


class Bases(NamedTuple):
    """Numbers of rows that stand before those of the meshes' own BVHs."""

    slots: int = 0
    corners: int = 0
    triangles: int = 0


class OwnTrees(NamedTuple):
    """The BVHs of some meshes, one after the other."""

    names: tuple[object, ...]  # file and part of each
    starts: tuple[Bases, ...]  # where the rows of each BVH start, beyond the bases
    height: int  # levels of the highest
    bases: Bases
    slots: Array  # (n, SLOT)
    corners: Array  # rows of the struct Corner
    triangles: Array  # rows of the struct Triangle


class Instances(NamedTuple):
    """Placements of meshes that have BVHs of their own."""

    boxes: Boxes  # in scene units, with leaves that `place` completes
    rows: Array  # rows of the struct Instance, which `place` completes
    origin: Array  # (n, 3): origins of their frames, in scene units
    half: Array  # (n, 3): half edges of the boxes around them
    kind: list[int]  # number of the BVH of each


def own_trees(meshes: Sequence[Mesh], known: OwnTrees | None) -> OwnTrees:
    """Return the BVHs of the distinct meshes; `known` itself if it holds them."""
    kinds = distinct(meshes)[0]
    names = tuple(mesh.form for mesh in kinds)
    if known and known.names == names:
        return known
    starts, at, height = [], Bases(), 0
    slots: list[Array] = [np.zeros((0, SLOT), np.uint32)]
    corners: list[Array] = [np.zeros(0, STRUCTS["Corner"])]
    triangles: list[Array] = [np.zeros(0, STRUCTS["Triangle"])]
    for mesh in kinds:
        parts = _own_tree(mesh)
        _shift(parts["slots"], parts["triangles"], at)
        slots.append(parts["slots"])
        corners.append(parts["corners"])
        triangles.append(parts["triangles"])
        starts.append(at)
        ends = (len(rows) for rows in (slots[-1], corners[-1], triangles[-1]))
        at = Bases(*(start + count for start, count in zip(at, ends, strict=True)))
        height = max(height, int(parts["height"]))
    rows = map(np.concatenate, (slots, corners, triangles))
    return OwnTrees(names, tuple(starts), height, Bases(), *rows)


def _own_tree(mesh: Mesh) -> dict[str, Array]:
    """Return slots, corners, triangles and height of a mesh in its frame; large ones are cached."""
    given, grid = mesh.triangles, _grid(mesh)
    owner = np.zeros(len(given.faces), np.uint32)
    faces, hides = given.faces.astype(np.int32), np.full(len(owner), mesh.hides_backs)
    found = Triangles(given.vertices, given.shading_normals, faces, owner, hides)

    def built() -> dict[str, Array]:
        packed = pack_triangles(found, grid, grid.cell)
        wide = build((packed.boxes,), grid, most_height=MOST_HEIGHT).wide
        rows = {"corners": packed.corners, "triangles": packed.triangles}
        return {"slots": wide.slots, "height": np.array(wide.height), **rows}

    if len(given.faces) < tree_cache.LEAST:
        return built()
    return dict(tree_cache.kept(tree_cache.key([*found]), built))


def _shift(slots: Array, triangles: Array, by: Bases) -> None:
    """Move links and numbers of corners by `by`, forwards or backwards, in place."""
    is_node = slots[:, SLOT - 1] < LEAF
    slots[is_node, SLOT - 1] += np.array(by.slots).astype(np.uint32)  # a step back wraps around
    triangles["corners"] += by.corners


def after(trees: OwnTrees, bases: Bases) -> OwnTrees:
    """Return the same BVHs for other `bases`."""
    if trees.bases == bases:
        return trees
    by = Bases(*(new - old for new, old in zip(bases, trees.bases, strict=True)))
    slots, triangles = trees.slots.copy(), trees.triangles.copy()
    _shift(slots, triangles, by)
    return trees._replace(bases=bases, slots=slots, triangles=triangles)


def instances_of(meshes: Sequence[Mesh], numbers: Sequence[int], trees: OwnTrees) -> Instances:
    """Return the placements of the meshes with these numbers, whose BVHs are `trees`."""
    placed = [meshes[number] for number in numbers]
    kind = distinct(placed)[1]
    rows = np.zeros(len(placed), STRUCTS["Instance"])
    words = np.zeros((len(placed), SLOT), np.uint32)
    origin, half = np.zeros((len(placed), 3)), np.zeros((len(placed), 3))
    for index, (mesh, row, leaf) in enumerate(zip(placed, rows, words, strict=True)):
        grid, linear = _grid(mesh), mesh.linear
        low, high = mesh.triangles.box
        inward = (np.linalg.inv(linear) / grid.cell).astype(np.float32)
        origin[index] = linear @ grid.center + mesh.origin
        half[index] = np.abs(linear) @ ((high - low) / 2 * ROUNDED)
        for axis, name in enumerate("xyz"):
            row[f"to_{name}"], row[f"from_{name}"] = inward[axis], linear[:, axis] * grid.cell
        largest = np.abs(inward).sum(axis=1).max()
        leaf[:9] = inward.ravel().view(np.uint32)
        leaf[12] = trees.starts[kind[index]].slots
        leaf[13:14] = np.array([largest], np.float32).view(np.uint32)
    rows["mesh"] = numbers
    words[:, 15] = LEAF | INSTANCE << LINK_BITS | np.arange(1, len(placed) + 1)
    return Instances(
        Boxes("Instance", 0, origin - half, origin + half, lambda: words), rows, origin, half, kind
    )


def place(slots: Array, found: Instances, trees: OwnTrees, center: Array) -> Array:
    """Return the rows of the struct Instance, and complete their leaves among `slots` in place.

    `center` is the middle of the BVH over shapes, in scene units.
    """
    at = np.flatnonzero(slots[:, SLOT - 1] >> LINK_BITS == LEAF >> LINK_BITS | INSTANCE)
    number = (slots[at, SLOT - 1] & (1 << LINK_BITS) - 1).astype(int) - 1
    local = (found.origin - center).astype(np.float32)
    reach = (np.abs(local) + found.half).sum(axis=1).astype(np.float32)
    slots[at, 9:12] = local[number].view(np.uint32)
    slots[at, 12] += np.uint32(trees.bases.slots)
    slots[at, 14] = reach[number].view(np.uint32)
    rows = found.rows.copy()
    rows["origin"], rows["reach"] = local, reach
    rows["triangles"] = [
        trees.bases.triangles + trees.starts[kind].triangles for kind in found.kind
    ]
    return rows


def check_numbers(instances: int, bits: int, shapes: int) -> None:
    """Raise SceneError if the triangles of so many instances cannot all have a number."""
    if (instances + 1 << bits) + shapes >= MOST_NUMBERS:
        most = (MOST_NUMBERS - shapes >> bits) - 1
        raise SceneError(
            f"large meshes stand in {counted(instances, 'place')}, and meshes of up to "
            f"{1 << bits:,} triangles may stand in {most:,}: use smaller meshes, or fewer places."
        )


def _grid(mesh: Mesh) -> Grid:
    return grid_of(*mesh.triangles.box)
