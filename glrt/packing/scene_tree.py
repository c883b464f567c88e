"""The BVH over the bounded shapes of a scene: how each kind is packed into its leaves.

docs/extending.md explains how to add a kind.
"""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from glrt.accel.shape_tree import MOST_HEIGHT, Boxes, Family, ShapeTree, build, slots_of
from glrt.accel.wide_tree import Grid, WideTree, grid_of
from glrt.packing import tree_cache
from glrt.packing.instances import (
    Bases,
    OwnTrees,
    after,
    check_numbers,
    instances_of,
    own_trees,
    place,
)
from glrt.packing.kernel_structs import CONSTANTS, STRUCTS
from glrt.packing.shapes import in_order
from glrt.packing.triangles import Triangles, pack_triangles, triangles_of
from glrt.plan.facts import ENDLESS, MESH, SceneFacts
from glrt.scene.shapes.kinds import KINDS

Array = np.ndarray[Any, Any]

SLOTS_OF_SHAPE, SLOTS_OF_TRIANGLE = 1.5, 0.8  # slots for each, in a large tree
FEW = 2048  # spare slots at most: nodes of small trees are less full

MOST_CODES = 16  # kinds of leaves: four bits (kind_of in shaders_glsl/shapes/tree.glsl)


def _family(struct: str, *fields: str) -> Family:
    """Return how leaves hold a kind: its fields in the order in which `meet_leaf` reads them."""
    if (name := struct.upper()) not in CONSTANTS:
        raise TypeError(f"shaders_glsl/structs/shapes.glsl has no `const int {name}`: add a number")
    if unknown := set(fields) - set(STRUCTS[struct].names or ()):
        raise TypeError(f"leaves of {struct} name fields that its struct lacks: {sorted(unknown)}")
    return Family(CONSTANTS[name], fields)


# By the name of the struct. Planes have no bounds and stay outside; triangles have other leaves.
FAMILIES = {
    "Sphere": _family("Sphere", "center", "radius"),
    "Quad": _family("Quad", "corner", "normal", "dual_u", "dual_v"),
    "Disk": _family("Disk", "center", "normal", "radius"),
    "Box": _family("Box", "center", "axis_x", "half_x", "axis_y", "half_y", "axis_z", "half_z"),
    "Cylinder": _family("Cylinder", "center", "axis", "radius", "half_height", "is_capped"),
}


def check_kinds(families: Mapping[str, Family], kinds: Collection[str]) -> None:
    """Raise TypeError unless each bounded kind has leaves, with a number that no other has."""
    wanted = {*kinds} - {*ENDLESS, MESH}
    if without := wanted - {struct.lower() for struct in families}:
        raise TypeError(f"kinds without leaves: {sorted(without)}; add them to FAMILIES")
    taken = {CONSTANTS["INSTANCE"]: "INSTANCE", CONSTANTS["TRIANGLES"]: "TRIANGLES"}
    for struct, family in families.items():
        other = taken.setdefault(family.code, struct)
        if other != struct:
            raise TypeError(f"leaves of {struct} have the number {family.code} of {other}")
        if not 0 <= family.code < MOST_CODES:
            raise TypeError(f"leaves of {struct} have the number {family.code}, 0 to 15 exist")


check_kinds(FAMILIES, KINDS)


class SceneTree(NamedTuple):
    """The BVH through which rays find shapes, and the triangles in it."""

    shapes: ShapeTree
    corners: Array  # rows of the struct Corner
    triangles: Array  # rows of the struct Triangle: those of this tree first
    shared: int  # how many are of this tree; the others are of meshes' own BVHs
    own: OwnTrees
    instances: Array  # rows of the struct Instance

    @property
    def stack(self) -> int:
        """Number of stack entries that the kernel needs."""
        return self.shapes.stack_with(self.own.height)

    @property
    def grid(self) -> Grid:
        """The grid in which the tree lies."""
        return self.shapes.grid

    def corner_positions(self, triangles: Array) -> Array:
        """Return the corners of triangles by number, (n, 3, 3), in scene units."""
        corners = self.triangles["corners"][triangles]
        positions: Array = self.corners["position"][corners] + self.grid.center
        return positions

    def lit_by(self, lights: Mapping[int, int], first: int) -> Array:
        """Return the rows of triangles with the rows of their lights.

        `lights` maps numbers to rows of the struct Light; triangles are numbered from `first` on.
        """
        if not lights or max(lights) < first:
            return self.triangles
        rows = self.triangles.copy()
        bright = [number for number in lights if number >= first]
        light = np.array([lights[number] for number in bright], np.uint32)
        rows["owner"][np.array(bright) - first] |= (light + 1) << 16
        return rows


def tree_of(facts: SceneFacts, before: SceneTree | None = None) -> SceneTree | None:
    """Return the BVH through which rays find shapes; None if they are compared one by one.

    Meshes' own BVHs that `before` holds are not built again.
    """
    boxes = list(_boxes(facts))
    if not boxes and not facts.shapes[MESH]:
        return None
    meshes = facts.scene.meshes
    placed = [meshes[number] for number in facts.instances]
    own = own_trees(placed, before.own if before else None)
    check_numbers(len(placed), facts.instance_bits, len(facts.scene.objects))
    instances = instances_of(meshes, facts.instances, own)
    fixed = [instances.boxes] if placed else []
    corners = [(some.lower, some.upper) for some in (*boxes, *fixed)]
    held = [triangles_of(meshes, facts.instances)]
    corners += [(it.position, it.position) for it in held if len(it.position)]
    grid = grid_of(
        np.min([low.min(axis=0) for low, _ in corners], axis=0),
        np.max([high.max(axis=0) for _, high in corners], axis=0),
    )
    del corners
    parts = _built((*boxes, *fixed), held, grid, MOST_HEIGHT - own.height)
    slots = parts["slots"]
    bases = Bases(len(slots), len(parts["corners"]), len(parts["triangles"]))
    own = after(own, bases)
    rows = place(slots, instances, own, grid.center)
    wide = WideTree(slots, int(parts["height"]))
    shapes = ShapeTree(wide, grid, tuple(boxes), parts["place"])
    joint = _joined(parts["corners"], own.corners), _joined(parts["triangles"], own.triangles)
    return SceneTree(shapes, *joint, len(parts["triangles"]), own, rows)


def _joined(first: Array, rest: Array) -> Array:
    """Return two arrays, joined; if one is empty, return the other itself, not a copy."""
    if not len(first) or not len(rest):
        return rest if len(rest) else first
    return np.concatenate([first, rest])


def _built(
    boxes: Sequence[Boxes], held: list[Triangles], grid: Grid, most_height: int
) -> Mapping[str, Array]:
    """Return the BVH over boxes and triangles, with the triangles; the cache keeps large ones.

    The triangles are taken from the list `held`, so that the memory is free while the BVH is built.
    """
    others, count = sum(len(some.lower) for some in boxes), len(held[0].face)

    def built() -> dict[str, Array]:
        packed = pack_triangles(held.pop(), grid) if count else None
        leaves = (*boxes, *([packed.boxes] if packed else []))
        tree = build(leaves, grid, _room_for(others, count), most_height)
        return {
            "slots": tree.wide.slots,
            "place": tree.place,
            "height": np.array(tree.wide.height),
            "corners": packed.corners if packed else np.zeros(0, STRUCTS["Corner"]),
            "triangles": packed.triangles if packed else np.zeros(0, STRUCTS["Triangle"]),
        }

    if count < tree_cache.LEAST:
        return built()
    edges = [edge for some in boxes for edge in (some.lower, some.upper)]
    words = [some.words() for some in boxes if some.words is not None]
    return tree_cache.kept(tree_cache.key([*held[0], *edges, *words]), built)


def _room_for(shapes: int, triangles: int) -> int:
    """Return the number of slots for a BVH over so many; more are rarely needed, wherever they lie.

    So one kernel fits the BVH after shapes are moved, too.
    """
    few = min((shapes + triangles) / 2, FEW)
    return math.ceil(SLOTS_OF_SHAPE * shapes + SLOTS_OF_TRIANGLE * triangles + few)


def _boxes(facts: SceneFacts) -> Iterator[Boxes]:
    """Yield the boxes of shapes that the BVH holds, a kind at a time."""
    shapes, first = in_order(facts.scene) if facts.tree_kinds else [], 0
    for kind in KINDS.values():
        some = [shape for shape in shapes if type(shape) is kind]
        if some and some[0].shape in facts.tree_kinds:
            rows = np.array([shape.row for shape in some], np.float64)
            yield Boxes(kind.__name__, first, *kind.bounds(rows))
        first += len(some)


def pack_tree(tree: SceneTree | None, arrays: Mapping[str, Array]) -> dict[str, Array]:
    """Return rows of the structs Slot, Corner, Triangle and Instance, from packed shapes."""
    if tree is None:
        names = ("Slot", "Corner", "Triangle", "Instance")
        return {name: np.zeros(0, STRUCTS[name]) for name in names}
    slots = _joined(slots_of(tree.shapes, arrays, FAMILIES), tree.own.slots)
    return {
        "Slot": slots.view(STRUCTS["Slot"])[:, 0],
        "Corner": tree.corners,
        "Triangle": tree.triangles,
        "Instance": tree.instances,
    }


def frame_fields(tree: SceneTree | None, eye: Array) -> dict[str, Any]:
    """Return where the grid of the BVH lies, relative to the eye, for the struct Frame."""
    if tree is None:
        return {"tree_center": (0, 0, 0), "tree_cell": 1.0}
    return {"tree_center": tree.grid.center - eye, "tree_cell": tree.grid.cell}
