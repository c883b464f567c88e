"""The tree over bounded shapes of a scene, as slots for the kernel: a shape in each leaf.

Which boxes lie where is a matter of the shapes alone; what stands in the leaves is relative to the
camera, as the shapes themselves are. So a camera that moves writes leaves anew, and builds nothing.
Leaves of triangles are relative to the middle of the grid: those stay.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from glrt.accel import binary_tree
from glrt.accel.binned_splits import Floats, Ints
from glrt.accel.wide_tree import LEAF, LINK_BITS, SLOT, Grid, WideTree, Words, collapse
from glrt.core.errors import SceneError

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
    words: Callable[[], Words] | None = None  # leaves that no camera changes, (n, SLOT)


class ShapeTree(NamedTuple):
    """A tree without the content of those leaves that depend on the camera."""

    wide: WideTree
    grid: Grid
    boxes: tuple[Boxes, ...]  # of those
    place: Ints  # (n,): their slots, box after box

    def stack_with(self, height: int) -> int:
        """Entries that the kernel needs room for, with trees of such a height below leaves."""
        return -(-(self.wide.height + height) // STACK_STEP) * STACK_STEP


def build(
    boxes: tuple[Boxes, ...], grid: Grid, least: int = 0, most_height: int = MOST_HEIGHT
) -> ShapeTree:
    """The tree over one or more shapes, of `least` slots or more; `grid` holds them all.

    Raises SceneError where they lie so that no tree of `most_height` levels is found.
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
    del tree, leaves  # what follows needs as much memory
    ends = np.cumsum([len(some.lower) for some in boxes])
    places = np.split(place, ends[:-1])
    for some, where in zip(boxes, places, strict=True):
        if some.words is not None:
            wide.slots[where] = some.words()
    moved = [k for k, some in enumerate(boxes) if some.words is None]
    of_moved = [np.zeros(0, int), *(places[k] for k in moved)]
    return ShapeTree(wide, grid, tuple(boxes[k] for k in moved), np.concatenate(of_moved))


def slots_of(tree: ShapeTree, arrays: Mapping[str, Array], families: Mapping[str, Family]) -> Words:
    """The slots with their leaves, of shapes in `arrays` of rows by the names of their structs.

    The same array again where no leaf depends on the camera.
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
    """The bits of a field, (n, 1) or (n, 3)."""
    return np.ascontiguousarray(rows[field]).reshape(len(rows), -1).view(np.uint32)
