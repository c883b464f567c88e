"""Grids that a scene names: the path of a file, its SHA-256, and its voxels once it is read."""

import hashlib
from collections.abc import Callable
from io import BytesIO
from pathlib import Path, PurePosixPath
from typing import Annotated, Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, PlainSerializer, PrivateAttr, WithJsonSchema

from glrt.core.errors import ContentError
from glrt.scene.files.named_files import PATH_SCHEMA, NamedFile, by_path, to_path
from glrt.scene.files.nvdb_grids import SUFFIX as NANO_VDB
from glrt.scene.files.nvdb_grids import decode_nvdb
from glrt.scene.files.vdb_grids import SUFFIX as OPEN_VDB
from glrt.scene.files.vdb_grids import decode_vdb
from glrt.scene.values import Name

BRICK = 8  # voxels along an edge of a brick: shaders_glsl/media/grid.glsl
MOST_VOXELS = 1 << 25  # of a grid: 8 bytes each on the driver
_DECODERS = {OPEN_VDB: decode_vdb, NANO_VDB: decode_nvdb}
SUFFIXES = (".npy", *_DECODERS)  # of files of densities
_DTYPES = ("float16", "float32")
_DIMENSIONS = 3

Voxels = NDArray[np.float16]


class GridFile(NamedFile):
    """A grid of densities from a file, or from an array under the name of the file it is saved as.

    Voxels are divided by the largest one, so that half floats keep 11 bits of each.
    """

    grid: Name | None = Field(None, description="name of a grid of an OpenVDB or NanoVDB file")

    _voxels: Voxels | None = PrivateAttr(None)
    _tops: Voxels = PrivateAttr(np.zeros((0, 0, 0), np.float16))
    _bottoms: Voxels = PrivateAttr(np.zeros((0, 0, 0), np.float16))
    _most: float = PrivateAttr(0.0)

    @property
    def voxels(self) -> Voxels | None:
        """Densities over `most`, (z, y, x), from 0 to 1; None before the file is read."""
        return self._voxels

    @property
    def tops(self) -> Voxels:
        """The largest density over `most` that each brick of BRICK^3 voxels can have, (z, y, x)."""
        return self._tops

    @property
    def bottoms(self) -> Voxels:
        """The smallest one, likewise."""
        return self._bottoms

    @property
    def most(self) -> float:
        """The largest density."""
        return self._most

    @property
    def is_read(self) -> bool:
        """Whether its voxels are there."""
        return self._voxels is not None

    def __eq__(self, other: object) -> bool:
        return super().__eq__(other) and isinstance(other, GridFile) and self.grid == other.grid

    def __hash__(self) -> int:
        return hash((self.file, self.sha256, self.grid))

    def decode(self, content: bytes) -> NDArray[Any]:
        """Return the array of the content of its file; ContentError if it is no grid."""
        if decoder := _DECODERS.get(PurePosixPath(self.file).suffix.lower()):
            return checked_grid(decoder(content, self.grid, MOST_VOXELS))
        if self.grid is not None:
            raise ContentError(
                "`grid` chooses among the grids of an OpenVDB or NanoVDB file, which ends in "
                f"{' or '.join(_DECODERS)}. Leave it out"
            )
        return decode_grid(content)

    def read_as(self, sha256: str, values: NDArray[Any], origin: Path | None) -> "GridFile":
        """Return the grid with its content, (z, y, x)."""
        found = GridFile(file=self.file, sha256=sha256, grid=self.grid)
        found._most = float(values.max())
        scaled = values.astype(np.float32) / np.float32(found._most or 1.0)
        found._voxels, found._origin = scaled.astype(np.float16), origin
        found._tops = _of_bricks(found._voxels, np.max)
        found._bottoms = _of_bricks(found._voxels, np.min)
        return found


def _of_bricks(voxels: Voxels, choose: Callable[..., Any]) -> Voxels:
    """Return the largest or the smallest densities of bricks.

    A density between voxels depends on the voxels around it, so that of a brick depends on a voxel
    more on each side.
    """
    found = voxels
    for axis in range(_DIMENSIONS):
        size = found.shape[axis]
        parts = [
            choose(found.take(range(max(first - 1, 0), min(first + BRICK + 1, size)), axis), axis)
            for first in range(0, size, BRICK)
        ]
        found = np.stack(parts, axis)
    return found


def grid_of_array(values: Any) -> GridFile:
    """Return a grid of densities, (z, y, x), under the name of the file that it is saved as.

    Raises ValueError, which says what is wrong with the array.
    """
    found = np.asarray(values)
    if found.dtype.kind == "f" and found.dtype.name not in _DTYPES:
        found = found.astype(np.float32)
    checked_grid(found)
    content = BytesIO()
    npy.write_array(content, found, allow_pickle=False)
    sha256 = hashlib.sha256(content.getvalue()).hexdigest()
    grid = GridFile(file=f"grid-{sha256[:12]}.npy").read_as(sha256, found, None)
    grid._content = content.getvalue()
    return grid


def decode_grid(content: bytes) -> NDArray[Any]:
    """Return the array of an .npy file; ValueError, a sentence, if it is no grid of densities."""
    file = BytesIO(content)
    try:
        version = npy.read_magic(file)
        read = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, is_fortran, dtype = read(file)
    except Exception:  # its header is Python's text, whose readers have many kinds of errors
        raise ContentError(
            "this is no .npy file of a grid. Write one by numpy.save, of an array (z, y, x)"
        ) from None
    _check_form(shape, dtype)
    values = content[file.tell() :]
    size = int(np.prod(shape, dtype=np.int64)) * dtype.itemsize
    if len(values) != size:
        raise ContentError(
            f"the file has {len(values):,} bytes of voxels, and its header promises {size:,}. "
            "Write it again"
        )
    flat = np.frombuffer(values, dtype)
    found = flat.reshape(shape, order="F" if is_fortran else "C")
    return checked_grid(found)


def checked_grid(values: NDArray[Any]) -> NDArray[Any]:
    """Return the grid itself; ValueError, a sentence, if its densities cannot be used."""
    _check_form(values.shape, values.dtype)
    if not np.isfinite(values).all():
        place = _first(~np.isfinite(values))
        raise ContentError(f"voxel {place} is not finite. Give each a density of at least 0")
    if (values < 0).any():
        raise ContentError(f"voxel {_first(values < 0)} is below 0. Give each a density from 0 on")
    return values


def _check_form(shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
    if dtype.name not in _DTYPES:
        raise ContentError(
            f"the voxels are of type {dtype.name}, not float16 or float32. Convert them by "
            "numpy's astype"
        )
    if len(shape) != _DIMENSIONS or min(shape) < 1:
        raise ContentError(
            f"the array has the shape {tuple(shape)}, not three sizes (z, y, x) of at least 1. "
            "Reshape it"
        )
    count = 1
    for size in shape:
        count *= int(size)
    if count > MOST_VOXELS:
        raise ContentError(
            f"the grid has {count:,} voxels, and {MOST_VOXELS:,} are the most. Scale it down"
        )


def _first(wrong: NDArray[np.bool_]) -> list[int]:
    return [int(index) for index in np.argwhere(wrong)[0]]


# A scene file holds the path alone.
NamedGrid = Annotated[
    GridFile,
    BeforeValidator(by_path(GridFile)),
    PlainSerializer(to_path, return_type=str),
    WithJsonSchema(PATH_SCHEMA),
]
