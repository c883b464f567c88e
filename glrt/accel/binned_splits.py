"""Divide boxes between the children of nodes, for all nodes of a level at once.

Splits minimise the binned surface area heuristic (Wald, "On Fast Construction of SAH-Based Bounding
Volume Hierarchies", 2007): the box centres of a node are sorted into BINS bins along each axis, and
the node is split between the two bins where surface area times number of boxes, summed over both
sides, is lowest.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

BINS = 16  # along each axis


def are_right(start: Ints, size: Ints, node: Ints, lower: Floats, upper: Floats) -> Bools:
    """Return whether each box belongs to the right child of its node, (n,).

    The boxes of a node follow each other, `size` boxes from `start` on, (nodes,) each; `node`,
    (n,), is the node of each box. Both children of a node with two or more boxes get at least one.
    A node whose centres coincide is divided into halves.
    """
    is_right: Bools = np.arange(len(node)) > start[node]
    large = size > 2  # with two boxes, each is a child
    if not large.any():
        return is_right
    kept = np.repeat(large, size)
    size, node = size[large], np.repeat(np.arange(int(large.sum())), size[large])
    lower, upper, start = lower[kept], upper[kept], np.cumsum(size) - size
    centre = lower + upper
    low = np.minimum.reduceat(centre, start)
    extent = np.maximum.reduceat(centre, start) - low
    scale = np.divide(BINS, extent, out=np.zeros_like(extent), where=extent > 0)
    bins = np.minimum((centre - low[node]) * scale[node], BINS - 1).astype(np.int8)
    costs = np.stack(
        [_split_costs(len(size), node, bins[:, axis], lower, upper) for axis in range(3)], 1
    ).reshape(len(size), -1)
    best = costs.argmin(axis=1)
    axis, place = np.divmod(best, BINS - 1)
    rank = np.arange(len(node)) - start[node]
    in_half = 2 * rank >= size[node]
    has_split = np.isfinite(costs.min(axis=1))
    chosen = np.take_along_axis(bins, axis[node][:, None], 1)[:, 0] > place[node]
    is_right[kept] = np.where(has_split[node], chosen, in_half)
    return is_right


def _split_costs(nodes: int, node: Ints, bins: Ints, lower: Floats, upper: Floats) -> Floats:
    """Return surface area times number of boxes, summed over both sides of each split.

    The splits lie along one axis. Shape (nodes, BINS - 1); infinite where a side has no boxes.
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
    """Return surface area times number of all boxes in bins 0 to k, for each k; inf without boxes.

    `count` and the result are (nodes, BINS), the corners `low` and `high` (3, nodes, BINS).
    """
    total = np.cumsum(count, axis=1)
    size = np.maximum.accumulate(high, axis=2) - np.minimum.accumulate(low, axis=2)
    with np.errstate(invalid="ignore"):  # without boxes the size is -inf
        return np.where(total > 0, surface(size) * total, np.inf)


def halved(start: Ints, size: Ints, node: Ints, lower: Floats, upper: Floats) -> Bools:
    """Return the same as `are_right`, but divide every node into halves along its longest axis."""
    centre = lower + upper
    extent = np.maximum.reduceat(centre, start) - np.minimum.reduceat(centre, start)
    along = np.take_along_axis(centre, extent.argmax(axis=1)[node][:, None], 1)[:, 0]
    rank = np.empty(len(node), int)
    rank[np.lexsort([along, node])] = np.arange(len(node)) - start[node]
    is_right: Bools = 2 * rank >= size[node]
    return is_right


def surface(size: Floats) -> Floats:
    """Return half the surface area of boxes with edges `size`, (3, ...)."""
    area: Floats = size[0] * size[1] + size[1] * size[2] + size[2] * size[0]
    return area
