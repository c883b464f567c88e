"""The BVH over bounded shapes of a scene, as slots for the kernel: a shape in each leaf.

The boxes depend on the shapes alone, but the content of leaves is relative to the camera, as the
shapes themselves are. So a moved camera rewrites leaves and builds nothing. Leaves of triangles are
relative to the middle of the grid, and stay the same.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from glrt.accel import binary_tree
from glrt.accel.binned_splits import Floats, Ints
from glrt.accel.wide_tree import LEAF, LINK_BITS, SLOT, Grid, WideTree, Words, collapse
from glrt.core.errors import SceneError

Array = np.ndarray[Any, Any]

MOST_HEIGHT = 16  # levels: the kernel keeps a stack entry for each in registers
STACK_STEP = 4  # levels by which the stack grows, so that one kernel fits several heights


class Family(NamedTuple):
    """How leaves hold a kind of shape."""

    code: int  # as in structs/shapes.glsl
    fields: tuple[str, ...]  # fields of its struct, in the order of the words of a leaf


class Boxes(NamedTuple):
    """Axis-aligned boxes around shapes of one kind, in scene units."""

    struct: str
    first: int  # the kernel's number of the first shape
    lower: Floats  # (n, 3)
    upper: Floats
    words: Callable[[], Words] | None = None  # makes leaves that no camera changes, (n, SLOT)


class ShapeTree(NamedTuple):
    """A BVH without the content of leaves that depend on the camera."""

    wide: WideTree
    grid: Grid
    boxes: tuple[Boxes, ...]  # boxes of these leaves
    place: Ints  # (n,): their slots, box after box

    def stack_with(self, height: int) -> int:
        """Return the stack entries that the kernel needs, with BVHs of this height below leaves."""
        return -(-(self.wide.height + height) // STACK_STEP) * STACK_STEP


def build(
    boxes: tuple[Boxes, ...], grid: Grid, least: int = 0, most_height: int = MOST_HEIGHT
) -> ShapeTree:
    """Return the BVH over one or more shapes, of `least` slots or more; `grid` holds them all.

    Raises SceneError if no tree of at most `most_height` levels is found.
    """
    lower = np.concatenate([some.lower for some in boxes])
    upper = np.concatenate([some.upper for some in boxes])
    tree = binary_tree.build(lower, upper)
    wide, leaves = collapse(tree, grid, least)
    if wide.height > most_height:
        tree = binary_tree.build(lower, upper, halves=True)
        wide, leaves = collapse(tree, grid, least)
    if wide.height > most_height:
        raise SceneError(
            f"the tree over the shapes of this scene has {wide.height} levels, and the kernel has "
            f"room for {most_height}: sizes or distances differ too much. Leave out the smallest."
        )
    place = np.empty(len(lower), int)
    place[tree.item[leaves.node]] = leaves.place
    del tree, leaves  # the next steps need as much memory
    ends = np.cumsum([len(some.lower) for some in boxes])
    places = np.split(place, ends[:-1])
    for some, where in zip(boxes, places, strict=True):
        if some.words is not None:
            wide.slots[where] = some.words()
    moved = [k for k, some in enumerate(boxes) if some.words is None]
    of_moved = [np.zeros(0, int), *(places[k] for k in moved)]
    return ShapeTree(wide, grid, tuple(boxes[k] for k in moved), np.concatenate(of_moved))


def slots_of(tree: ShapeTree, arrays: Mapping[str, Array], families: Mapping[str, Family]) -> Words:
    """Return the slots with their leaves; `arrays` has the rows of shapes by struct name.

    If no leaf depends on the camera, this is the tree's own array, not a copy.
    """
    if not tree.boxes:
        return tree.wide.slots
    slots = tree.wide.slots.copy()
    begin = 0
    for some in tree.boxes:
        end = begin + len(some.lower)
        family, rows = families[some.struct], arrays[some.struct]
        words = np.concatenate([_words(rows, field) for field in family.fields], axis=1)
        place = tree.place[begin:end]
        slots[place, : words.shape[1]] = words
        slots[place, SLOT - 1] = (
            LEAF | family.code << LINK_BITS | (some.first + np.arange(len(rows)))
        )
        begin = end
    return slots


def _words(rows: Array, field: str) -> Words:
    """Return the bits of a field, (n, 1) or (n, 3)."""
    return np.ascontiguousarray(rows[field]).reshape(len(rows), -1).view(np.uint32)
