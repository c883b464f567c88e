"""Sets of texture coordinates: a file may have many, and a mesh holds two."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from glrt.scene.model_files.gltf.document import Document, whole

_NAME = "TEXCOORD_"
_TRANSFORM = "KHR_texture_transform"


class Sets(NamedTuple):
    """Sets of texture coordinates by their numbers in the file."""

    kept: tuple[int, int]  # by a mesh, as its sets 0 and 1
    there: frozenset[int]  # of any primitive


def sets_of(document: Document) -> Sets:
    """Return the sets that meshes of a file hold: 0 and 1, or the lowest two that textures use."""
    return document.once("sets of texture coordinates", lambda: _sets(document))


def set_of(document: Document, info: dict[str, Any], here: str) -> int:
    """Return the number of the set by which a texture lies."""
    own = document.extension(info, _TRANSFORM, here) or {}
    return whole(own.get("texCoord", info.get("texCoord", 0)), f"{here}.texCoord")


def name_of(number: int) -> str:
    """Return the name of the attribute of a set."""
    return f"{_NAME}{number}"


def _sets(document: Document) -> Sets:
    there = frozenset(_given(document))
    infos = _textures(document.items("materials"))
    used = sorted({set_of(document, info, "a texture") for info in infos} & there)
    spare = [number for number in (0, 1) if number not in used]
    first, second = sorted([*used, *spare][:2])
    return Sets((first, second), there)


def _given(document: Document) -> Iterator[int]:
    """Yield the sets of all primitives."""
    for mesh in document.items("meshes"):
        primitives = mesh.get("primitives") if isinstance(mesh, dict) else None
        for primitive in primitives if isinstance(primitives, list) else ():
            named = primitive.get("attributes") if isinstance(primitive, dict) else None
            for name in named if isinstance(named, dict) else ():
                if name.startswith(_NAME) and name[len(_NAME) :].isdecimal():
                    yield int(name[len(_NAME) :])


def _textures(materials: list[Any]) -> Iterator[dict[str, Any]]:
    """Yield what materials say of each of their textures."""
    waiting = list(materials)
    while waiting:
        table = waiting.pop()
        for name, value in table.items() if isinstance(table, dict) else ():
            if isinstance(value, dict):
                if name.endswith("Texture"):
                    yield value
                else:
                    waiting.append(value)
