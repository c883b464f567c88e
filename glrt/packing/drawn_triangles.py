"""The triangles of a scene in the order in which a rasteriser draws them.

A ray sees the one with the lower number of two surfaces at the same distance. A depth buffer keeps
the one that was drawn first.
"""

from typing import Any

import numpy as np

from glrt.accel.wide_tree import LEAF, LINK_BITS, SLOT
from glrt.packing.kernel_structs import CONSTANTS

Array = np.ndarray[Any, Any]

_LINK = (1 << LINK_BITS) - 1


def drawn_triangles(slots: Array, shared: int) -> Array:
    """Return where each triangle lies, (n, 2) int32: twice its slot plus its place, its instance.

    `slots` are rows of the struct Slot; the first `shared` of them are the BVH of the scene, and
    the rest are those of meshes. The instance is 0 for triangles in the BVH of the scene.
    """
    words = slots.view(np.uint32).reshape(-1, SLOT)
    link = words[:, SLOT - 1]
    kind = np.where(link >= LEAF, link >> LINK_BITS & 15, CONSTANTS["TRIANGLES"] + 1)
    leaves = np.flatnonzero(kind == CONSTANTS["TRIANGLES"])
    placed = np.flatnonzero(kind[:shared] == CONSTANTS["INSTANCE"])
    starts = np.unique(words[placed, 12])
    ends = dict(zip(starts.tolist(), [*starts.tolist(), len(words)][1:], strict=True))
    found = [_rows(words, leaves[leaves < shared], 0)]
    for place in placed:
        first = int(words[place, 12])
        own = leaves[(leaves >= first) & (leaves < ends[first])]
        found.append(_rows(words, own, int(link[place]) & _LINK))
    rows = np.concatenate(found)
    order = np.lexsort((rows[:, 0], rows[:, 1]))
    return np.ascontiguousarray(rows[order, 1:][:, [1, 0]].astype(np.int32))


def _rows(words: Array, leaves: Array, instance: int) -> Array:
    """Return number, instance and place of the triangles in some leaves, (n, 3) int64."""
    pairs = words[leaves, 12:14].astype(np.int64)
    places = 2 * leaves[:, None] + np.arange(2)
    of = np.full(pairs.shape, instance)
    rows = np.stack([pairs, of, places], axis=-1).reshape(-1, 3)
    is_whole = np.ones(pairs.shape, bool)
    is_whole[:, 1] = pairs[:, 0] != pairs[:, 1]  # a single triangle stands twice, once empty
    result: Array = rows[is_whole.ravel()]
    return result
