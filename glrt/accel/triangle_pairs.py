"""Pairs of neighbouring triangles, two in a leaf: a round of the loop then tests twice as many.

Each triangle is matched with the neighbour beyond its longest free edge, where both agree: pairs
that share long edges have small boxes.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.accel.binned_splits import Floats, Ints

_Words = NDArray[np.int32]  # half the memory of Ints
_ROUNDS = 12  # rounds of matching; few triangles that could be matched are left then


class Pairs(NamedTuple):
    """Pairs of triangles a b c and a c d; a single triangle has d = a, so the second is empty."""

    corner: Ints  # (m, 4): numbers of vertices
    triangle: Ints  # (m, 2): numbers of triangles; the second of a single one is the first again


class _Shared(NamedTuple):
    """Edges that two triangles share."""

    first: _Words  # (e,): numbers of both triangles
    second: _Words
    start: _Words  # vertices of the edge, in the order of the first triangle
    end: _Words
    apex: _Words  # the third vertex of the first triangle
    other: _Words  # the third vertex of the second


def paired(vertices: Floats, faces: Ints) -> Pairs:
    """Return pairs of the triangles `faces`, (n, 3), which are numbers of `vertices`, (v, 3)."""
    shared = _shared_edges(faces, len(vertices))
    by = _matched(shared, vertices, len(faces))
    corner = np.stack([shared.end[by], shared.apex[by], shared.start[by], shared.other[by]], axis=1)
    triangle = np.stack([shared.first[by], shared.second[by]], axis=1)
    is_single = np.ones(len(faces), bool)
    is_single[triangle] = False
    single = np.flatnonzero(is_single)
    return Pairs(
        np.concatenate([corner, faces[single][:, [0, 1, 2, 0]]]),
        np.concatenate([triangle, np.stack([single, single], axis=1)]),
    )


def _shared_edges(faces: Ints, vertices: int) -> _Shared:
    corners = faces.astype(np.int32)
    start = corners.T.ravel()
    end = np.roll(corners, -1, axis=1).T.ravel()
    key = np.minimum(start, end) * np.int64(vertices) + np.maximum(start, end)
    key, order = _sorted(key)
    same = np.flatnonzero(key[1:] == key[:-1])
    del key
    p, q = order[same], order[same + 1]
    apex = np.roll(corners, -2, axis=1).T.ravel()
    count = np.int32(len(faces))
    return _Shared(p % count, q % count, start[p], end[p], apex[p], apex[q])


def _sorted(key: Ints) -> tuple[Ints, _Words]:
    """Return keys of at least 0 in order, and their numbers before; equal ones keep their order.

    Where a key and its number fit into 63 bits, they are sorted as one: numpy sorts integers some
    six times as fast as it finds the order of them.
    """
    bits = len(key).bit_length()
    if int(key.max(initial=0)).bit_length() + bits > 63:
        order = np.argsort(key, kind="stable")
        return key[order], order.astype(np.int32)
    both = key << bits
    both |= np.arange(len(key))
    both.sort()
    return both >> bits, (both & ((1 << bits) - 1)).astype(np.int32)


def _matched(shared: _Shared, vertices: Floats, triangles: int) -> Ints:
    """Return the numbers of the edges across which triangles are matched."""
    length = np.linalg.norm(vertices[shared.start] - vertices[shared.end], axis=1)
    rank = np.empty(len(length), np.int32)  # no two alike, so that both can agree
    rank[np.argsort(length, kind="stable")] = np.arange(1, len(length) + 1, dtype=np.int32)
    is_free = np.ones(triangles, bool)
    live, chosen = np.arange(len(length), dtype=np.int32), [np.zeros(0, np.int32)]
    for _ in range(_ROUNDS):
        live = live[is_free[shared.first[live]] & is_free[shared.second[live]]]
        if not len(live):
            break
        best = np.zeros(triangles, np.int32)
        np.maximum.at(best, shared.first[live], rank[live])
        np.maximum.at(best, shared.second[live], rank[live])
        agree = rank[live] >= best[shared.first[live]]
        agree &= rank[live] >= best[shared.second[live]]
        chosen.append(live[agree])
        is_free[shared.first[chosen[-1]]] = False
        is_free[shared.second[chosen[-1]]] = False
    return np.concatenate(chosen)
