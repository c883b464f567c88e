"""The page of Python: the public names with their signatures and docstrings."""

import ast
import inspect
import re
import textwrap
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel
from reference_markdown import GENERATED, table
from reference_scene import keys

import glrt
from glrt.core.errors import GlrtError
from glrt.scene.scene import Scene


def python_api() -> Iterator[str]:
    """The public names with their signatures and docstrings."""
    yield "# Python"
    yield GENERATED
    yield (
        "`import glrt` loads nothing else: each name below is imported when it is first used. "
        "Names of modules that are not listed here may change between versions."
    )
    names = [name for name in glrt.__all__ if name != "__version__" and not is_error(name)]
    functions = [name for name in names if inspect.isfunction(getattr(glrt, name))]
    for name in [*functions, *(name for name in names if name not in functions)]:
        yield f"## `glrt.{name}`"
        public = getattr(glrt, name)
        yield from function(public, name) if name in functions else class_page(public)
    yield "## `glrt.__version__`"
    yield "The version of glrt as a text."
    yield "## Errors"
    yield (
        "All errors are subclasses of `glrt.GlrtError`. Their text is one paragraph: the mistake, "
        "its place, and a remedy."
    )
    kinds = [getattr(glrt, name) for name in glrt.__all__ if is_error(name)]
    rows = [(f"`glrt.{kind.__name__}`", str(kind.exit_code), first(kind)) for kind in kinds]
    yield table(("class", "exit code", "meaning"), rows)


def is_error(name: str) -> bool:
    """Whether a public name is that of an error."""
    public = getattr(glrt, name)
    return inspect.isclass(public) and issubclass(public, GlrtError)


def class_page(public: type) -> Iterator[str]:
    """A class: how to make one, its fields, properties and methods."""
    yield inspect.getdoc(public) or ""
    if issubclass(public, BaseModel):
        whole = "Fields: those of the [scene file](scene-file.md)."
        yield whole if public is Scene else keys(public)
    elif "__init__" in vars(public) and "__dataclass_fields__" not in vars(public):
        yield from function(vars(public)["__init__"], public.__name__)
    else:
        yield f"```python\n{fields(public)}\n```"
    for name, member in members(public):
        if name.startswith("_") or inspect.getdoc(member) is None:
            continue
        if isinstance(member, property):
            yield f"### `.{name}`"
            yield inspect.getdoc(member) or ""
        elif inspect.isfunction(member) or isinstance(member, classmethod):
            yield f"### `.{name}()`"
            yield from function(getattr(member, "__func__", member), name)


def members(public: type) -> Iterator[tuple[str, object]]:
    """The members of a class itself; except for models, its inherited members follow."""
    kinds = [public] if issubclass(public, BaseModel) else public.__mro__[:-1]
    for kind in kinds:
        yield from vars(kind).items()


def fields(public: type) -> str:
    """The fields of a dataclass as they stand in its source, comments included."""
    lines = textwrap.dedent(inspect.getsource(public)).splitlines()
    tree = ast.parse("\n".join(lines)).body[0]
    assert isinstance(tree, ast.ClassDef)
    found = [node for node in tree.body if isinstance(node, ast.AnnAssign)]
    return "\n".join(textwrap.dedent(lines[node.lineno - 1]) for node in found)


def function(public: Any, name: str) -> Iterator[str]:
    """A function: its signature as it stands in the source, and its docstring."""
    node = ast.parse(textwrap.dedent(inspect.getsource(public))).body[0]
    assert isinstance(node, ast.FunctionDef)
    arguments = [part for part in ast.unparse(node.args).split(", ") if part not in ("self", "cls")]
    line = re.sub(r"(?<=[\w\]'])=(?=\S)", " = ", f"{name}({', '.join(arguments)})")
    if node.returns and name != "__init__" and ast.unparse(node.returns) != "None":
        line += f" -> {ast.unparse(node.returns)}"
    line = re.sub(r"'([A-Z]\w*)'", r"\1", line)  # a forward reference
    yield f"```python\n{line}\n```"
    yield inspect.getdoc(public) or ""


def first(public: type) -> str:
    """The first line of a docstring."""
    return (inspect.getdoc(public) or "").splitlines()[0]
