"""Shader text: files and what they include, behind a prelude of constants.

This is the one way in which a shader comes together; docs/explanation/kernel.md explains it. A file
is read once: what is rendered does not change while somebody edits a shader. `files_anew` is for
those who ask for that.
"""

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from itertools import count
from pathlib import Path
from typing import NamedTuple

from glrt.core.errors import RenderError
from glrt.core.resources import folder

_INCLUDE = re.compile(r'\s*#include\s+"([^"]+)"')
# Mesa, AMD, Apple: "0:17(4): error"; NVIDIA: "0(17) : error"; glslang: "ERROR: 0:17:".
_LOCATION = re.compile(r"\b0[:(](\d+)(?:\(\d+\)|\))?(?: ?:)?")
_texts: dict[Path, str] = {}  # of files that have been read
_editions = count(1)
_edition = [0]  # the one that is read


class Line(NamedTuple):
    """A line of kernel source and the `file:number` it comes from."""

    text: str
    origin: str


class Source:
    """The text of a shader: its version, a constant for each feature, and the files.

    A comment names the file wherever it changes.
    """

    def __init__(
        self,
        entry: str,
        constants: Mapping[str, bool | int] | None = None,
        version: str = "430 core",
        texts: Mapping[str, str] | None = None,
    ) -> None:
        """Of `entry` and what it includes: from `texts`, by name, or from the shader folder.

        Files are read when the text is first needed. Sources of one `key` have one text.
        """
        head = [f"#version {version}", *map(_declare, (constants or {}).items())]
        self._head, self._entry, self._texts = head, entry, texts or {}
        self.key = (entry, version, *(constants or {}).items(), *self._texts.items(), _edition[0])

    @cached_property
    def lines(self) -> list[Line]:
        """The lines, each with its origin. RenderError if a file is not there."""
        lines = [Line(line, "prelude") for line in self._head]
        for line in _Files(self._texts).expand(self._entry, "the kernel"):
            if _file(line.origin) != _file(lines[-1].origin):
                lines.append(Line(f"// {line.origin}", line.origin))
            lines.append(line)
        return lines

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
    return _text_of(folder("shaders_glsl") / name)


def expanded(name: str) -> str:
    """The text of a shader file with those that it includes."""
    return "\n".join(line.text for line in _Files({}).expand(name, name)) + "\n"


def shader_files() -> list[Path]:
    """Every shader file, sorted."""
    return sorted(path for path in folder("shaders_glsl").rglob("*") if path.is_file())


@contextmanager
def files_reread() -> Iterator[None]:
    """Inside, files are read as they are now; should an error leave it, the texts before stay."""
    before, edition = dict(_texts), _edition[0]
    _texts.clear()
    _edition[0] = next(_editions)
    try:
        yield
    except BaseException:
        _texts.clear()
        _texts.update(before)
        _edition[0] = edition
        raise


def _text_of(path: Path) -> str:
    if path not in _texts:
        _texts[path] = path.read_text("utf-8", errors="replace")
    return _texts[path]


def _file(origin: str) -> str:
    return origin.rpartition(":")[0]


def _declare(constant: tuple[str, bool | int]) -> str:
    name, value = constant
    if isinstance(value, bool):
        return f"const bool {name} = {str(value).lower()};"
    return f"const int {name} = {value};"


class _Files:
    """Shader files, each included once."""

    def __init__(self, texts: Mapping[str, str]) -> None:
        self._texts = texts
        self._seen: set[str] = set()

    def expand(self, name: str, wanted_by: str) -> list[Line]:
        """The lines of a file with those of the files it includes, where they are first named."""
        if name in self._seen:
            return []
        self._seen.add(name)
        lines: list[Line] = []
        for number, line in enumerate(self._text(name, wanted_by).splitlines(), start=1):
            origin = f"{name}:{number}"
            match = _INCLUDE.match(line)
            lines += self.expand(match[1], origin) if match else [Line(line, origin)]
        return lines

    def _text(self, name: str, wanted_by: str) -> str:
        if name in self._texts:
            return self._texts[name]
        try:
            return read(name)
        except OSError as error:
            problem = error.strerror or "cannot be read"
            raise RenderError(f"{wanted_by}: the shader file '{name}': {problem}") from error
