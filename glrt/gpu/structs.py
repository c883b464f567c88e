"""Read GLSL structs as numpy dtypes, so that shaders and Python share one text of a layout.

Only structs whose std140 and std430 layouts agree are read: rows of four words, no arrays of
scalars, no matrices. So one buffer serves as a uniform block and as a storage block.
"""

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_CONSTANT = re.compile(r"const\s+int\s+(\w+)\s*=\s*(-?\d+)\s*;")
_STRUCT = re.compile(r"struct\s+(\w+)\s*\{(.*?)\}\s*;", re.DOTALL)
_ROW = 16  # bytes: structs are aligned to it in std140


class _Type(NamedTuple):
    dtype: np.dtype[Any]
    uniform: int  # alignment in std140, bytes
    storage: int  # alignment in std430


def read_structs(glsl: str) -> dict[str, np.dtype[Any]]:
    """Map each struct of a GLSL source to the dtype that has its layout.

    Raises KeyError for a type that is not a scalar, a vector or an earlier struct, and for a
    struct that uniform and storage blocks lay out differently.
    """
    types = _basic_types()
    structs: dict[str, np.dtype[Any]] = {}
    for name, body in _STRUCT.findall(_COMMENT.sub("", glsl)):
        types[name] = _struct_type(name, body, types)
        structs[name] = types[name].dtype
    return structs


def read_constants(glsl: str) -> dict[str, int]:
    """Map each integer constant of a GLSL source to its value."""
    return {name: int(value) for name, value in _CONSTANT.findall(_COMMENT.sub("", glsl))}


def record(dtype: np.dtype[Any], values: Mapping[str, object]) -> np.ndarray[Any, Any]:
    """Return one record with every field given by name; KeyError for a missing or unknown name."""
    if unknown := values.keys() - set(dtype.names or ()):
        raise KeyError(f"no field {sorted(unknown)} in a struct of shaders_glsl: {dtype.names}")
    result = np.zeros(1, dtype)
    for name in dtype.names or ():
        field = dtype.fields[name][0] if dtype.fields else dtype
        value = values[name]
        result[name] = record(field, value) if isinstance(value, Mapping) else value
    return result


def _basic_types() -> dict[str, _Type]:
    types = {}
    for scalar, prefix, code in (("float", "", "f4"), ("int", "i", "i4"), ("uint", "u", "u4")):
        types[scalar] = _Type(np.dtype(code), 4, 4)
        for size, alignment in ((2, 8), (3, 16), (4, 16)):
            types[f"{prefix}vec{size}"] = _Type(np.dtype((code, (size,))), alignment, alignment)
    return types


def _struct_type(name: str, body: str, types: dict[str, _Type]) -> _Type:
    declarations = filter(None, map(str.strip, body.split(";")))
    fields = dict(_field(name, declaration, types) for declaration in declarations)
    formats = [kind.dtype for kind in fields.values()]
    storage = max(kind.storage for kind in fields.values())
    offsets = _offsets(formats, [kind.uniform for kind in fields.values()], _ROW)
    if offsets != _offsets(formats, [kind.storage for kind in fields.values()], storage):
        raise KeyError(f"struct {name}: std140 and std430 differ; fill rows of four words")
    *starts, size = offsets
    layout = {"names": list(fields), "formats": formats, "offsets": starts, "itemsize": size}
    return _Type(np.dtype(layout), _ROW, storage)  # type: ignore[call-overload]


def _field(struct: str, declaration: str, types: dict[str, _Type]) -> tuple[str, _Type]:
    match declaration.split():
        case [type_name, field] if type_name in types and field.isidentifier():
            return field, types[type_name]
    raise KeyError(f"struct {struct}: `{declaration}` is not a plain field")


def _offsets(formats: list[np.dtype[Any]], alignments: list[int], whole: int) -> list[int]:
    """Return the start of each field and, last, the size of the struct, a multiple of `whole`."""
    offsets, end = [], 0
    for dtype, alignment in zip(formats, alignments, strict=True):
        offsets.append(_round_up(end, alignment))
        end = offsets[-1] + dtype.itemsize
    return [*offsets, _round_up(end, whole)]


def _round_up(value: int, multiple: int) -> int:
    return -(-value // multiple) * multiple
