"""Pairs of boxes that touch, among many boxes of any sizes."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

MOST_STRIPS = 1 << 10
STRIPS_OF_BOX = 4  # that a box of the mean width lies in, at most
PORTION = 1 << 17  # pairs that are compared at once

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def box_pairs(
    some: tuple[Floats, Floats], others: tuple[Floats, Floats], slack: float
) -> Iterator[tuple[Ints, Ints]]:
    """Yield rows of boxes that touch, (k,) each, in portions.

    `some` and `others` are low and high corners, (n, 3) each. Boxes whose distance is at most
    `slack` times the longest edge of the others touch.

    Boxes are compared along the axis on which `some` spread widest, in strips of the next widest.
    The others are grouped by size, so that a wide one does not make all small ones candidates.
    """
    low, high = others
    if not len(low) or not len(some[0]):
        return
    reach = slack * (high - low).max()
    along, across = np.argsort(-np.ptp(some[0], axis=0), kind="stable")[:2]
    usual = float((some[1] - some[0])[:, across].mean())
    widths = (high - low)[:, [along, across]] + reach
    sizes = np.frexp(widths.max(axis=1))[1] // 2  # powers of 4
    for size in np.unique(sizes):
        members = np.flatnonzero(sizes == size)
        width = widths[members].max(axis=0)
        strips = _Strips(low[members, across], max(width[1], usual / STRIPS_OF_BOX))
        strip = strips.of(low[members, across])
        order = np.lexsort((low[members, along], strip))
        members, strip = members[order], strip[order]
        # A box lies in the strip of its lower edge: others reach it from there to their upper edge.
        first = strips.of(some[0][:, across] - width[1])
        rows = np.repeat(np.arange(len(first)), strips.of(some[1][:, across] + reach) - first + 1)
        of_row = np.arange(len(rows)) - np.searchsorted(rows, rows) + first[rows]
        starts = low[members, along]
        edges = some[0][:, along] - width[0], some[1][:, along] + reach
        begin = _place(strip, starts, of_row, edges[0][rows], is_after=False)
        end = _place(strip, starts, of_row, edges[1][rows], is_after=True)
        for portion in _portions(end - begin):
            count = (end - begin)[portion]
            a = np.repeat(rows[portion], count)
            within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
            b = members[np.repeat(begin[portion], count) + within]
            for axis in range(3):
                touch = some[0][a, axis] <= high[b, axis] + reach
                touch &= low[b, axis] <= some[1][a, axis] + reach
                a, b = a[touch], b[touch]
            yield a, b


class _Strips:
    """Strips of equal width along an axis, by number; the outermost have no end."""

    def __init__(self, edges: Floats, width: float) -> None:
        self._first = float(edges.min())
        spread = float(edges.max()) - self._first
        self._width = max(width, spread / MOST_STRIPS) or 1.0
        self._last = int(spread / self._width)

    def of(self, edges: Floats) -> Ints:
        """Return the strips that hold places on the axis, (n,)."""
        found = np.floor((edges - self._first) / self._width)
        strips: Ints = np.clip(found, 0, self._last).astype(np.int64)
        return strips


def _place(strip: Ints, start: Floats, of: Ints, value: Floats, is_after: bool) -> Ints:
    """Return how many of the sorted pairs (strip, start) come before the pairs (of, value), (n,).

    Equal pairs come before them if `is_after`.
    """
    ranks = np.searchsorted(np.sort(start), value, side="right" if is_after else "left")
    own = np.empty(len(start), np.int64)
    own[np.argsort(start, kind="stable")] = np.arange(len(start))
    every = len(start) + 1
    places: Ints = np.searchsorted(strip * every + own, of * every + ranks)
    return places


def _portions(counts: Ints) -> Iterator[slice]:
    """Yield slices of rows with at most PORTION pairs together, or of one row."""
    first, total = 0, 0
    for row, count in enumerate(counts.tolist()):
        if total and total + count > PORTION:
            yield slice(first, row)
            first, total = row, 0
        total += count
    if total:
        yield slice(first, len(counts))
