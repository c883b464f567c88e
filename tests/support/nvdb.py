"""NanoVDB files of float grids, as nanovdb/NanoVDB.h lays them out in version 32.7.

Grids lie within the first 128 voxels of each axis: one upper and one lower node hold all leaves.
"""

import struct
import zlib
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]

VERSION = 32 << 21 | 7 << 10
FLOAT = 1
NOT_PACKED, ZIP, BLOSC = range(3)
HEAD, TREE, ROOT, TILE, UPPER, LOWER, LEAF = 672, 64, 64, 32, 270400, 33856, 2144


def nvdb_file(grids: Mapping[str, Array], codec: int = NOT_PACKED, kind: int = FLOAT) -> bytes:
    """Return the content of a file of grids, (z, y, x), whose voxels are active where not 0."""
    about, stored = b"", b""
    for name, values in grids.items():
        data = _grid(values)
        packed = zlib.compress(data) if codec == ZIP else data
        content = struct.pack("<Q", len(packed)) + packed if codec == ZIP else packed
        text = name.encode() + b"\0"
        about += struct.pack("<4Q2I", len(data), len(content), 0, 0, kind, 2)
        about += bytes(6 * 8 + 6 * 4 + 3 * 8)  # boxes, and the size of a voxel
        about += struct.pack("<I7I2HI", len(text), *[0] * 7, codec, 0, VERSION) + text
        stored += content
    return struct.pack("<8sIHH", b"NanoVDB0", VERSION, len(grids), codec) + about + stored


def _grid(values: Array) -> bytes:
    room = np.zeros((128, 128, 128), np.float32)  # (x, y, z), as leaves count their voxels
    z, y, x = values.shape
    room[:x, :y, :z] = values.transpose(2, 1, 0)
    leaves = room.reshape(16, 8, 16, 8, 16, 8).transpose(0, 2, 4, 1, 3, 5).reshape(4096, 512)
    used = np.flatnonzero(leaves.any(axis=1))
    rows = [_leaf(int(number), leaves[number]) for number in used]
    upper = ROOT + TILE
    places = upper + UPPER + LOWER, upper + UPPER, upper, 0
    tree = struct.pack("<4q3I3IQ", *(TREE + place for place in places), len(rows), 1, 1, 0, 0, 0, 0)
    root = bytes(24) + struct.pack("<I", 1) + bytes(36)
    root += struct.pack("<QqIf", 0, ROOT + TILE, 0, 0.0) + bytes(8)
    return bytes(HEAD) + tree + root + bytes(UPPER + LOWER) + b"".join(rows)


def _leaf(number: int, values: Array) -> bytes:
    """A leaf: it states where its active voxels begin."""
    active = values != 0
    lowest = np.argwhere(active.reshape(8, 8, 8)).min(axis=0) if active.any() else np.zeros(3, int)
    corner = 8 * np.array([number // 256, number // 16 % 16, number % 16]) + lowest
    bits: bytes = np.packbits(active, bitorder="little").tobytes()
    head = struct.pack("<3i4x", *map(int, corner)) + bits + bytes(16)  # and four statistics
    return head + values.astype("<f4").tobytes()
