"""The tree over the bounded shapes of a scene: how each kind is packed into its leaves.

docs/extending.md says how a kind is added.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from glrt.accel.shape_tree import Boxes, Family, ShapeTree, build, slots_of
from glrt.accel.wide_tree import Grid, WideTree, grid_of
from glrt.methods.contents import ENDLESS, MESH, Contents
from glrt.rendering import tree_cache
from glrt.rendering.kernel_structs import CONSTANTS, STRUCTS
from glrt.rendering.pack_mesh import pack_triangles, triangles_of
from glrt.rendering.pack_shapes import in_order
from glrt.scene.scene import Scene
from glrt.scene.shapes import KINDS

Array = np.ndarray[Any, Any]

SLOTS_OF_SHAPE, SLOTS_OF_TRIANGLE = 1.5, 0.8  # in a tree over many
FEW = 2048  # slots: nodes of small trees are less full

# By the name of the struct; those that are not here have no bounds, and stay outside.
FAMILIES = {
    "Sphere": Family(CONSTANTS["SPHERE"], ("center", "radius")),
    "Quad": Family(CONSTANTS["QUAD"], ("corner", "normal", "dual_u", "dual_v")),
    "Disk": Family(CONSTANTS["DISK"], ("center", "normal", "radius")),
    "Box": Family(
        CONSTANTS["BOX"], ("center", "axis_x", "half_x", "axis_y", "half_y", "axis_z", "half_z")
    ),
    "Cylinder": Family(
        CONSTANTS["CYLINDER"], ("center", "axis", "radius", "half_height", "is_capped")
    ),
}


if {kind.lower() for kind in FAMILIES} != {*KINDS} - {*ENDLESS, MESH}:
    raise TypeError(f"leaves hold {list(FAMILIES)}; kinds of shapes are {list(KINDS)}")


class SceneTree(NamedTuple):
    """The tree that rays find shapes by, and the triangles in it."""

    shapes: ShapeTree
    corners: Array  # rows of the struct Corner
    triangles: Array  # rows of the struct Triangle

    @property
    def stack(self) -> int:
        """Entries that the kernel needs room for."""
        return self.shapes.stack

    @property
    def grid(self) -> Grid:
        """Where it lies."""
        return self.shapes.grid

    def corner_positions(self, triangles: Array) -> Array:
        """(n, 3, 3): of triangles by number, in scene units."""
        corners = self.triangles["corners"][triangles]
        positions: Array = self.corners["position"][corners] + self.grid.center
        return positions

    def lit_by(self, lights: Mapping[int, int], first: int) -> Array:
        """The triangles with their lights, by their number from `first` on."""
        if not lights or max(lights) < first:
            return self.triangles
        rows = self.triangles.copy()
        bright = [number for number in lights if number >= first]
        light = np.array([lights[number] for number in bright], np.uint32)
        rows["owner"][np.array(bright) - first] |= (light + 1) << 16
        return rows


def tree_of(scene: Scene, contents: Contents) -> SceneTree | None:
    """The tree that rays find shapes by; None where they are compared one by one."""
    boxes = list(_boxes(scene, contents))
    corners, triangles = np.zeros(0, STRUCTS["Corner"]), np.zeros(0, STRUCTS["Triangle"])
    others = sum(len(some.lower) for some in boxes)
    if not contents.shapes[MESH]:
        if not boxes:
            return None
        return SceneTree(build(tuple(boxes), None, _room_for(others, 0)), corners, triangles)
    found = triangles_of(scene)
    lows = [some.lower.min(axis=0) for some in boxes] + [found.position.min(axis=0)]
    highs = [some.upper.max(axis=0) for some in boxes] + [found.position.max(axis=0)]
    grid = grid_of(np.min(lows, axis=0), np.max(highs, axis=0))

    def built() -> dict[str, Array]:
        packed = pack_triangles(found, grid)
        tree = build((*boxes, packed.boxes), grid, _room_for(others, len(found.face)))
        return {
            "slots": tree.wide.slots,
            "place": tree.place,
            "height": np.array(tree.wide.height),
            "corners": packed.corners,
            "triangles": packed.triangles,
        }

    if contents.triangles < tree_cache.LEAST:
        parts: Mapping[str, Array] = built()
    else:
        edges = [edge for some in boxes for edge in (some.lower, some.upper)]
        parts = tree_cache.kept([*found, *edges], built)
    wide = WideTree(parts["slots"], int(parts["height"]))
    shapes = ShapeTree(wide, grid, tuple(boxes), parts["place"])
    return SceneTree(shapes, parts["corners"], parts["triangles"])


def _room_for(shapes: int, triangles: int) -> int:
    """Slots of a tree over so many: rarely more are needed, wherever they lie.

    So a kernel does for the tree after shapes are moved.
    """
    few = min((shapes + triangles) / 2, FEW)
    return math.ceil(SLOTS_OF_SHAPE * shapes + SLOTS_OF_TRIANGLE * triangles + few)


def _boxes(scene: Scene, contents: Contents) -> Iterator[Boxes]:
    """Of the shapes that are not compared one by one, a kind at a time."""
    shapes, first = in_order(scene) if contents.tree_kinds else [], 0
    for kind in KINDS.values():
        some = [shape for shape in shapes if type(shape) is kind]
        if some and some[0].shape in contents.tree_kinds:
            rows = np.array([shape.row for shape in some], np.float64)
            yield Boxes(kind.__name__, first, *kind.bounds(rows))
        first += len(some)


def pack_tree(tree: SceneTree | None, arrays: Mapping[str, Array]) -> dict[str, Array]:
    """Rows of the structs Slot, Corner and Triangle, over shapes that are packed."""
    if tree is None:
        return {name: np.zeros(0, STRUCTS[name]) for name in ("Slot", "Corner", "Triangle")}
    slots = slots_of(tree.shapes, arrays, FAMILIES).view(STRUCTS["Slot"])[:, 0]
    return {"Slot": slots, "Corner": tree.corners, "Triangle": tree.triangles}


def frame_fields(tree: SceneTree | None, eye: Array) -> dict[str, Any]:
    """Where the grid of the tree lies, for the struct Frame."""
    if tree is None:
        return {"tree_center": (0, 0, 0), "tree_cell": 1.0}
    return {"tree_center": tree.grid.center - eye, "tree_cell": tree.grid.cell}
