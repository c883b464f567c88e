"""Find triangles that a mesh has twice, such as a part that was exported under two names."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Words = NDArray[np.uint64]

# Odd 64-bit factors, of the golden ratio and of xxHash: products carry low bits upwards.
_FACTOR, _NEXT = np.uint64(0x9E3779B97F4A7C15), np.uint64(0xC2B2AE3D27D4EB4F)


def repeated(vertices: Floats, faces: Ints, labels: Ints | None) -> NDArray[np.bool_]:
    """Return whether each triangle has the corners of an earlier one, in the same order, (n,).

    Corners are compared by their coordinates, `vertices`, (v, 3), and triangles within one of the
    `labels`, (n,).
    """
    keys = _keys(vertices, faces)
    if labels is not None:
        keys = keys + labels.astype(np.uint64)
    found = np.zeros(len(faces), bool)
    ordered = np.sort(keys)
    if not (ordered[1:] == ordered[:-1]).any():
        return found
    # Equal keys are rare: only their triangles are compared in full.
    rows = np.flatnonzero(np.isin(keys, ordered[1:][ordered[1:] == ordered[:-1]]))
    seen: set[tuple[bytes, int]] = set()
    for row in rows:
        corners = vertices[faces[row]] + 0.0  # without negative zeros
        first = int(np.lexsort(corners.T)[0])
        label = 0 if labels is None else int(labels[row])
        triangle = np.roll(corners, -first, axis=0).tobytes(), label
        found[row] = triangle in seen
        seen.add(triangle)
    return found


def _keys(vertices: Floats, faces: Ints) -> Words:
    """Return keys, (n,), that are equal for triangles of equal corners, whichever comes first."""
    x, y, z = np.ascontiguousarray(vertices + 0.0).view(np.uint64).T
    place = _mixed(_mixed(_mixed(x) + y) + z)
    a, b, c = (place[faces[:, k]] for k in range(3))
    keys: Words = _mixed(a + b * _NEXT) + _mixed(b + c * _NEXT) + _mixed(c + a * _NEXT)
    return keys


def _mixed(words: Words) -> Words:
    mixed: Words = (words ^ (words >> np.uint64(31))) * _FACTOR
    return mixed ^ (mixed >> np.uint64(29))
