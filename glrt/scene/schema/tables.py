"""The parts of a scene as plain tables, and tables as TOML."""

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from pydantic import BaseModel

from glrt.scene.schema.fields import SceneFields
from glrt.settings import RenderSettings

_NO_LISTS = (str, Mapping)  # these are no lists, though they can be iterated over


def to_tables(**parts: Any) -> dict[str, Any]:
    """Return the fields of a scene, given as models, tables or arrays, as tables without None."""
    given = {key: _table(value) for key, value in parts.items() if value is not None}
    if isinstance(materials := given.get("materials"), Mapping):
        given["materials"] = {name: _table(item) for name, item in materials.items()}
    if isinstance(media := given.get("media"), Mapping):
        given["media"] = {name: _table(item) for name, item in media.items()}
    if isinstance(objects := given.get("objects"), Iterable) and not isinstance(objects, _NO_LISTS):
        given["objects"] = [_table(item) for item in objects]
    return given


def _table(value: Any) -> Any:
    """Return a model as a table; other values stay as they are."""
    if isinstance(value, RenderSettings):  # Settings has fields that scenes lack
        return value.model_dump(exclude_unset=True)
    if isinstance(value, BaseModel):
        return {key: item for key, item in value if item is not None}
    return value


def scene_to_dict(scene: SceneFields) -> dict[str, Any]:
    """Return the scene as plain tables, lists, numbers and strings that `parse_scene` reads back.

    Defaults are written out, so that a recipe keeps its meaning; values of None are absent.
    """
    return scene.model_dump(mode="json", exclude_none=True)


def toml_text(scene: SceneFields) -> str:
    """Return the text of a scene file, to its last line; values with their default are left out."""
    return "\n".join(toml_lines(short_tables(scene))).strip() + "\n"


def short_tables(scene: SceneFields) -> dict[str, Any]:
    """Return `scene_to_dict` without defaults, except format and kinds of materials and shapes."""
    found = scene.model_dump(mode="json", exclude_none=True, exclude_defaults=True)
    for name, material in scene.materials.items():
        found["materials"][name] = {"type": material.type, **found["materials"][name]}
    for table, thing in zip(found.get("objects", []), scene.objects, strict=True):
        kind = {"shape": thing.shape}
        table.update({**kind, **{key: table.pop(key) for key in list(table) if key != "shape"}})
    if scene.camera.file:  # the file would give another size
        size = {key: getattr(scene.render, key) for key in ("width", "height")}
        found["render"] = {**size, **found.get("render", {})}
    title = {"title": scene.title} if scene.title else {}
    return {**title, "format": scene.format, **found}


def toml_lines(table: Mapping[str, Any], path: tuple[str, ...] = ()) -> Iterator[str]:
    """Yield the lines of a table: first its values, then its tables and lists of tables."""
    for key, value in table.items():
        if not isinstance(value, Mapping) and not _is_list_of_tables(value):
            yield f"{_key(key)} = {_value(value)}"
    for key, value in table.items():
        name = ".".join(map(_key, (*path, key)))
        if isinstance(value, Mapping):
            lines = list(toml_lines(value, (*path, key)))
            yield from (["", f"[{name}]", *lines] if lines and lines[0] else lines)
        elif _is_list_of_tables(value):
            for item in value:
                yield from ("", f"[[{name}]]", *toml_lines(item, (*path, key)))


def _is_list_of_tables(value: Any) -> bool:
    return isinstance(value, list) and any(isinstance(item, Mapping) for item in value)


def _key(key: str) -> str:
    bare = key.isascii() and key.replace("_", "a").replace("-", "a").isalnum()
    return key if bare else _value(key)


def _value(value: Any) -> str:
    """Return the TOML of a number, a boolean, a text or a list of them; JSON's texts are TOML's."""
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    return json.dumps(value, ensure_ascii=False)
