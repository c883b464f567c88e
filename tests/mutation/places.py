"""Where a function stands in the source: its text, by its name, wherever its file has moved to."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

FOLDERS = {"shaders_glsl": "*.*", "glrt": "*.py"}  # files that bugs are planted in
_GLSL_FUNCTION = re.compile(r"^(?:\w+ )*\w+ (\w+)\([^;{}]*?\)\s*\{", re.MULTILINE)
_GLSL_REST = re.compile(
    r"^struct (\w+)\s*\{[^}]*\};|^(?:const )?\w+ (\w+)(?:\[\w*\])?\s*=.*?;|^#define (\w+)[^\n]*",
    re.MULTILINE | re.DOTALL,
)


class Span(NamedTuple):
    """A part of a file."""

    file: Path
    start: int
    end: int


def places(root: Path) -> dict[str, list[Span]]:
    """Find where each function, class, struct and constant stands, by its name.

    Members of a class have its name in front: `Film.read`. A name may stand for several. The entry
    files of shaders, which have functions of the same names, have theirs too: `trace.frag`.
    """
    found: dict[str, list[Span]] = {}
    for folder, pattern in FOLDERS.items():
        for file in sorted((root / folder).rglob(pattern)):
            text = file.read_text()
            listed = _python(text) if file.suffix == ".py" else _glsl(text)
            if folder == "shaders_glsl" and file.suffix != ".glsl":
                found[file.name] = [Span(file, 0, len(text))]
            for name, start, end in listed:
                found.setdefault(name, []).append(Span(file, start, end))
    return found


def _glsl(text: str) -> Iterator[tuple[str, int, int]]:
    for match in _GLSL_FUNCTION.finditer(text):
        yield match[1], match.start(), _closing(text, match.end() - 1)
    for match in _GLSL_REST.finditer(text):
        yield match[1] or match[2] or match[3], match.start(), match.end()


def _closing(text: str, opening: int) -> int:
    """The place after the brace that closes the one there."""
    depth = 0
    for brace in re.finditer(r"[{}]", text[opening:]):
        depth += 1 if brace[0] == "{" else -1
        if not depth:
            return opening + brace.end()
    raise ValueError("a brace is not closed")


def _python(text: str) -> Iterator[tuple[str, int, int]]:
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def within(node: ast.AST, prefix: str) -> Iterator[tuple[str, int, int]]:
        for child in ast.iter_child_nodes(node):
            if name := _name(child):
                assert isinstance(child, ast.stmt)
                decorated = [it.lineno for it in getattr(child, "decorator_list", [])]
                first = min([child.lineno, *decorated])
                yield f"{prefix}{name}", starts[first - 1], starts[child.end_lineno or first]
                if isinstance(child, ast.ClassDef):
                    yield from within(child, f"{prefix}{name}.")

    return within(ast.parse(text), "")


def _name(node: ast.AST) -> str:
    """The name that a statement defines, "" if none."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return node.name
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    return targets[0].id if isinstance(targets[0], ast.Name) else ""
