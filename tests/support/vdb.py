"""OpenVDB files of float grids, as small as the format allows: one tree 5_4_3, not compressed.

The layout is that of file version 224 of OpenVDB 10 (openvdb/io, openvdb/tree). Grids lie within
the first 128 voxels of each axis.
"""

import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]

MAGIC = 0x56444220
VERSION = 224
ALL_VALUES = b"\x06"  # what comes next is a value for each place, without a mask


def vdb_file(grids: Mapping[str, Array], kind: str = "Tree_float_5_4_3") -> bytes:
    """Return the content of a file of grids, (z, y, x), whose voxels are active where not 0."""
    content = struct.pack("<qIII", MAGIC, VERSION, 10, 0) + b"\x01" + b"0" * 36
    content += struct.pack("<II", 0, len(grids))  # no metadata
    for name, values in grids.items():
        head = content + _text(name) + _text(kind) + _text("")
        tree, blocks = _tree(values)
        start = len(head) + 24
        grid = struct.pack("<II", 0, 0) + _text("UniformScaleMap")
        grid += struct.pack("<15d", *[1.0] * 12, *[0.5] * 3) + tree
        places = start, start + len(grid), start + len(grid) + len(blocks)
        content = head + struct.pack("<3q", *places) + grid + blocks
    return content


def _text(text: str) -> bytes:
    return struct.pack("<I", len(text.encode())) + text.encode()


def _tree(values: Array) -> tuple[bytes, bytes]:
    """Return the topology of a tree, and the voxels of its leaves, 8 along each edge."""
    room = np.zeros((128, 128, 128), np.float32)  # (x, y, z), as leaves count their voxels
    z, y, x = values.shape
    room[:x, :y, :z] = values.transpose(2, 1, 0)
    leaves = room.reshape(16, 8, 16, 8, 16, 8).transpose(0, 2, 4, 1, 3, 5).reshape(4096, 512)
    used = leaves.any(axis=1)
    topology = struct.pack("<IfII3i", 1, 0.0, 0, 1, 0, 0, 0)  # no tiles, and one node from 0 on
    first = np.zeros(32768, bool)
    first[0] = True
    topology += _bits(first) + bytes(4096) + ALL_VALUES + bytes(4 * 32768)
    topology += _bits(used) + bytes(512) + ALL_VALUES + bytes(4 * 4096)
    masks = [_bits(leaf.astype(bool)) for leaf in leaves[used]]
    blocks = [
        mask + ALL_VALUES + leaf.tobytes() for mask, leaf in zip(masks, leaves[used], strict=True)
    ]
    return topology + b"".join(masks), b"".join(blocks)


def _bits(flags: Any) -> bytes:
    return np.packbits(flags, bitorder="little").tobytes()
