"""Divide boxes between the children of nodes, for all nodes of a level at once.

Splits minimise the surface area heuristic: surface area times number of boxes, summed over both
sides (Wald, "On Fast Construction of SAH-Based Bounding Volume Hierarchies", 2007). The box centres
of a node are sorted into BINS bins along each axis, and the node is split between two bins. The
boxes of a node with FEW or fewer are sorted themselves.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

BINS = 16  # along each axis
FEW = 8  # boxes


def are_right(start: Ints, size: Ints, node: Ints, lower: Floats, upper: Floats) -> Bools:
    """Return whether each box belongs to the right child of its node, (n,).

    The boxes of a node follow each other, `size` boxes from `start` on, (nodes,) each; `node`,
    (n,), is the node of each box. Both children of a node with two or more boxes get at least one.
    A node whose centres coincide is divided into halves.
    """
    is_right: Bools = np.arange(len(node)) > start[node]  # of two boxes, each is a child
    few = np.flatnonzero((size > 2) & (size <= FEW))
    if len(few):
        number = np.arange(FEW)
        is_there = number < size[few, None]
        rows = start[few, None] + np.where(is_there, number, 0)
        is_right[rows[is_there]] = _of_few(is_there, lower[rows], upper[rows])[is_there]
    many = size > FEW
    if many.any():
        kept = np.repeat(many, size)
        size, node = size[many], np.repeat(np.arange(int(many.sum())), size[many])
        is_right[kept] = _of_many(np.cumsum(size) - size, size, node, lower[kept], upper[kept])
    return is_right


def _of_few(is_there: Bools, lower: Floats, upper: Floats) -> Bools:
    """Return whether boxes are right; a row holds the boxes of a node, (nodes, FEW, 3).

    Boxes are sorted along each axis; absent ones come last.
    """
    number, row = is_there.sum(axis=1), np.arange(len(lower))
    low = np.where(is_there[..., None], lower, np.inf).transpose(2, 1, 0)
    high = np.where(is_there[..., None], upper, -np.inf).transpose(2, 1, 0)
    centre = np.where(is_there[..., None], lower + upper, np.inf).transpose(2, 0, 1)
    count = is_there.T.astype(int)
    order = np.argsort(centre, axis=2, kind="stable")  # (3, nodes, FEW)
    along = np.take_along_axis(centre, order, 2)
    costs: Floats = np.empty((3, FEW - 1, len(row)))
    for axis in range(3):
        sorted_ = order[axis].T
        costs[axis] = _costs(count, low[:, sorted_, row], high[:, sorted_, row])
        costs[axis][~(along[axis, :, 1:] > along[axis, :, :-1]).T] = np.inf
    costs = costs.reshape(-1, len(row))
    axis, place = np.divmod(costs.argmin(axis=0), FEW - 1)
    has_split = np.isfinite(costs.min(axis=0))
    place = np.where(has_split, place, (number + 1) // 2 - 1)
    rank = np.empty((len(row), FEW), int)
    np.put_along_axis(rank, order[axis, row], np.arange(FEW)[None], 1)
    is_right: Bools = rank > place[:, None]
    return is_right


def _of_many(start: Ints, size: Ints, node: Ints, lower: Floats, upper: Floats) -> Bools:
    """Return the same as `are_right`, by bins."""
    low, high = np.ascontiguousarray(lower.T), np.ascontiguousarray(upper.T)
    centre = low + high
    least = np.minimum.reduceat(centre, start, axis=1)
    extent = np.maximum.reduceat(centre, start, axis=1) - least
    scale = np.divide(BINS, extent, out=np.zeros_like(extent), where=extent > 0)
    costs: Floats = np.empty((3, BINS - 1, len(size)))
    bins = np.empty(centre.shape, np.int8)
    for axis in range(3):
        along = (centre[axis] - least[axis][node]) * scale[axis][node]
        bins[axis] = np.minimum(along, BINS - 1)
        costs[axis] = _costs(*_filled(len(size), node, bins[axis], low, high))
    costs = costs.reshape(-1, len(size))
    axis, place = np.divmod(costs.argmin(axis=0), BINS - 1)
    has_split = np.isfinite(costs.min(axis=0))
    row = np.arange(len(node))
    in_half = 2 * (row - start[node]) >= size[node]
    is_right: Bools = np.where(has_split[node], bins[axis[node], row] > place[node], in_half)
    return is_right


def _filled(
    nodes: int, node: Ints, bins: NDArray[np.int8], lower: Floats, upper: Floats
) -> tuple[Ints, Floats, Floats]:
    """Return number of boxes, (BINS, nodes), and corners, (3, BINS, nodes), of the bins of nodes.

    `lower` and `upper` are (3, n).
    """
    key = bins * np.int64(nodes) + node
    count = np.bincount(key, minlength=nodes * BINS).reshape(BINS, nodes)
    low, high = np.full((3, BINS * nodes), np.inf), np.full((3, BINS * nodes), -np.inf)
    for axis in range(3):
        np.minimum.at(low[axis], key, lower[axis])
        np.maximum.at(high[axis], key, upper[axis])
    return count, low.reshape(3, BINS, nodes), high.reshape(3, BINS, nodes)


def _costs(count: Ints, low: Floats, high: Floats) -> Floats:
    """Return the heuristic of splits between parts of nodes, (parts - 1, nodes).

    `count` is (parts, nodes), the corners are (3, parts, nodes). Infinite where a side has no box.
    """
    left = _cumulative_costs(count, low, high)[:-1]
    right = _cumulative_costs(count[::-1], low[:, ::-1], high[:, ::-1])[-2::-1]
    cost: Floats = left + right
    return cost


def _cumulative_costs(count: Ints, low: Floats, high: Floats) -> Floats:
    """Return surface area times number of boxes of parts 0 to k, for each k; inf without boxes."""
    total = np.zeros(count.shape[1], int)
    least, most = np.full(low[:, 0].shape, np.inf), np.full(low[:, 0].shape, -np.inf)
    costs = np.empty(count.shape)
    with np.errstate(invalid="ignore"):  # without boxes the size is -inf
        for part in range(len(count)):
            total += count[part]
            np.minimum(least, low[:, part], out=least)
            np.maximum(most, high[:, part], out=most)
            costs[part] = np.where(total > 0, surface(most - least) * total, np.inf)
    return costs


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
