"""The tree over the bounded shapes of a scene: how each kind is packed into its leaves.

docs/extending.md says how a kind is added.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from glrt.accel.shape_tree import Boxes, Family, ShapeTree, build, slots_of
from glrt.methods.contents import ENDLESS, Contents
from glrt.rendering.kernel_structs import CONSTANTS, STRUCTS
from glrt.rendering.pack_shapes import in_order
from glrt.scene.scene import Scene
from glrt.scene.shapes import KINDS

Array = np.ndarray[Any, Any]

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


if {kind.lower() for kind in FAMILIES} != {*KINDS} - {*ENDLESS}:
    raise TypeError(f"leaves hold {list(FAMILIES)}; kinds of shapes are {list(KINDS)}")


def tree_of(scene: Scene, contents: Contents) -> ShapeTree | None:
    """The tree that rays find shapes by; None where they are compared one by one."""
    if not contents.tree_kinds:
        return None
    shapes, boxes, first = in_order(scene), [], 0
    for kind in KINDS.values():
        some = [shape for shape in shapes if type(shape) is kind]
        if some and some[0].shape in contents.tree_kinds:
            rows = np.array([shape.row for shape in some], np.float64)
            boxes.append(Boxes(kind.__name__, first, *kind.bounds(rows)))
        first += len(some)
    return build(tuple(boxes))


def pack_tree(tree: ShapeTree | None, arrays: Mapping[str, Array]) -> Array:
    """Rows of the struct Slot, over shapes that are packed."""
    if tree is None:
        return np.zeros(0, STRUCTS["Slot"])
    return slots_of(tree, arrays, FAMILIES).view(STRUCTS["Slot"])[:, 0]


def frame_fields(tree: ShapeTree | None, eye: Array) -> dict[str, Any]:
    """Where the grid of the tree lies, for the struct Frame."""
    if tree is None:
        return {"tree_center": (0, 0, 0), "tree_cell": 1.0}
    return {"tree_center": tree.grid.center - eye, "tree_cell": tree.grid.cell}
