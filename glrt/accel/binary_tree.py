"""A binary tree over axis-aligned boxes, one in each leaf, built level by level in numpy."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from glrt.accel.binned_splits import Bools, Floats, Ints, are_right, halved
from glrt.core.stages import report
from glrt.core.threads import concurrently

USUAL_DEPTH = 1.15  # mean depth of a leaf, over that in a tree whose leaves have all one depth
PORTION = 1 << 16  # boxes that are divided at once: they fit into a cache, and memory is bounded


class BinaryTree(NamedTuple):
    """2 n - 1 nodes over n boxes, the root first, both children of a node side by side."""

    lower: Floats  # (nodes, 3): corners of the boxes
    upper: Floats
    left: Ints  # (nodes,): the left child, which the right one follows; -1 for leaves
    item: Ints  # (nodes,): the box of a leaf; -1 for other nodes


class _Level(NamedTuple):
    """All nodes of one depth, and the boxes below them."""

    node: Ints
    size: Ints  # number of boxes of each node
    items: Ints  # indices of the boxes of all nodes, node after node

    @property
    def start(self) -> Ints:
        """Index in `items` of the first box of each node."""
        return np.cumsum(self.size) - self.size


def build(lower: Floats, upper: Floats, halves: bool = False) -> BinaryTree:
    """Return the tree over n > 0 boxes with the corners `lower` and `upper`, (n, 3) each.

    With `halves` every node is divided into halves: a worse tree, of the least depth.
    """
    total = 2 * len(lower) - 1
    left, item = np.full(total, -1), np.full(total, -1)
    level = _Level(np.zeros(1, int), np.array([len(lower)]), np.arange(len(lower)))
    levels, used, done = [], 1, 0
    work = USUAL_DEPTH * len(lower) * max(math.log2(len(lower)), 1.0)
    while len(level.node):
        report("tree", min(done / work, 1.0))
        done += len(level.items)
        levels.append(level.node)
        is_leaf = level.size == 1
        item[level.node[is_leaf]] = level.items[level.start[is_leaf]]
        level = _without(level, is_leaf)
        left[level.node] = used + 2 * np.arange(len(level.node))
        used += 2 * len(level.node)
        level = _children(level, left[level.node], lower, upper, halves)
    return BinaryTree(*_boxes(levels, left, item, lower, upper), left, item)


def _without(level: _Level, gone: Bools) -> _Level:
    """Return the level without the nodes that are `gone`, and without their boxes."""
    kept = np.repeat(~gone, level.size)
    return _Level(level.node[~gone], level.size[~gone], level.items[kept])


def _children(level: _Level, left: Ints, lower: Floats, upper: Floats, halves: bool) -> _Level:
    """Return the next level: the two children of each node."""
    if not len(level.node):
        return level
    start, items, right = level.start, np.empty_like(level.items), np.empty_like(level.size)
    divided = halved if halves else are_right

    def divide(part: tuple[slice, slice]) -> None:
        nodes, of = part
        size, boxes = level.size[nodes], level.items[of]
        node = np.repeat(np.arange(len(size)), size)
        first = start[nodes] - of.start
        is_right = divided(first, size, node, lower[boxes], upper[boxes])
        place, right[nodes] = _places(first, size, node, is_right)
        items[of][place] = boxes

    concurrently(divide, _portions(level))
    return _Level(
        np.column_stack([left, left + 1]).ravel(),
        np.column_stack([level.size - right, right]).ravel(),
        items,
    )


def _places(start: Ints, size: Ints, node: Ints, is_right: Bools) -> tuple[Ints, Ints]:
    """Return where boxes go so that those of both children follow each other, in their order.

    The second array has the number of boxes of each right child.
    """
    passed: Ints = np.cumsum(is_right)  # boxes of right children, up to and with each
    before: Ints = passed[start] - is_right[start]
    right = passed[start + size - 1] - before
    rank: Ints = passed - before[node]
    place = np.arange(len(node)) - rank  # of boxes of left children
    to_right = (start + size - right)[node] + rank - 1
    return np.where(is_right, to_right, place), right


def _portions(level: _Level) -> Iterator[tuple[slice, slice]]:
    """Yield some nodes of a level at a time, and their boxes: PORTION, or those of one node."""
    start, first = level.start, 0
    end = start + level.size
    while first < len(start):
        last = max(first + 1, int(np.searchsorted(end, start[first] + PORTION, "right")))
        yield slice(first, last), slice(int(start[first]), int(end[last - 1]))
        first = last


def _boxes(
    levels: list[Ints], left: Ints, item: Ints, lower: Floats, upper: Floats
) -> tuple[Floats, Floats]:
    """Return the corners of the boxes of all nodes, from those of the items."""
    corners = np.empty((2, len(left), 3))
    leaf = item >= 0
    for corner, boxes, most in zip(corners, (lower, upper), (np.minimum, np.maximum), strict=True):
        corner[leaf] = boxes[item[leaf]]
        for nodes in reversed(levels):
            inner = nodes[left[nodes] >= 0]
            corner[inner] = most(corner[left[inner]], corner[left[inner] + 1])
    return corners[0], corners[1]
