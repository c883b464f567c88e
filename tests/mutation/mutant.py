"""A bug to plant: what it changes in the text, and the test that must find it."""

from typing import NamedTuple


class Edit(NamedTuple):
    """Text of a shader file, which stands there once, and what the bug puts in its place."""

    file: str
    old: str
    new: str


class Mutant(NamedTuple):
    """A bug, and the tests of one file (an expression for pytest -k) that must fail with it."""

    bug: str
    edits: tuple[Edit, ...]
    test: str  # FILE::NAME in tests/; all cases of it are run until one fails


def edit(file: str, old: str, new: str) -> tuple[Edit, ...]:
    """The one edit of a bug that needs no more, in a file of the shaders."""
    return (Edit(f"shaders_glsl/{file}", old, new),)
