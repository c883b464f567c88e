"""Meshes with a tree of their own, and the places where they stand: the struct Instance.

Such a tree lies in the frame of its mesh: the coordinates of the file, relative to the middle of
the box around it, in cells of its grid. Wherever the mesh stands it stays as it is; rays are taken
to that frame.
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
ROUNDED = 1 + 2.0**-20  # boxes are so much larger: corners are float32
MOST_HEIGHT = (
    10  # levels of an own tree: the tree of the scene has what is left of those it may have
)
MOST_NUMBERS = 1 << 31  # of shapes and triangles together


class Bases(NamedTuple):
    """How many rows stand before those of the own trees."""

    slots: int = 0
    corners: int = 0
    triangles: int = 0


class OwnTrees(NamedTuple):
    """The trees of some meshes, one after the other."""

    names: tuple[tuple[str | None, str | None], ...]  # file and part of each
    starts: tuple[Bases, ...]  # of the rows of each, beyond the bases
    height: int  # levels of the highest
    bases: Bases
    slots: Array  # (n, SLOT)
    corners: Array  # rows of the struct Corner
    triangles: Array  # rows of the struct Triangle


class Instances(NamedTuple):
    """Where meshes with own trees stand."""

    boxes: Boxes  # in scene units, with leaves but for where their trees begin
    rows: Array  # of the struct Instance, but for origins and for where triangles begin
    origin: Array  # (n, 3): of their frames, in scene units
    half: Array  # (n, 3): of the boxes around them
    kind: list[int]  # which of the trees each has


def own_trees(meshes: Sequence[Mesh], known: OwnTrees | None) -> OwnTrees:
    """The trees of the distinct ones among meshes, unless they are `known`."""
    kinds = distinct(meshes)[0]
    names = tuple((mesh.file.sha256, mesh.part) for mesh in kinds)
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
    """Slots, corners and triangles of a mesh in its frame, from the cache where they are many."""
    given, grid = mesh.triangles, _grid(mesh)
    owner = np.zeros(len(given.faces), np.uint32)
    found = Triangles(given.vertices, given.shading_normals, given.faces.astype(np.int32), owner)

    def built() -> dict[str, Array]:
        packed = pack_triangles(found, grid, grid.cell)
        wide = build((packed.boxes,), grid, most_height=MOST_HEIGHT).wide
        rows = {"corners": packed.corners, "triangles": packed.triangles}
        return {"slots": wide.slots, "height": np.array(wide.height), **rows}

    if len(given.faces) < tree_cache.LEAST:
        return built()
    return dict(tree_cache.kept(tree_cache.key([*found]), built))


def _shift(slots: Array, triangles: Array, by: Bases) -> None:
    """Let links and numbers of corners begin elsewhere, in place."""
    is_node = slots[:, SLOT - 1] < LEAF
    slots[is_node, SLOT - 1] += np.uint32(by.slots)
    triangles["corners"] += by.corners


def after(trees: OwnTrees, bases: Bases) -> OwnTrees:
    """The same trees where so many rows stand before them."""
    if trees.bases == bases:
        return trees
    by = Bases(*(new - old for new, old in zip(bases, trees.bases, strict=True)))
    slots, triangles = trees.slots.copy(), trees.triangles.copy()
    _shift(slots, triangles, by)
    return trees._replace(bases=bases, slots=slots, triangles=triangles)


def instances_of(meshes: Sequence[Mesh], numbers: Sequence[int], trees: OwnTrees) -> Instances:
    """The places of the meshes with these numbers; `trees` are theirs."""
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
    """The rows of the struct Instance; writes what they share into their leaves among `slots`.

    `center` is the middle of the tree over shapes, in scene units.
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
    """Raise SceneError where the triangles of so many instances cannot all have a number."""
    if (instances + 1 << bits) + shapes >= MOST_NUMBERS:
        most = (MOST_NUMBERS - shapes >> bits) - 1
        raise SceneError(
            f"large meshes stand in {counted(instances, 'place')}, and meshes of up to "
            f"{1 << bits:,} triangles may stand in {most:,}: use smaller meshes, or fewer places."
        )


def _grid(mesh: Mesh) -> Grid:
    return grid_of(*mesh.triangles.box)
