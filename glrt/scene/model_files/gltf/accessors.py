"""Read arrays of a glTF file: accessors, sparse ones too."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import ContentError
from glrt.scene.model_files.gltf.document import Document, whole

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST = 12_000_000  # elements of an accessor: three for each triangle of the largest scene
_TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def floats(document: Document, index: Any, sizes: tuple[int, ...], where: str) -> Floats:
    """Return the numbers of an accessor, (n, size); normalized integers become numbers up to 1."""
    rows, accessor = _rows(document, index, where)
    if rows.shape[1] not in sizes:
        raise ContentError(f"accessors[{index}] has {rows.shape[1]} numbers each, as {where}")
    found = rows.astype(np.float64)
    if accessor.get("normalized") is True and rows.dtype.kind in "iu":
        found = np.maximum(found / np.iinfo(rows.dtype).max, -1.0)
    return found


def indices(document: Document, index: Any, where: str) -> Ints:
    """Return the whole numbers of an accessor, (n,)."""
    rows, _ = _rows(document, index, where)
    if rows.shape[1] != 1 or rows.dtype.kind != "u":
        raise ContentError(f"accessors[{index}], {where}, must be of whole numbers without a sign")
    return rows[:, 0].astype(np.int64)


def _rows(document: Document, index: Any, where: str) -> tuple[NDArray[Any], dict[str, Any]]:
    accessor, here = document.item("accessors", index, where), f"accessors[{index}]"
    count = whole(accessor.get("count"), f"{here}.count", least=1)
    if count > MOST:
        raise ContentError(f"{here}.count must be at most {MOST:,}, got {count:,}")
    dtype, size = _kind(accessor, here)
    if "bufferView" in accessor:
        place = accessor["bufferView"], accessor.get("byteOffset", 0)
        rows = _strided(document, place, dtype, size, count, here)
    else:
        rows = np.zeros((count, size), dtype)
    if "sparse" in accessor:
        sparse = document.table(accessor["sparse"], f"{here}.sparse")
        rows = _replaced(document, rows, sparse, f"{here}.sparse")
    return rows, accessor


def _kind(accessor: dict[str, Any], here: str) -> tuple[np.dtype[Any], int]:
    component, kind = accessor.get("componentType"), accessor.get("type")
    if type(component) is not int or component not in _TYPES:
        raise ContentError(f"{here}.componentType is none of {', '.join(map(str, _TYPES))}")
    if not isinstance(kind, str) or kind not in _SIZES:
        raise ContentError(f"{here}.type is none of {', '.join(_SIZES)}")
    return np.dtype(_TYPES[component]), _SIZES[kind]


def _strided(
    document: Document,
    place: tuple[Any, Any],
    dtype: np.dtype[Any],
    size: int,
    count: int,
    here: str,
) -> NDArray[Any]:
    """Return rows from a view, (count, size); there may be something between them."""
    content, stride = document.view(place[0], here)
    offset, width = whole(place[1], f"{here}.byteOffset"), dtype.itemsize * size
    step = stride or width
    if step < width:
        raise ContentError(
            f"{here} has rows of {width} bytes, and its view a byteStride of {stride}"
        )
    if offset + step * (count - 1) + width > len(content):
        raise ContentError(f"{here} ends after its view, which has {len(content):,} bytes")
    shape, strides = (count, size), (step, dtype.itemsize)
    return np.ndarray(shape, dtype, content, offset, strides)


def _replaced(
    document: Document, rows: NDArray[Any], sparse: dict[str, Any], here: str
) -> NDArray[Any]:
    """Return the rows with some replaced, as a sparse accessor says."""
    count = whole(sparse.get("count"), f"{here}.count", least=1)
    if count > len(rows):
        raise ContentError(f"{here}.count must be at most {len(rows):,}, got {count:,}")
    parts = {name: document.table(sparse.get(name), f"{here}.{name}") for name in _PARTS}
    at, by = (
        (part.get("bufferView"), part.get("byteOffset", 0)) for part in (parts[n] for n in _PARTS)
    )
    dtype, _ = _kind({**parts["indices"], "type": "SCALAR"}, f"{here}.indices")
    if dtype.kind != "u":
        raise ContentError(f"{here}.indices must be of whole numbers without a sign")
    numbers = _strided(document, at, dtype, 1, count, f"{here}.indices")[:, 0].astype(np.int64)
    if numbers.max() >= len(rows):
        raise ContentError(f"{here}.indices names row {numbers.max()}, of {len(rows):,} from 0")
    found = rows.copy()
    found[numbers] = _strided(document, by, rows.dtype, rows.shape[1], count, f"{here}.values")
    return found


_PARTS = ("indices", "values")
