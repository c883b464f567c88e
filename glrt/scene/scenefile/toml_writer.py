"""Write a scene as a TOML file, on request with the comments, order and format of another one."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from glrt.core.errors import SceneError, UsageError
from glrt.core.files import write_whole
from glrt.core.install import install
from glrt.scene.loading.file_copies import copy_files
from glrt.scene.loading.scene_files import hashes_of, with_hashes
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene
from glrt.scene.scenefile.toml_lists import with_as_many
from glrt.scene.schema.tables import scene_to_dict, short_tables, toml_lines, toml_text
from glrt.settings import RenderSettings, Settings

MOST_LETTERS = 500_000  # of a file, which takes seconds: a longer one loses its comments

Table = Mapping[str, Any]


def scene_with(scene: Scene, settings: Settings) -> Scene:
    """Return the scene with these settings as its `[render]` table."""
    wishes = {name: getattr(settings, name) for name in RenderSettings.model_fields}
    return scene.model_copy(update={"render": RenderSettings(**wishes)})


def write_scene(scene: Scene, path: Path, model: Path | None = None) -> bool:
    """Write a file that `read_scene` reads back as the same scene, and copies of its files.

    `model` is a scene file whose comments, order and formatting are to be kept; returns whether
    they were. The file appears whole or not at all. Raises `RenderError` if it cannot be written,
    `UsageError` if a copy would replace another file.
    """
    copy_files(scene, path.parent)
    text = _with_comments(_text(model), scene) if model else None
    content = (toml_text(scene) if text is None else text).encode("utf-8")
    write_whole(path, lambda file: _write(file, content))
    return text is not None


def _text(path: Path) -> str:
    """Return the text of a file with its line endings; if it is no text, one that is no scene."""
    try:
        return path.read_bytes().decode("utf-8-sig")
    except (OSError, UnicodeDecodeError):
        return "?"


def _write(path: Path, content: bytes) -> None:
    path.write_bytes(content)


def _with_comments(text: str, scene: Scene) -> str | None:
    """Return the text of a scene file, changed to describe `scene`; None if that is impossible.

    Parts that have not changed stand as they did. UsageError if tomlkit is not installed.
    """
    if len(text) > MOST_LETTERS:
        return None
    try:
        before = _as_written(parse_scene(tomllib.loads(text), ""))
        after, short = scene_to_dict(scene), short_tables(scene)
        texts = ["\n".join(toml_lines({"objects": [it]})) + "\n" for it in short.get("objects", [])]
        text, before["objects"] = with_as_many(text, before["objects"], after["objects"], texts)
        new = _changed(text, before, after, short)
        told = with_hashes(parse_scene(tomllib.loads(new), ""), hashes_of(scene))
        return new if told == scene else None
    except (ValueError, SceneError):
        return None


def _as_written(scene: Scene) -> dict[str, Any]:
    """Return a scene as plain tables, without a size that the file of its camera would give."""
    tables = scene_to_dict(scene)
    if scene.camera.file:
        for key in {"width", "height"} - scene.render.model_fields_set:
            del tables["render"][key]
    return tables


def _changed(text: str, before: Table, after: Table, short: Table) -> str:
    """Return the text, changed from `before` to `after`; new parts are written as in `short`.

    `short` is `after` without defaults. ValueError if the library cannot make the change.
    """
    try:
        import tomlkit
    except ModuleNotFoundError:
        raise UsageError(
            "keeping the comments of a scene file needs the Python package tomlkit: type "
            f"`{install('view')}`, or save under another name."
        ) from None
    try:
        document = tomlkit.parse(text)
        _follow(document, before, after, short)
        return tomlkit.dumps(document)
    except (LookupError, TypeError, AttributeError) as error:  # TOML can be written in many ways
        raise ValueError(str(error)) from error


def _follow(table: Any, before: Table, after: Table, short: Table) -> None:
    """Make the changes from `before` to `after` in a table of the document."""
    for key in before.keys() - after.keys():
        table.pop(key, None)
    for key, value in after.items():
        old, brief = before.get(key), short.get(key, value)
        if value == old:
            continue
        if old is None and isinstance(value, dict):
            _follow(table.setdefault(key, {}), {}, brief, brief)
        elif isinstance(value, dict):
            _follow(table.setdefault(key, {}), old or {}, value, brief)
        elif key in table and isinstance(old, list) and len(old) == len(value):
            _follow_items(table[key], old, value)
        else:
            table[key] = brief


def _follow_items(items: Any, before: list[Any], after: list[Any]) -> None:
    """Make the changes from `before` to `after` in a list, whose items may be tables."""
    for index, (old, value) in enumerate(zip(before, after, strict=True)):
        if isinstance(value, dict) and value != old:
            _follow(items[index], old, value, {})
        elif value != old:
            items[index] = value
