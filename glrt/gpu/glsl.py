"""Assemble shader text: a prelude of constants, and a file with all that it includes.

All shaders are assembled here; docs/explanation/kernel.md explains how. A file is read once, so
that a render does not change while somebody edits a shader. `files_reread` reads files again.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import count
from pathlib import Path
from threading import Lock
from typing import NamedTuple

from glrt.core.errors import RenderError
from glrt.core.resources import folder
from glrt.gpu.live_code import live_lines

_INCLUDE = re.compile(r'\s*#include\s+"([^"]+)"')
_FLOATS = r"(?:float|d?vec[234]|d?mat[234](?:x[234])?|[A-Z]\w*)"  # structs are capitalised
_GLOBAL = re.compile(rf"^(?={_FLOATS} \w+ =)")
_LOCAL = re.compile(rf"^\s+(?:for \()?(?={_FLOATS}(?: ?\[\w*\])? \w+ ?[=;,\[])")
_CHANGED = re.compile(rf"(?<!precise )\binout(?= {_FLOATS}\b)")
_NO_FUNCTION = ("struct ", "layout", "uniform ", "buffer ")  # beginnings of other blocks
# Mesa, AMD, Apple: "0:17(4): error"; NVIDIA: "0(17) : error"; glslang: "ERROR: 0:17:".
_LOCATION = re.compile(r"\b0[:(](\d+)(?:\(\d+\)|\))?(?: ?:)?")
_texts: dict[Path, str] = {}  # texts of files that have been read
ASSEMBLED = 8  # shaders whose lines are kept: a kernel has some 7,000, which take 0.2 s
_editions = count(1)
_edition = [0]  # number of the edition that is read
_is_rereading = [False]


class Line(NamedTuple):
    """A line of kernel source and the `file:number` it comes from."""

    text: str
    origin: str


class Code(NamedTuple):
    """Lines of a shader, and the places in files that a driver's messages about them mean."""

    lines: Sequence[Line]

    @property
    def text(self) -> str:
        """The lines as one text."""
        return "\n".join(line.text for line in self.lines) + "\n"

    def explain(self, log: str) -> str:
        """Return a driver's message with `file:line` for positions in the text."""
        return _LOCATION.sub(lambda match: self._origin(int(match[1])), log)

    def _origin(self, number: int) -> str:
        known = 0 < number <= len(self.lines)
        return f"{self.lines[number - 1].origin}:" if known else f"line {number}:"


class Source:
    """The code of a shader: its version, a constant for each feature, and the files.

    A comment names the file wherever it changes. Variables that hold floats become `precise`.
    """

    def __init__(
        self,
        entry: str,
        constants: Mapping[str, bool | int] | None = None,
        version: str = "430 core",
        texts: Mapping[str, str] | None = None,
    ) -> None:
        """Take `entry` and what it includes from `texts`, by name, or from the shader folder.

        Files are read when the text is first needed. Sources with the same `key` have the same
        text.
        """
        head = f"#version {version}", *map(_declare, (constants or {}).items())
        self._head, self._entry, self._texts = head, entry, tuple((texts or {}).items())
        self.key = (entry, version, *(constants or {}).items(), *self._texts, _edition[0])

    @property
    def whole(self) -> Code:
        """All lines, each with its origin; RenderError if a file is missing."""
        return self._assembled.whole

    @property
    def live(self) -> Code:
        """The lines that can run with these constants: a driver compiles them in half the time.

        Within `files_reread` these are all lines, so that an author sees every error.
        """
        return self.whole if _is_rereading[0] else self._assembled.live

    @cached_property
    def _assembled(self) -> "_Assembled":
        return _assembled(self._head, self._entry, self._texts)


def read(name: str) -> str:
    """Return the text of one shader file."""
    return _text_of(folder("shaders_glsl") / name)


def expanded(name: str) -> str:
    """Return the text of a shader file, with all files that it includes."""
    return "\n".join(line.text for line in _Files({}).expand(name, name)) + "\n"


def shader_files() -> list[Path]:
    """Return every shader file, sorted."""
    return sorted(path for path in folder("shaders_glsl").rglob("*") if path.is_file())


@contextmanager
def files_reread() -> Iterator[None]:
    """Read files as they are now within the block; after an error, restore the earlier texts."""
    before, edition = dict(_texts), _edition[0]
    _texts.clear()
    _edition[0], _is_rereading[0] = next(_editions), True
    try:
        yield
    except BaseException:
        _texts.clear()
        _texts.update(before)
        _edition[0] = edition
        raise
    finally:
        _is_rereading[0] = False


@lru_cache(maxsize=512)
def with_precise_floats(text: str) -> str:
    """Return a file's text with `precise` before variables and `inout` parameters of floats.

    The driver may then neither fuse nor reorder arithmetic (GLSL 4.30, section 4.9). One line stays
    one line. A declaration must begin its line, or a `for`; a function begins in column 0.
    """
    lines, is_in_function = [], False
    for line in text.split("\n"):
        line = _CHANGED.sub("precise inout", line)
        line = (_LOCAL if is_in_function else _GLOBAL).sub(r"\g<0>precise ", line)
        if line.startswith("}"):
            is_in_function = False
        elif line.endswith("{") and not line.startswith(_NO_FUNCTION):
            is_in_function = True
        lines.append(line)
    return "\n".join(lines)


def _assembled(
    head: tuple[str, ...], entry: str, texts: tuple[tuple[str, str], ...]
) -> "_Assembled":
    """Return the lines of a shader, those of before if its files hold the same texts."""
    with _assembling:
        kept = _kept.pop((head, entry, texts), None)
        if not kept or not kept.is_of_these_files():
            files = _Files(dict(texts))
            lines = [Line(line, "prelude") for line in head]
            for line in files.expand(entry, "the kernel"):
                if _file(line.origin) != _file(lines[-1].origin):
                    lines.append(Line(f"// {line.origin}", line.origin))
                lines.append(line)
            kept = _Assembled(Code(lines), files.were_read)
        _kept[head, entry, texts] = kept
        while len(_kept) > ASSEMBLED:
            _kept.pop(next(iter(_kept)))
    return kept


@dataclass
class _Assembled:
    """The lines of a shader, and the texts of the files that they were taken from."""

    whole: Code
    were_read: dict[str, str]

    @cached_property
    def live(self) -> Code:
        lines = self.whole.lines
        found = live_lines([line.text for line in lines])
        return Code([Line(text, lines[place].origin) for place, text in found])

    def is_of_these_files(self) -> bool:
        try:
            return all(read(name) == text for name, text in self.were_read.items())
        except OSError:
            return False


_kept: dict[tuple[object, ...], _Assembled] = {}  # the most recently used last
_assembling = Lock()


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
        self.were_read: dict[str, str] = {}  # texts of the files of the folder, by name

    def expand(self, name: str, wanted_by: str) -> list[Line]:
        """Return the lines of a file, with included files where they are first named."""
        if name in self._seen:
            return []
        self._seen.add(name)
        lines: list[Line] = []
        text = self._text(name, wanted_by)
        for number, line in enumerate(with_precise_floats(text).splitlines(), start=1):
            origin = f"{name}:{number}"
            match = _INCLUDE.match(line)
            lines += self.expand(match[1], origin) if match else [Line(line, origin)]
        return lines

    def _text(self, name: str, wanted_by: str) -> str:
        if name in self._texts:
            return self._texts[name]
        try:
            text = self.were_read[name] = read(name)
            return text
        except OSError as error:
            problem = error.strerror or "cannot be read"
            raise RenderError(f"{wanted_by}: the shader file '{name}': {problem}") from error
