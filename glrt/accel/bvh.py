"""Boxes -> a bounding volume hierarchy, level by level in numpy.

Binned surface area heuristic (Wald, "On Fast Construction of SAH-Based Bounding Volume
Hierarchies", 2007): a node is split between two of BINS slices of its boxes' centres, along the
axis and at the place that let a ray meet the fewest boxes.

Every node keeps a box of its own, the largest of those that it is over, and divides the rest among
its children: n boxes make n nodes, and what is large is met near the root. (Drivers that compute
both sides of a branch test a node's own box and the one around the rest for the price of a choice.)

Nodes lie in depth-first order, and know where to go on when a ray misses what lies below them: a
ray then needs no stack. A node over m boxes has m nodes below it, itself included, so every place
is known from above.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BINS = 16


class Tree(NamedTuple):
    """A binary tree over n boxes: n nodes in depth-first order."""

    item: Ints  # the box that is the node's own
    lower: Floats  # (n, 3): corners of the box around the rest, zeros where there is none
    upper: Floats
    skip: Ints  # the next node for a ray that misses the rest; n at the end


class _Level(NamedTuple):
    """Nodes of one depth: `items` of all of them in a row."""

    place: Ints  # of each node in the tree
    size: Ints  # items of each
    items: Ints

    @property
    def start(self) -> Ints:
        return np.cumsum(self.size) - self.size


def build(lower: Floats, upper: Floats) -> Tree:
    """The tree over boxes given by their corners, (n, 3) each, n > 0."""
    count = len(lower)
    corners = np.zeros((2, count, 3))
    tree = Tree(np.empty(count, int), corners[0], corners[1], np.empty(count, int))
    by_size = np.argsort(-_surface((upper - lower).T), kind="stable")
    level = _Level(np.zeros(1, int), np.array([count]), by_size)
    while len(level.place):
        tree.item[level.place] = level.items[level.start]
        tree.skip[level.place] = level.place + level.size
        level = _rest(level)
        tree.lower[level.place] = np.minimum.reduceat(lower[level.items], level.start)
        tree.upper[level.place] = np.maximum.reduceat(upper[level.items], level.start)
        level = _below(level, lower, upper)
    return tree


def refit(item: Ints, skip: Ints, lower: Floats, upper: Floats) -> Tree:
    """The tree with these nodes over boxes that have moved: it stays as good where all moved alike.

    Depth-first, what lies below a node lies in a row behind it.
    """
    place = np.arange(len(item))
    inner = place[skip > place + 1]
    ends = np.column_stack([inner + 1, skip[inner]]).ravel()
    corners = np.zeros((2, len(item), 3))
    for corner, boxes, most in zip(corners, (lower, upper), (np.minimum, np.maximum), strict=True):
        rows = boxes[[*item, item[-1]]]  # `skip` may be the end
        corner[inner] = most.reduceat(rows, ends)[::2] if len(inner) else 0
    return Tree(item, corners[0], corners[1], skip)


def _rest(level: _Level) -> _Level:
    """The nodes that have children, without their own items, which come first."""
    is_rest = np.ones(len(level.items), bool)
    is_rest[level.start] = False
    keep = level.size > 1
    return _Level(level.place[keep], level.size[keep] - 1, level.items[is_rest])


def _below(level: _Level, lower: Floats, upper: Floats) -> _Level:
    """The children of all nodes of a level: two, or one for a single item."""
    if not len(level.place):
        return level
    node = np.repeat(np.arange(len(level.size)), level.size)
    is_right = _sides(level, node, lower[level.items], upper[level.items])
    is_right ^= is_right[level.start][node]  # large items first: what is hit there hides the rest
    order = np.argsort(2 * node + is_right, kind="stable")
    right = np.bincount(node, is_right).astype(int)
    left = level.size - right
    place = np.column_stack([level.place, level.place + left]).ravel() + 1
    size = np.column_stack([left, right]).ravel()
    return _Level(place[size > 0], size[size > 0], level.items[order])


def _sides(level: _Level, node: Ints, lower: Floats, upper: Floats) -> Any:
    """Of each item on which side of the split it lies; both get some, where there are two."""
    centre = lower + upper
    low = np.minimum.reduceat(centre, level.start)
    extent = np.maximum.reduceat(centre, level.start) - low
    scale = np.divide(BINS, extent, out=np.zeros_like(extent), where=extent > 0)
    slices = np.minimum(((centre - low[node]) * scale[node]).astype(int), BINS - 1)
    costs = np.stack(
        [_costs(len(level.size), node, slices[:, axis], lower, upper) for axis in range(3)], 1
    ).reshape(len(level.size), -1)
    best = costs.argmin(axis=1)
    axis, place = np.divmod(best, BINS - 1)
    rank = np.arange(len(node)) - level.start[node]
    in_half = 2 * rank >= level.size[node]
    has_split = np.isfinite(costs.min(axis=1))
    chosen = np.take_along_axis(slices, axis[node][:, None], 1)[:, 0] > place[node]
    return np.where(has_split[node], chosen, in_half)


def _costs(nodes: int, node: Ints, slices: Ints, lower: Floats, upper: Floats) -> Floats:
    """(nodes, BINS - 1): surface times boxes of both sides, for each place between slices."""
    key = node * BINS + slices
    count = np.bincount(key, minlength=nodes * BINS).reshape(nodes, BINS)
    low = np.full((3, nodes, BINS), np.inf)
    high = np.full((3, nodes, BINS), -np.inf)
    for axis in range(3):
        np.minimum.at(low[axis].ravel(), key, lower[:, axis])
        np.maximum.at(high[axis].ravel(), key, upper[:, axis])
    left = _swept(count, low, high)[:, :-1]
    right = _swept(count[:, ::-1], low[..., ::-1], high[..., ::-1])[:, -2::-1]
    cost: Floats = left + right
    return cost


def _swept(count: Ints, low: Floats, high: Floats) -> Floats:
    """Surface times boxes of slices up to each one, infinite where there is no box."""
    total = np.cumsum(count, axis=1)
    size = np.maximum.accumulate(high, axis=2) - np.minimum.accumulate(low, axis=2)
    with np.errstate(invalid="ignore"):  # where there is no box yet, its size is -inf
        return np.where(total > 0, _surface(size) * total, np.inf)


def _surface(size: Floats) -> Floats:
    """Half the surface of boxes; `size` is (3, ...)."""
    area: Floats = size[0] * size[1] + size[1] * size[2] + size[2] * size[0]
    return area
