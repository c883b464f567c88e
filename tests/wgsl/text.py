"""The WGSL text: files put together, structs as numpy dtypes, faults planted for tests."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from glrt.layout import read_structs

FOLDER = Path(__file__).parent
PATH = ("exact", "scene", "rng", "warp", "camera", "shape", "material", "path", "film")
_FIELD = re.compile(r"(\w+): (f32|i32|u32|vec[234][fiu])")
_GLSL = {"f32": "float", "i32": "int", "u32": "uint", "f": "", "i": "i", "u": "u"}


def read(name: str) -> str:
    """The text of one file."""
    return (FOLDER / f"{name}.wgsl").read_text()


def raytracer() -> str:
    """The whole compute shader."""
    return with_path(read("raytracer"))


def with_path(entry: str) -> str:
    """An entry point with all that traces a path."""
    return "\n".join([*map(read, PATH), entry])


def planted(text: str, old: str, new: str) -> str:
    """The text with a fault: `old`, which must stand in it once, replaced."""
    if (count := text.count(old)) != 1:
        raise LookupError(f"cannot plant a fault: {count} times in the text: {old}")
    return text.replace(old, new)


def struct(name: str) -> np.dtype[Any]:
    """The layout of a struct, read from the text that the shader is made of."""
    found = re.search(rf"^struct {name} {{.*?^}}", read("scene"), re.DOTALL | re.MULTILINE)
    if not found:
        raise KeyError(name)
    return read_structs(_FIELD.sub(_as_glsl, found[0]).replace(",", ";") + ";")[name]


def _as_glsl(field: re.Match[str]) -> str:
    name, kind = field.groups()
    if kind in _GLSL:
        return f"{_GLSL[kind]} {name}"
    return f"{_GLSL[kind[-1]]}{kind[:-1]} {name}"
