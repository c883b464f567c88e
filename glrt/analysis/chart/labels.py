"""Places for labels in a picture, so that none covers another or a curve.

Each label has candidates around its curve. Its cost grows with the length of the curves below it,
the distance from its curve, and crossings of its leader. The solver lets one label after the other
take the cheapest candidate, given the others, until none moves. It begins with each label once, and
keeps the cheapest result: the same places every time.
Lengths are in pixels; y grows upwards.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GAPS = (9.0, 20.0, 36.0, 58.0, 84.0)  # from a curve to its label
LED = 15.0  # a label further away has a leader
MARGIN = 2.0  # around each label
EDGE = 4.0  # from a label to the frame
STEP = 3.0  # between the points by which curves are found below labels
ANCHORS = 16  # places along a curve
SWEEPS = 50
_OVERLAP, _CROSSED, _COVERED, _NEAR = 1e6, 250.0, 12.0, 2.0  # costs: last two for each point
_FAR, _BACK = 0.6, 90.0  # for a pixel of distance, and for the start of a curve
_DIRECTIONS = ((1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1), (-1, 0))


class Candidates(NamedTuple):
    """Places of one label, their leaders, and what each costs without other labels."""

    boxes: Array  # (K, 4): left, bottom, right, top
    leaders: Array  # (K, 2, 2): from the curve to the box; of no length where there is none
    costs: Array  # (K,)


class Place(NamedTuple):
    """The place of a label, and the ends of its leader; None where it has none."""

    box: tuple[float, float, float, float]  # left, bottom, right, top
    leader: tuple[tuple[float, float], tuple[float, float]] | None


def around(
    number: int, curves: Sequence[Array], size: tuple[float, float], frame: tuple[float, float]
) -> Candidates:
    """Candidates of a label of `size` around one of the curves, (N, 2) each, best at its end.

    A label above or below its curve is moved aside where it would leave the frame.
    """
    path = curves[number]
    shares = np.linspace(0.0, 1.0, ANCHORS)
    anchors = _along(path, shares)
    shape = (ANCHORS, len(GAPS), len(_DIRECTIONS), 2)
    ways = np.array(_DIRECTIONS, np.float64)
    gaps = np.array(GAPS)[:, None, None]
    diagonal = np.where((ways != 0).all(axis=1), np.sqrt(0.5), 1.0)[:, None]
    starts = np.broadcast_to(anchors[:, None, None], shape).reshape(-1, 2)
    offsets = np.broadcast_to(gaps * ways * diagonal, shape).reshape(-1, 2)
    sides = np.broadcast_to(ways, shape).reshape(-1, 2)
    ends = starts + offsets
    low = ends + (sides - 1) / 2 * np.array(size)
    inside = np.clip(low[:, 0], EDGE, max(EDGE, frame[0] - EDGE - size[0]))
    low[:, 0] = np.where(sides[:, 1] == 0, low[:, 0], inside)
    boxes = np.concatenate([low, low + np.array(size)], axis=1)
    length = np.hypot(*offsets.T)
    leaders = np.stack([starts, np.where(length[:, None] > LED, ends, starts)], axis=1)
    others = [curve for place, curve in enumerate(curves) if place != number]
    back = np.repeat(1 - shares, len(GAPS) * len(_DIRECTIONS))
    costs = _FAR * length + _BACK * back + _COVERED * _inside(boxes, curves, MARGIN)
    costs += _NEAR * _inside(boxes, others, 5 * MARGIN)
    for other in others:
        costs += _CROSSED * _crossings(leaders, np.stack([other[:-1], other[1:]], axis=1))
    return Candidates(boxes, leaders, costs)


def above(
    line: float, curves: Sequence[Array], size: tuple[float, float], frame: tuple[float, float]
) -> Candidates:
    """Candidates of a label above a horizontal line, best at the right."""
    width, height = size
    last = max(EDGE, frame[0] - EDGE - width)
    left = np.arange(last, EDGE - 1e-9, -STEP)
    bottom = np.full_like(left, line + MARGIN)
    boxes = np.stack([left, bottom, left + width, bottom + height], axis=1)
    leaders = np.repeat(boxes[:, None, :2], 2, axis=1)
    costs = 0.05 * (last - left) + _COVERED * _inside(boxes, curves, MARGIN)
    return Candidates(boxes, leaders, costs)


def solve(labels: Sequence[Candidates], frame: tuple[float, float]) -> list[Place]:
    """A place for each label in a frame of a width and height: the cheapest of several attempts.

    The attempts begin with other labels, since the first to choose have the most room.
    """
    own = [each.costs + _outside(each.boxes, frame) for each in labels]
    count = len(labels)
    orders = [[(first + n) % count for n in range(count)] for first in range(count)]
    attempts = [_settled(labels, own, order) for order in orders]
    _, best = min(attempts, key=lambda attempt: attempt[0])
    return [_place(each, best[number]) for number, each in enumerate(labels)]


def _settled(
    labels: Sequence[Candidates], own: Sequence[Array], order: Sequence[int]
) -> tuple[float, dict[int, int]]:
    """The cost of all places in the end, and the candidate of each label."""
    chosen: dict[int, int] = {}
    total = 0.0
    for _ in range(SWEEPS):
        before, total = dict(chosen), 0.0
        for number in order:
            others = [other for other in chosen if other != number]
            cost = own[number].copy()
            for other in others:
                cost += _conflicts(labels[number], labels[other], chosen[other])
            chosen[number] = int(np.argmin(cost))
            total += float(cost[chosen[number]])
        if chosen == before:
            break
    return total, chosen


def _place(label: Candidates, chosen: int) -> Place:
    left, bottom, right, top = map(float, label.boxes[chosen])
    (x0, y0), (x1, y1) = label.leaders[chosen].tolist()
    leader = None if (x0, y0) == (x1, y1) else ((x0, y0), (x1, y1))
    return Place((left, bottom, right, top), leader)


def _along(path: Array, shares: Array) -> Array:
    """Points at shares of the length of a path, (S, 2)."""
    steps = np.hypot(*np.diff(path, axis=0).T)
    at = np.concatenate([[0.0], np.cumsum(steps)])
    return np.stack([np.interp(shares * at[-1], at, path[:, axis]) for axis in (0, 1)], axis=1)


def _inside(boxes: Array, curves: Sequence[Array], margin: float) -> Array:
    """How many points of the curves, STEP apart, each box covers with a margin; (K,)."""
    found = np.zeros(len(boxes))
    for path in curves:
        length = np.hypot(*np.diff(path, axis=0).T).sum()
        x, y = _along(path, np.linspace(0.0, 1.0, max(2, int(length / STEP)))).T
        left, bottom, right, top = boxes.T[:, :, None]
        within_x = (x > left - margin) & (x < right + margin)
        found += (within_x & (y > bottom - margin) & (y < top + margin)).sum(axis=1)
    return found


def _outside(boxes: Array, frame: tuple[float, float]) -> Array:
    """A cost that grows with the pixels by which each box leaves the frame; (K,)."""
    low = np.maximum(EDGE - boxes[:, :2], 0).sum(axis=1)
    high = np.maximum(boxes[:, 2:] + EDGE - np.array(frame), 0).sum(axis=1)
    return np.where(low + high > 0, _OVERLAP * (1 + low + high), 0.0)


def _conflicts(label: Candidates, other: Candidates, chosen: int) -> Array:
    """The cost of each candidate of a label, given another label at its place; (K,)."""
    left, bottom, right, top = other.boxes[chosen]
    boxes = label.boxes
    apart = (boxes[:, 0] > right + MARGIN) | (boxes[:, 2] < left - MARGIN)
    apart |= (boxes[:, 1] > top + MARGIN) | (boxes[:, 3] < bottom - MARGIN)
    cost = np.where(apart, 0.0, _OVERLAP)
    led = other.leaders[chosen][None]
    cost += _CROSSED * _crossings(label.leaders, led)
    cost += _CROSSED * sum(_crossings(edges, led) for edges in _diagonals(boxes))
    return cost + _CROSSED * sum(
        _crossings(label.leaders, edge) for edge in _diagonals(other.boxes[chosen][None])
    )


def _diagonals(boxes: Array) -> tuple[Array, Array]:
    """The two diagonals of each box, (K, 2, 2): a line through a box crosses one of them."""
    left, bottom, right, top = boxes.T
    rising = np.stack([np.stack([left, bottom], 1), np.stack([right, top], 1)], axis=1)
    falling = np.stack([np.stack([left, top], 1), np.stack([right, bottom], 1)], axis=1)
    return rising, falling


def _crossings(lines: Array, others: Array) -> Array:
    """How many of the other lines, (M, 2, 2), each of the lines, (K, 2, 2), crosses; (K,)."""
    a, b = lines[:, None, 0], lines[:, None, 1]
    c, d = others[None, :, 0], others[None, :, 1]

    def side(p: Array, q: Array, r: Array) -> Array:
        u, v = q - p, r - p
        turned: Array = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
        return turned

    between = side(a, b, c) * side(a, b, d) < 0
    crossed = between & (side(c, d, a) * side(c, d, b) < 0)
    return np.asarray(crossed.sum(axis=1), np.float64)
