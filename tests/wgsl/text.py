"""The WGSL text: files put together, structs as numpy dtypes, faults planted for tests."""

import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from glrt.gpu.structs import read_structs

FOLDER = Path(__file__).parent
PATH = ("exact", "scene", "rng", "warp", "camera", "shape", "material", "path")
RAYTRACER = (*PATH, "film", "raytracer")
SHADER = ("tonemap", "shader")
_FIELD = re.compile(r"(\w+): (f32|i32|u32|vec[234][fiu])")
_GLSL = {"f32": "float", "i32": "int", "u32": "uint", "f": "", "i": "i", "u": "u"}


class Fault(NamedTuple):
    """A fault that a test plants: in this file, this passage replaced."""

    file: str
    passage: str
    replacement: str


def read(name: str, *faults: Fault) -> str:
    """The text of one file, with the faults that are meant for it."""
    text = (FOLDER / f"{name}.wgsl").read_text()
    for fault in faults:
        if fault.file == name:
            text = planted(text, fault.passage, fault.replacement)
    return text


def joined(files: tuple[str, ...], *faults: Fault) -> str:
    """A whole shader: the order of files is free in WGSL.

    A fault meant for a file of another shader is left to that one.
    """
    for fault in faults:
        if fault.file not in (*RAYTRACER, *SHADER):
            raise LookupError(f"cannot plant a fault: no file {fault.file}")
    return "\n".join(read(name, *faults) for name in files)


def planted(text: str, passage: str, replacement: str) -> str:
    """The text with a passage replaced; LookupError unless it stands there once."""
    if (count := text.count(passage)) != 1:
        raise LookupError(f"cannot plant a fault, {count} times in the text: {passage}")
    return text.replace(passage, replacement)


def struct(name: str) -> np.dtype[Any]:
    """The layout of a struct of the scene's buffers, read from the text of the shader."""
    found = re.search(rf"^struct {name} {{.*?^}}", read("scene"), re.DOTALL | re.MULTILINE)
    if not found:
        raise KeyError(name)
    return read_structs(_FIELD.sub(_as_glsl, found[0]).replace(",", ";") + ";")[name]


def _as_glsl(field: re.Match[str]) -> str:
    name, kind = field.groups()
    if kind in _GLSL:
        return f"{_GLSL[kind]} {name}"
    return f"{_GLSL[kind[-1]]}{kind[:-1]} {name}"
