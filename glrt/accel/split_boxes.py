"""Boxes around pairs of triangles; mostly empty boxes are cut before the BVH is built.

After "Early Split Clipping for Bounding Volume Hierarchies" (Ernst and Greiner 2007): a pair then
lies in several leaves, which changes no hit.
"""

from typing import NamedTuple

import numpy as np

from glrt.accel.binned_splits import Floats, Ints, surface
from glrt.core.threads import concurrently

PORTION = 1 << 16  # pairs that are processed together, so that memory is bounded
MOST_MORE = 0.2  # boxes that may be added, as a share of the pairs
_ROUNDS = 12
_LEAST_WASTE = 8.0  # least waste of a box that is cut, in surfaces of the median box


class Boxes(NamedTuple):
    """Axis-aligned boxes around parts of pairs."""

    lower: Floats  # (k, 3)
    upper: Floats
    pair: Ints  # (k,): the pair of each box


def boxes_of(corners: Floats) -> Boxes:
    """Return boxes around pairs with the corners a b c d, (m, 4, 3): triangles a b c and a c d."""
    portions = np.array_split(corners, -(-len(corners) // PORTION))
    flat = np.concatenate(concurrently(_shadows, portions))
    low, high = corners.min(axis=1), corners.max(axis=1)
    boxes = Boxes(low, high, np.arange(len(corners)))
    least = _LEAST_WASTE * float(np.median(surface((high - low).T)))
    room = int(len(corners) * MOST_MORE)
    for rounds in range(_ROUNDS, 0, -1):
        waste = surface((boxes.upper - boxes.lower).T) - flat
        many = min(room // rounds, len(waste) - 1)
        if many < 1:
            break
        pick = np.argpartition(-waste, many)[:many]
        pick = np.sort(pick[waste[pick] > least])
        before = len(boxes.pair)
        boxes, cut = _cut(boxes, pick, corners)
        flat[cut] /= 2
        flat = np.concatenate([flat, flat[cut]])
        room -= len(boxes.pair) - before
    return boxes


def _triangles(corners: Floats) -> Floats:
    """Return the two triangles of each pair, (m, 2, 3, 3)."""
    both: Floats = corners[:, [[0, 1, 2], [0, 2, 3]]]
    return both


def _shadows(corners: Floats) -> Floats:
    """Return the areas of both triangles projected along the axes, summed, (m,).

    This is half the surface of a box without any waste.
    """
    triangles = _triangles(corners)
    edges = triangles[:, :, 1:] - triangles[:, :, :1]
    flat: Floats = np.abs(np.cross(edges[:, :, 0], edges[:, :, 1])).sum(axis=(1, 2)) / 2
    return flat


def _cut(boxes: Boxes, pick: Ints, corners: Floats) -> tuple[Boxes, Ints]:
    """Cut boxes of `pick` in the middle of their longest edge; return all, and which were cut."""
    low, high = boxes.lower[pick], boxes.upper[pick]
    axis, row = (high - low).argmax(axis=1), np.arange(len(pick))
    start, end = low[row, axis], high[row, axis]
    middle = start + (end - start) / 2
    parts = _triangles(corners[boxes.pair[pick]])
    halves = [_clipped(parts, axis, *ends) for ends in ((start, middle), (middle, end))]
    halves = [(np.maximum(a, low), np.minimum(b, high)) for a, b in halves]
    is_cut = np.all([(a <= b).all(axis=1) for a, b in halves], axis=0)
    cut = pick[is_cut]
    (near_low, near_high), (far_low, far_high) = ((a[is_cut], b[is_cut]) for a, b in halves)
    lower, upper = boxes.lower.copy(), boxes.upper.copy()
    lower[cut], upper[cut] = near_low, near_high
    return Boxes(
        np.concatenate([lower, far_low]),
        np.concatenate([upper, far_high]),
        np.concatenate([boxes.pair, boxes.pair[cut]]),
    ), cut


def _clipped(triangles: Floats, axis: Ints, start: Floats, end: Floats) -> tuple[Floats, Floats]:
    """Return the bounds of triangles, (m, 2, 3, 3), clipped between two planes across an axis each.

    Where nothing is left, the low bound is inf and the high one -inf.
    """
    row = np.arange(len(triangles))
    low, high = np.full((len(triangles), 3), np.inf), np.full((len(triangles), 3), -np.inf)
    for which in range(2):
        for number in range(3):
            p, q = triangles[:, which, number], triangles[:, which, (number + 1) % 3]
            from_, to = p[row, axis], q[row, axis]
            points = [(p, (from_ >= start) & (from_ <= end))]
            for plane in (start, end):
                crosses = (from_ < plane) != (to < plane)
                share = np.where(crosses, (plane - from_) / np.where(crosses, to - from_, 1), 0)
                point = p + share[:, None] * (q - p)
                point[row, axis] = plane
                points.append((point, crosses))
            for point, is_there in points:
                low = np.where(is_there[:, None], np.minimum(low, point), low)
                high = np.where(is_there[:, None], np.maximum(high, point), high)
    return low, high
