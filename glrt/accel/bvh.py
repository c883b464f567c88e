"""A bounding volume hierarchy (BVH) over axis-aligned boxes, built level by level in numpy.

Splits minimise the binned surface area heuristic (Wald, "On Fast Construction of SAH-Based Bounding
Volume Hierarchies", 2007): the box centres of a node are sorted into BINS bins along each axis, and
the node is split between the two bins where surface area times number of boxes, summed over both
sides, is lowest.

Every node holds one item itself, that with the largest box, and divides the others between its
children. So n boxes make n nodes, and large boxes are tested near the root. (In a tree of separate
inner nodes and leaves, a driver that executes both sides of a branch pays for both tests as well.)

Nodes are stored in depth-first order, each with the index at which traversal continues if a ray
misses everything below the node, so traversal needs no stack. The subtree over m boxes has m
nodes, so the index of every node is known before the nodes below it are built.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BINS = 16  # along each axis


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
    by_size = np.argsort(-_surface((upper - lower).T), kind="stable")
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
    """The nodes that have children, each without its first item, which the node itself holds."""
    is_below = np.ones(len(level.items), bool)
    is_below[level.start] = False
    keep = level.size > 1
    return _Level(level.place[keep], level.size[keep] - 1, level.items[is_below])


def _children(level: _Level, lower: Floats, upper: Floats) -> _Level:
    """The children of all nodes of a level: two for each node, one where a single item is left."""
    if not len(level.place):
        return level
    node = np.repeat(np.arange(len(level.size)), level.size)
    is_right = _is_in_right_child(level, node, lower[level.items], upper[level.items])
    is_right ^= is_right[level.start][node]  # largest item left: a hit there hides the rest
    order = np.argsort(2 * node + is_right, kind="stable")
    right = np.bincount(node, is_right).astype(int)
    left = level.size - right
    place = np.column_stack([level.place, level.place + left]).ravel() + 1
    size = np.column_stack([left, right]).ravel()
    return _Level(place[size > 0], size[size > 0], level.items[order])


def _is_in_right_child(level: _Level, node: Ints, lower: Floats, upper: Floats) -> Any:
    """Whether each item of a level belongs to the right child of its node, (items,).

    Both children of a node with two or more items get at least one. A node whose centres
    coincide is divided into halves.
    """
    centre = lower + upper
    low = np.minimum.reduceat(centre, level.start)
    extent = np.maximum.reduceat(centre, level.start) - low
    scale = np.divide(BINS, extent, out=np.zeros_like(extent), where=extent > 0)
    bins = np.minimum(((centre - low[node]) * scale[node]).astype(int), BINS - 1)
    costs = np.stack(
        [_split_costs(len(level.size), node, bins[:, axis], lower, upper) for axis in range(3)], 1
    ).reshape(len(level.size), -1)
    best = costs.argmin(axis=1)
    axis, place = np.divmod(best, BINS - 1)
    rank = np.arange(len(node)) - level.start[node]
    in_half = 2 * rank >= level.size[node]
    has_split = np.isfinite(costs.min(axis=1))
    chosen = np.take_along_axis(bins, axis[node][:, None], 1)[:, 0] > place[node]
    return np.where(has_split[node], chosen, in_half)


def _split_costs(nodes: int, node: Ints, bins: Ints, lower: Floats, upper: Floats) -> Floats:
    """Surface area times number of boxes, summed over both sides of each split along one axis.

    Shape (nodes, BINS - 1); infinite where a side has no boxes.
    """
    key = node * BINS + bins
    count = np.bincount(key, minlength=nodes * BINS).reshape(nodes, BINS)
    low = np.full((3, nodes, BINS), np.inf)
    high = np.full((3, nodes, BINS), -np.inf)
    for axis in range(3):
        np.minimum.at(low[axis].ravel(), key, lower[:, axis])
        np.maximum.at(high[axis].ravel(), key, upper[:, axis])
    left = _cumulative_costs(count, low, high)[:, :-1]
    right = _cumulative_costs(count[:, ::-1], low[..., ::-1], high[..., ::-1])[:, -2::-1]
    cost: Floats = left + right
    return cost


def _cumulative_costs(count: Ints, low: Floats, high: Floats) -> Floats:
    """Surface area times number of all boxes in bins 0 to k, for each k; infinite without boxes.

    `count` and the result are (nodes, BINS), the corners `low` and `high` (3, nodes, BINS).
    """
    total = np.cumsum(count, axis=1)
    size = np.maximum.accumulate(high, axis=2) - np.minimum.accumulate(low, axis=2)
    with np.errstate(invalid="ignore"):  # without boxes the size is -inf
        return np.where(total > 0, _surface(size) * total, np.inf)


def _surface(size: Floats) -> Floats:
    """Half the surface area of boxes with edges `size`, (3, ...)."""
    area: Floats = size[0] * size[1] + size[1] * size[2] + size[2] * size[0]
    return area
