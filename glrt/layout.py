"""GLSL structs -> numpy dtypes: one text of a layout, two readers.

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
    alignment: int


def read_structs(glsl: str) -> dict[str, np.dtype[Any]]:
    """Map each struct of a GLSL source to the dtype that has its layout.

    Raises KeyError for a type that is not a scalar, a vector or an earlier struct.
    """
    types = _basic_types()
    structs: dict[str, np.dtype[Any]] = {}
    for name, body in _STRUCT.findall(_COMMENT.sub("", glsl)):
        types[name] = _Type(_struct_dtype(name, body, types), _ROW)
        structs[name] = types[name].dtype
    return structs


def read_constants(glsl: str) -> dict[str, int]:
    """Map each integer constant of a GLSL source to its value."""
    return {name: int(value) for name, value in _CONSTANT.findall(_COMMENT.sub("", glsl))}


def record(dtype: np.dtype[Any], values: Mapping[str, object]) -> np.ndarray[Any, Any]:
    """One record, every field of it given by name; a missing or foreign name is a KeyError."""
    if unknown := values.keys() - set(dtype.names or ()):
        raise KeyError(f"no field {sorted(unknown)} in {dtype.names}")
    result = np.zeros(1, dtype)
    for name in dtype.names or ():
        field = dtype.fields[name][0] if dtype.fields else dtype
        value = values[name]
        result[name] = record(field, value) if isinstance(value, Mapping) else value
    return result


def _basic_types() -> dict[str, _Type]:
    types = {}
    for scalar, prefix, code in (("float", "", "f4"), ("int", "i", "i4"), ("uint", "u", "u4")):
        types[scalar] = _Type(np.dtype(code), 4)
        for size, alignment in ((2, 8), (3, 16), (4, 16)):
            types[f"{prefix}vec{size}"] = _Type(np.dtype((code, (size,))), alignment)
    return types


def _struct_dtype(name: str, body: str, types: dict[str, _Type]) -> np.dtype[Any]:
    names: list[str] = []
    formats: list[np.dtype[Any]] = []
    offsets: list[int] = []
    end = 0
    for declaration in filter(None, map(str.strip, body.split(";"))):
        match declaration.split():
            case [type_name, field] if type_name in types and field.isidentifier():
                dtype, alignment = types[type_name]
            case _:
                raise KeyError(f"struct {name}: `{declaration}` is not a plain field")
        names.append(field)
        formats.append(dtype)
        offsets.append(_round_up(end, alignment))
        end = offsets[-1] + dtype.itemsize
    layout = {"names": names, "formats": formats, "offsets": offsets}
    return np.dtype({**layout, "itemsize": _round_up(end, _ROW)})  # type: ignore[call-overload,no-any-return]


def _round_up(value: int, multiple: int) -> int:
    return -(-value // multiple) * multiple
