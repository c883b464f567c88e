"""A bounding volume hierarchy (BVH) over axis-aligned boxes, built level by level in numpy.

Every node holds one item itself, that with the largest box, and divides the others between its
children. So n boxes make n nodes, and large boxes are tested near the root. (In a tree of separate
inner nodes and leaves, a driver that executes both sides of a branch pays for both tests as well.)

Nodes are stored in depth-first order, each with the index at which traversal continues if a ray
misses everything below the node, so traversal needs no stack. The subtree over m boxes has m
nodes, so the index of every node is known before the nodes below it are built.
"""

from typing import NamedTuple

import numpy as np

from glrt.accel.binned_splits import Floats, Ints, are_right, surface


class Tree(NamedTuple):
    """A binary tree over n boxes: n nodes in depth-first order."""

    item: Ints  # (n,): index of the box that the node itself holds
    lower: Floats  # (n, 3): corners of the box around all items below the node; 0 without children
    upper: Floats
    skip: Ints  # (n,): index of the next node for a ray that misses that box; n at the end


class _Level(NamedTuple):
    """All nodes of one depth."""

    place: Ints  # index of each node in the tree
    size: Ints  # number of items of each node
    items: Ints  # indices of the items of all nodes, node after node

    @property
    def start(self) -> Ints:
        """Index in `items` of the first item of each node."""
        return np.cumsum(self.size) - self.size


def build(lower: Floats, upper: Floats) -> Tree:
    """Return the tree over n > 0 boxes with the corners `lower` and `upper`, (n, 3) each."""
    count = len(lower)
    corners = np.zeros((2, count, 3))
    tree = Tree(np.empty(count, int), corners[0], corners[1], np.empty(count, int))
    by_size = np.argsort(-surface((upper - lower).T), kind="stable")
    level = _Level(np.zeros(1, int), np.array([count]), by_size)
    while len(level.place):
        tree.item[level.place] = level.items[level.start]
        tree.skip[level.place] = level.place + level.size
        level = _without_own_items(level)
        tree.lower[level.place] = np.minimum.reduceat(lower[level.items], level.start)
        tree.upper[level.place] = np.maximum.reduceat(upper[level.items], level.start)
        level = _children(level, lower, upper)
    return tree


def refit(item: Ints, skip: Ints, lower: Floats, upper: Floats) -> Tree:
    """Return the tree with the topology `item`, `skip` over boxes that moved, (n, 3) each.

    The tree keeps its quality if all boxes moved alike. In depth-first order the nodes below a
    node directly follow it, so its box is a minimum and a maximum over one range of rows.
    """
    place = np.arange(len(item))
    inner = place[skip > place + 1]
    ends = np.column_stack([inner + 1, skip[inner]]).ravel()
    corners = np.zeros((2, len(item), 3))
    for corner, boxes, most in zip(corners, (lower, upper), (np.minimum, np.maximum), strict=True):
        rows = boxes[[*item, item[-1]]]  # one row more: `skip` may be n
        corner[inner] = most.reduceat(rows, ends)[::2] if len(inner) else 0
    return Tree(item, corners[0], corners[1], skip)


def _without_own_items(level: _Level) -> _Level:
    """Return the nodes with children, each without its first item, which the node itself holds."""
    is_below = np.ones(len(level.items), bool)
    is_below[level.start] = False
    keep = level.size > 1
    return _Level(level.place[keep], level.size[keep] - 1, level.items[is_below])


def _children(level: _Level, lower: Floats, upper: Floats) -> _Level:
    """Return the children of a level's nodes: two for each, or one where a single item is left."""
    if not len(level.place):
        return level
    node = np.repeat(np.arange(len(level.size)), level.size)
    boxes = lower[level.items], upper[level.items]
    is_right = are_right(level.start, level.size, node, *boxes)
    is_right ^= is_right[level.start][node]  # the largest item is left: a hit there hides the rest
    order = np.argsort(2 * node + is_right, kind="stable")
    right = np.bincount(node, is_right).astype(int)
    left = level.size - right
    place = np.column_stack([level.place, level.place + left]).ravel() + 1
    size = np.column_stack([left, right]).ravel()
    return _Level(place[size > 0], size[size > 0], level.items[order])
