"""Kernel source: included files, a prelude of constants, and driver messages led back to files."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from glrt.resources import folder

_INCLUDE = re.compile(r'\s*#include\s+"([^"]+)"')
# Mesa, AMD, Apple: "0:17(4): error"; NVIDIA: "0(17) : error"; glslang: "ERROR: 0:17:".
_LOCATION = re.compile(r"\b0[:(](\d+)(?:\(\d+\)|\))?(?: ?:)?")
_STRUCT = re.compile(r"^struct\s+(\w+)", re.MULTILINE)
_FLOATS = ("float", "vec2", "vec3", "vec4", "mat3")


class Line(NamedTuple):
    """A line of kernel source and the `file:number` it comes from."""

    text: str
    origin: str


class Source:
    """The text of a shader, assembled; every float local is `precise`.

    Then constant folding, inlining and another entry point change no bit of what it computes:
    the driver may neither fuse nor reorder its arithmetic.
    """

    def __init__(
        self,
        entry: str,
        constants: Mapping[str, bool | int] | None = None,
        version: str = "430 core",
        text: str | None = None,
    ) -> None:
        """Read `entry` from the shader folder, or take `text` under that name."""
        head = [f"#version {version}", *map(_declare, (constants or {}).items())]
        body = folder("shaders_glsl").joinpath(entry).read_text() if text is None else text
        lines = [Line(line, "prelude") for line in head] + _expand(entry, body, set())
        structs = _STRUCT.findall("\n".join(line.text for line in lines))
        local = re.compile(rf"^(\s+)({'|'.join([*_FLOATS, *structs])})(\s+\w+\s*=)")
        self.lines = [Line(local.sub(r"\1precise \2\3", text), where) for text, where in lines]

    @property
    def text(self) -> str:
        """What the driver compiles."""
        return "\n".join(line.text for line in self.lines) + "\n"

    def explain(self, log: str) -> str:
        """A driver's message with `file:line` in place of positions in the assembled text."""
        return _LOCATION.sub(lambda match: self._origin(int(match[1])), log)

    def _origin(self, number: int) -> str:
        known = 0 < number <= len(self.lines)
        return f"{self.lines[number - 1].origin}:" if known else f"line {number}:"


def read(name: str) -> str:
    """The text of one shader file."""
    return folder("shaders_glsl").joinpath(name).read_text()


def _declare(constant: tuple[str, bool | int]) -> str:
    name, value = constant
    if isinstance(value, bool):
        return f"const bool {name} = {str(value).lower()};"
    return f"const int {name} = {value};"


def _expand(name: str, text: str, seen: set[str]) -> list[Line]:
    if name in seen:
        return []
    seen.add(name)
    lines: list[Line] = []
    for number, line in enumerate(text.splitlines(), start=1):
        if match := _INCLUDE.match(line):
            lines += _include(match[1], f"{name}:{number}", seen)
        else:
            lines.append(Line(line, f"{name}:{number}"))
    return lines


def _include(name: str, origin: str, seen: set[str]) -> list[Line]:
    path: Path = folder("shaders_glsl") / name
    if not path.is_file():
        raise FileNotFoundError(f"{origin}: no shader file '{name}' to include")
    return _expand(name, path.read_text(), seen)
