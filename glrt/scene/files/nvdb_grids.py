"""Grids of floats in NanoVDB files of major version 32.

The layout is that of nanovdb/NanoVDB.h and nanovdb/io/IO.h in OpenVDB: a grid holds the nodes of
each level of its tree in one row. Leaves have 8 voxels along an edge, in the order (x, y, z).
"""

import struct
import zlib
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import ContentError
from glrt.core.text import quoted
from glrt.scene.files.vdb_grids import NO_VOXELS, check_count, chosen_grid

SUFFIX = ".nvdb"
_MAGICS = (b"NanoVDB0", b"NanoVDB2")
_MAJOR, _MAJOR_BIT = 32, 21  # of a version number
_SEGMENT = struct.Struct("<8sIHH")  # magic, version, count of grids, codec
_ABOUT = struct.Struct("<4Q2I6d6i3dI4I3IHHI")  # what is known about a grid before its content
_SIZE, _STORED, _TYPE, _NAME = 0, 1, 4, 21  # numbers of its values
_PACKED = struct.Struct("<Q")  # bytes of a grid compressed by zlib, which stand before it
_NOT_PACKED, _ZIP = 0, 1  # codecs; the third is Blosc
_FLOAT = 1
_TYPES = {2: "Double", 9: "Half", 13: "Fp4", 14: "Fp8", 15: "Fp16", 16: "FpN"}

# Bytes within a grid: its head, then its tree, whose places count from the tree.
_TREE = 672
_PLACES, _COUNTS = struct.Struct("<4q"), struct.Struct("<3I")  # leaves, lower, upper nodes, root
_LENGTHS = (2144, 33856, 270400)  # of a leaf, a lower and an upper node
_MASKS = (slice(16, 80), slice(32, 544), slice(32, 4128))  # bits: which values are active
_VALUES = slice(96, 2144)  # of a leaf
_ROOT, _TILE = struct.Struct("<24xI36x"), struct.Struct("<8xqI12x")  # count of tiles; child, state
_EDGE = 8
_ROOM = 5, 1 << 24  # bytes that a grid may take: per voxel of its box, and for upper nodes

_DAMAGED = "this is no NanoVDB file of version 32, or it is damaged. Write it again"
_TILES = (
    "the grid has tiles, cubes of one density without voxels, which are not read. Fill them with "
    "voxels, as voxelizeActiveTiles of OpenVDB does, and convert it again"
)


class _Grid(NamedTuple):
    """A grid as its file stores it."""

    name: str
    kind: int
    codec: int
    size: int  # bytes, unpacked
    stored: bytes


def decode_nvdb(content: bytes, name: str | None, most: int) -> NDArray[np.float32]:
    """Return the active voxels of a grid, (z, y, x), 0 between them, in the box around them.

    `name` chooses among several grids, and `most` is the largest number of voxels of the box.
    Raises ContentError if there is no such grid, or it holds no floats.
    """
    try:
        grids = [*_grids(content)]
        grid = grids[chosen_grid([grid.name for grid in grids], name)]
        if grid.kind != _FLOAT:
            kind = _TYPES.get(grid.kind, f"number {grid.kind}")
            raise ContentError(
                f"its grid {quoted(grid.name)} is of type {kind}, not of floats. Choose another "
                "one by `grid`, or write it as floats"
            )
        return _voxels(*_leaves(_unpacked(grid, most)), most)
    except (struct.error, zlib.error):
        raise ContentError(_DAMAGED) from None


def _grids(content: bytes) -> Iterator[_Grid]:
    at = 0
    while at < len(content):
        magic, version, count, codec = _SEGMENT.unpack_from(content, at)
        if magic not in _MAGICS or version >> _MAJOR_BIT != _MAJOR:
            raise ContentError(_DAMAGED)
        at += _SEGMENT.size
        known = list[tuple[Any, str]]()
        for _ in range(count):
            about = _ABOUT.unpack_from(content, at)
            start, at = at + _ABOUT.size, at + _ABOUT.size + about[_NAME]
            known.append((about, content[start:at].rstrip(b"\0").decode("utf-8", "replace")))
        for about, name in known:
            length = about[_STORED]
            if codec == _ZIP:  # writers do not agree whether the number before it counts
                (length,) = _PACKED.unpack_from(content, at)
                at += _PACKED.size
            start, at = at, at + length
            if at > len(content):
                raise ContentError(_DAMAGED)
            yield _Grid(name, about[_TYPE], codec, about[_SIZE], content[start:at])


def _unpacked(grid: _Grid, most: int) -> bytes:
    room = _ROOM[0] * most + _ROOM[1]
    if grid.size > room:
        raise ContentError(
            f"the grid takes {grid.size:,} bytes, and {room:,} are the most. Scale it down"
        )
    if grid.codec == _NOT_PACKED:
        found = grid.stored
    elif grid.codec == _ZIP:
        found = zlib.decompressobj().decompress(grid.stored, grid.size)
    else:
        raise ContentError(
            "the grid is compressed by Blosc, which is not read. Write it again with zlib, as "
            "nanovdb_convert --zip does, or uncompressed"
        )
    if len(found) != grid.size:
        raise ContentError(_DAMAGED)
    return found


def _leaves(data: bytes) -> tuple[NDArray[np.int64], NDArray[np.bool_], NDArray[np.float32]]:
    """Return lowest corners, (n, 3), active voxels and densities, (n, 8, 8, 8), of all leaves."""
    places = _PLACES.unpack_from(data, _TREE)
    counts = _COUNTS.unpack_from(data, _TREE + _PLACES.size)

    def nodes(level: int) -> NDArray[np.uint8]:
        first, length = _TREE + places[level], counts[level] * _LENGTHS[level]
        if first < _TREE or first + length > len(data):
            raise ContentError(_DAMAGED)
        return np.frombuffer(data, np.uint8, length, first).reshape(-1, _LENGTHS[level])

    root = _TREE + places[3]
    if root < _TREE:
        raise ContentError(_DAMAGED)
    (tiles,) = _ROOT.unpack_from(data, root)
    at_root = (
        _TILE.unpack_from(data, root + _ROOT.size + number * _TILE.size) for number in range(tiles)
    )
    has_tiles = any(state and not child for child, state in at_root)
    if has_tiles or any(nodes(level)[:, _MASKS[level]].any() for level in (1, 2)):
        raise ContentError(_TILES)
    leaves = nodes(0)
    shape = -1, _EDGE, _EDGE, _EDGE
    lowest = np.ascontiguousarray(leaves[:, :12]).view("<i4").astype(np.int64)
    active = np.unpackbits(leaves[:, _MASKS[0]], axis=1, bitorder="little").astype(bool)
    values = np.ascontiguousarray(leaves[:, _VALUES]).view("<f4").reshape(shape)
    # A leaf states where its active voxels begin, which is behind its own corner.
    return lowest & ~(_EDGE - 1), active.reshape(shape), values


def _voxels(
    lowest: NDArray[np.int64], active: NDArray[np.bool_], values: NDArray[np.float32], most: int
) -> NDArray[np.float32]:
    used = active.any(axis=(1, 2, 3))
    if not used.any():
        raise ContentError(NO_VOXELS)
    lowest, active, values = lowest[used], active[used], values[used]
    base = lowest.min(axis=0)
    blocks = [int(size) for size in (lowest.max(axis=0) - base) // _EDGE + 1]
    check_count(_EDGE**3 * blocks[0] * blocks[1] * blocks[2], most)
    found = np.zeros([size for count in blocks for size in (count, _EDGE)], np.float32)
    i, j, k = ((lowest - base) // _EDGE).T
    found[i, :, j, :, k, :] = np.where(active, values, np.float32(0.0))
    box = []
    for axis in range(3):
        others = tuple(1 + other for other in range(3) if other != axis)
        inside = active.any(axis=others)  # (n, 8)
        places = (lowest - base)[:, axis, None] + np.arange(_EDGE)
        box.append(slice(int(places[inside].min()), int(places[inside].max()) + 1))
    full = found.reshape([_EDGE * count for count in blocks])[tuple(box)]
    return np.ascontiguousarray(full.transpose(2, 1, 0))
