"""Grids of OpenVDB files, read by tinyvdb, an extra."""

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import ContentError
from glrt.core.install import install
from glrt.core.text import quoted, unknown

SUFFIX = ".vdb"
_FLOATS = ("Tree_float_5_4_3", "Tree_float_5_4_3_HalfFloat")
_HEADER = struct.Struct("<qIII?36x")  # magic, version, two of the library, places, identifier
_PLACES = struct.Struct("<3q")  # where a grid begins, its voxels begin, and it ends
_OLDEST = 222
NO_VOXELS = "the grid has no active voxels. Write one that has some"
_DAMAGED = "this is no OpenVDB file that tinyvdb can read, or it is damaged. Write it again"
_TILES = (
    "the grid has tiles, cubes of one density without voxels, which tinyvdb leaves out. Fill them "
    "with voxels, as voxelizeActiveTiles of OpenVDB does, and write it again"
)


def decode_vdb(content: bytes, name: str | None, most: int) -> NDArray[np.float32]:
    """Return the active voxels of a grid, (z, y, x), 0 between them, in the box around them.

    `name` chooses among several grids, and `most` is the largest number of voxels of the box.
    Raises ContentError if there is no such grid, it holds no floats, or tinyvdb is missing.
    """
    try:
        import tinyvdb
    except ImportError:
        raise ContentError(
            "this is an OpenVDB file, and tinyvdb, which reads it, is not installed. Install it "
            f"by: {install('volumes')}"
        ) from None
    try:
        if _end(content) > len(content):
            raise ContentError(_DAMAGED)
        file = tinyvdb.from_bytes(content)
        file.read_grids()
        grids = [file.grid(number) for number in range(file.grid_count)]
        names = [str(grid.name) for grid in grids]
    except Exception:  # its own type, and those of what it calls
        raise ContentError(_DAMAGED) from None
    return _voxels(grids[chosen_grid(names, name)], most)


def _end(content: bytes) -> int:
    """Return where the last grid ends by its descriptor: tinyvdb reads past the end of a file.

    The layout is that of openvdb/io/Archive.cc. 0 for versions before 222, whose header differs.
    """
    at, last = _HEADER.size, 0
    _, version, _, _, has_places = _HEADER.unpack_from(content)
    if version < _OLDEST or not has_places:
        return 0

    def number() -> int:
        nonlocal at
        at += 4
        return int.from_bytes(content[at - 4 : at], "little")

    def skip() -> None:
        nonlocal at
        size = number()
        at += size
        if at > len(content):
            raise ContentError(_DAMAGED)

    for _ in range(3 * min(number(), len(content))):  # name, type and value of metadata
        skip()
    for _ in range(min(number(), len(content))):
        for _ in range(3):  # its name, its type, and the grid that it is an instance of
            skip()
        _, _, last = _PLACES.unpack_from(content, at)
        at = max(at + _PLACES.size, last)
    return last


def chosen_grid(names: list[str], name: str | None) -> int:
    """Return the place of a grid among those of a file; ContentError if it is not there.

    None stands for the only one.
    """
    if not names:
        raise ContentError("the file holds no grid. Write one into it")
    if name is not None and name not in names:
        raise ContentError(unknown("grid", name, names, "The file has"))
    if name is None and len(names) > 1:
        held = ", ".join(map(quoted, names[:10]))
        raise ContentError(f"the file holds {len(names)} grids: {held}. Name one by `grid`")
    return names.index(name) if name is not None else 0


def _voxels(grid: Any, most: int) -> NDArray[np.float32]:
    if grid.type_name not in _FLOATS:
        raise ContentError(
            f"its grid {quoted(str(grid.name))} is of type {quoted(str(grid.type_name))}, not of "
            "floats. Choose another one by `grid`, or write it as floats"
        )
    try:
        tree = grid.tree
        nodes = (tree.node(number) for number in range(tree.num_nodes))
        has_tiles = any(it.type == "internal" and it.active_voxel_count for it in nodes)
        sparse = grid.to_sparse()
        places = np.frombuffer(sparse["coords"], np.int32).reshape(-1, 3).astype(np.int64)
        values = np.frombuffer(sparse["values"], np.float32)
    except Exception:
        raise ContentError(_DAMAGED) from None
    if has_tiles:
        raise ContentError(_TILES)
    if not len(places):
        raise ContentError(NO_VOXELS)
    low = places.min(axis=0)
    size = [int(length) for length in places.max(axis=0) - low + 1]
    check_count(size[0] * size[1] * size[2], most)
    found = np.zeros(size, np.float32)
    found[tuple((places - low).T)] = values
    return np.ascontiguousarray(found.transpose(2, 1, 0))


def check_count(count: int, most: int) -> None:
    """Raise ContentError if a box has too many voxels."""
    if count > most:
        raise ContentError(
            f"the box around its voxels has {count:,}, and {most:,} are the most. Scale it down"
        )
