"""The tree over bounded shapes of a scene, as slots for the kernel: a shape in each leaf.

Which boxes lie where is a matter of the shapes alone; what stands in the leaves is relative to the
camera, as the shapes themselves are. So a camera that moves writes leaves anew, and builds nothing.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from glrt.accel import binary_tree
from glrt.accel.binned_splits import Floats, Ints
from glrt.accel.wide_tree import LEAF, LINK_BITS, SLOT, Grid, WideTree, Words, collapse, grid_of

Array = np.ndarray[Any, Any]

MOST_HEIGHT = 16  # levels: the kernel keeps an entry for each in registers
STACK_STEP = 4  # a kernel does for trees of so many heights


class Family(NamedTuple):
    """A kind of shape in leaves."""

    code: int  # as in structs/shapes.glsl
    fields: tuple[str, ...]  # of its struct, in the order of the words of a leaf


class Boxes(NamedTuple):
    """Axis-aligned boxes around shapes of one kind, in scene units."""

    struct: str
    first: int  # the kernel's number of the first shape
    lower: Floats  # (n, 3)
    upper: Floats


class ShapeTree(NamedTuple):
    """A tree without the content of its leaves."""

    wide: WideTree
    grid: Grid
    place: Ints  # (n,): the slots of the shapes, kind after kind
    boxes: tuple[Boxes, ...]

    @property
    def stack(self) -> int:
        """Entries that the kernel needs room for."""
        return -(-self.wide.height // STACK_STEP) * STACK_STEP


def build(boxes: tuple[Boxes, ...]) -> ShapeTree:
    """The tree over one or more shapes."""
    lower = np.concatenate([some.lower for some in boxes])
    upper = np.concatenate([some.upper for some in boxes])
    grid = grid_of(lower.min(axis=0), upper.max(axis=0))
    tree = binary_tree.build(lower, upper)
    wide = collapse(tree, grid)
    if wide.height > MOST_HEIGHT:
        tree = binary_tree.build(lower, upper, halves=True)
        wide = collapse(tree, grid)
    place = np.empty(len(lower), int)
    place[tree.item[wide.leaf]] = wide.place
    return ShapeTree(wide, grid, place, boxes)


def slots_of(tree: ShapeTree, arrays: Mapping[str, Array], families: Mapping[str, Family]) -> Words:
    """The slots with their leaves, of shapes in `arrays` of rows by the names of their structs."""
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
    """The bits of a field, (n, 1) or (n, 3)."""
    return np.ascontiguousarray(rows[field]).reshape(len(rows), -1).view(np.uint32)
