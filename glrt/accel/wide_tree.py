"""A BVH with 8 children a node, in slots of 64 bytes as the kernel reads them (struct Slot).

After "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs" (Ylitie, Karras,
Laine 2017): the boxes of the children are bytes in cells of their parent's own size. Slot 0 is the
root; the children of a node follow each other, and its descendants lie in depth-first order. A
slot is

    a node:  words 0 to 2   the corner of its box on the grid, 24 bits along each axis, and, in the
                            upper 8 bits, the exponent of its cell
             words 3 to 14  the boxes of its children in cells: along each axis 8 bytes for their
                            starts, 8 bytes for their ends
             word 15        the number of its last child from bit 27 on, and the slot of its first
    a leaf:  words 0 to 14  what the packer of its shapes writes
             word 15        LEAF, their kind from bit 27 on, and the number of a shape
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.accel.binary_tree import BinaryTree
from glrt.accel.binned_splits import Bools, Floats, Ints, surface

Words = NDArray[np.uint32]

WIDTH = 8  # children of a node
SLOT = 16  # words in a slot
GRID_BITS = 24
HALF_GRID = 2 ** (GRID_BITS - 1)
MARGIN = 4  # cells at the edges of the grid that stay empty
LINK_BITS = 27  # bits for a slot or the number of a shape
LEAF = 1 << 31
PORTION = 1 << 14  # nodes that are written at once, so that memory is bounded
_BIAS = 127  # bias of float32 exponents


class Grid(NamedTuple):
    """The grid in which a tree lies, with its middle and the edge of its cells."""

    center: Floats  # (3,), float64
    cell: float  # a power of two

    def cells(self, position: Floats) -> Floats:
        """Return coordinates on the grid, from 0 to 2^24, (..., 3)."""
        cells: Floats = (position - self.center) / self.cell + HALF_GRID
        return cells


class WideTree(NamedTuple):
    """Slots without the content of their leaves."""

    slots: Words  # (n, SLOT)
    height: int  # levels of nodes


class Leaves(NamedTuple):
    """The slots of a binary tree's leaves in a wide tree."""

    node: Ints  # (leaves,): nodes of the binary tree
    place: Ints  # (leaves,): their slots


class _Level(NamedTuple):
    """Wide nodes of one depth, as nodes of the binary tree."""

    node: Ints  # (w,)
    child: Ints  # (w, WIDTH); -1: none
    inner: Bools  # (w, WIDTH): which children are nodes again


def grid_of(lower: Floats, upper: Floats) -> Grid:
    """Return the grid over the box with these corners, (3,) each."""
    extent = float((upper - lower).max())
    cells = 2 * (HALF_GRID - MARGIN)
    exponent = np.frexp(extent / cells)[1] if extent > 0 else -100
    return Grid((lower + upper) / 2, 2.0 ** max(int(exponent), -100))


def collapse(tree: BinaryTree, grid: Grid, least: int = 0) -> tuple[WideTree, Leaves]:
    """Return the wide tree of a binary one, of `least` slots or more, and where its leaves lie."""
    levels = _levels(tree)
    below, of_child = _sizes(levels)
    slots = np.zeros((max(1 + below, least), SLOT), np.uint32)
    leaf, place_of_leaf = [], []
    place, base = np.zeros(1, int), np.ones(1, int)
    for level, of in zip(levels, of_child, strict=True):
        for first in range(0, len(place), PORTION):
            some = slice(first, first + PORTION)
            part = _Level(level.node[some], level.child[some], level.inner[some])
            slots[place[some]] = _nodes(base[some], part, tree, grid)
        child = base[:, None] + np.arange(WIDTH)
        is_leaf = (level.child >= 0) & ~level.inner
        leaf.append(level.child[is_leaf])
        place_of_leaf.append(child[is_leaf])
        first = base + (level.child >= 0).sum(axis=1)
        before = np.cumsum(of, axis=1) - of
        base, place = (first[:, None] + before)[level.inner], child[level.inner]
    leaves = Leaves(np.concatenate(leaf), np.concatenate(place_of_leaf))
    return WideTree(slots, len(levels)), leaves


def _levels(tree: BinaryTree) -> list[_Level]:
    """Return the wide nodes: the largest child of each is opened until there are WIDTH children."""
    area = surface((tree.upper - tree.lower).T)
    is_inner = tree.left >= 0
    levels, node = [], np.zeros(1, int)
    while len(node):
        child = np.full((len(node), WIDTH), -1)
        child[:, 0] = node
        for many in range(1, WIDTH):
            can = (child >= 0) & is_inner[child]
            size = np.where(can, area[child], -1.0)
            pick = size.argmax(axis=1)
            row = np.flatnonzero(can.any(axis=1))
            opened = child[row, pick[row]]
            child[row, pick[row]] = tree.left[opened]
            child[row, many] = tree.left[opened] + 1
        inner = (child >= 0) & is_inner[child]
        levels.append(_Level(node, child, inner))
        node = child[inner]
    return levels


def _sizes(levels: list[_Level]) -> tuple[int, list[Ints]]:
    """Return how many slots lie below the root, and below each child of each level, (w, WIDTH)."""
    sizes = np.zeros(0, int)
    of_child: list[Ints] = []
    for level in reversed(levels):
        of = np.zeros(level.child.shape, int)
        of[level.inner] = sizes
        of_child.insert(0, of)
        sizes = (level.child >= 0).sum(axis=1) + of.sum(axis=1)
    return int(sizes[0]), of_child


def _nodes(base: Ints, level: _Level, tree: BinaryTree, grid: Grid) -> Words:
    """Return the slots of nodes whose children begin at `base`."""
    corner = np.floor(grid.cells(tree.lower[level.node]))
    extent = grid.cells(tree.upper[level.node]) - corner
    exponent = np.ceil(np.log2(np.maximum(extent, 2.0**-100) / 255)).astype(int)
    exponent += np.exp2(exponent) * 255 < extent
    cell = np.exp2(exponent)
    low, high = grid.cells(tree.lower[level.child]), grid.cells(tree.upper[level.child])
    start = np.floor((low - corner[:, None]) / cell[:, None])
    end = np.ceil((high - corner[:, None]) / cell[:, None])
    none = (level.child < 0)[..., None]
    start, end = np.where(none, 0, start), np.where(none, 0, end)
    rows = np.zeros((len(base), SLOT), np.uint32)
    rows[:, :3] = corner.astype(np.uint32) | (exponent + _BIAS).astype(np.uint32) << GRID_BITS
    bounds = np.stack([start, end], axis=1).astype(np.uint8)  # (w, 2, WIDTH, 3)
    along = np.ascontiguousarray(bounds.transpose(0, 3, 1, 2)).reshape(len(base), -1)
    rows[:, 3:15] = along.view(np.uint32)
    last = (level.child >= 0).sum(axis=1) - 1
    rows[:, 15] = base | last << LINK_BITS
    return rows
