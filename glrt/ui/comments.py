"""A scene file changed where the scene has changed, with its comments, order and formatting."""

import tomllib
from collections.abc import Mapping
from typing import Any

from glrt.errors import SceneError, UsageError
from glrt.scene import Scene
from glrt.scene_file import parse_scene, scene_to_dict

MOST_LETTERS = 500_000  # of a file, which takes seconds: beyond, its comments go

Table = Mapping[str, Any]


def revised(text: str, scene: Scene) -> str | None:
    """The text of a scene file, made to say `scene`; None where that cannot be done.

    What has not changed stands as it did. UsageError if the library for that is not installed.
    """
    if len(text) > MOST_LETTERS:
        return None
    try:
        before = parse_scene(tomllib.loads(text), "")
        new = _revised(text, scene_to_dict(before), scene_to_dict(scene))
        return new if parse_scene(tomllib.loads(new), "") == scene else None
    except (ValueError, SceneError):
        return None


def _revised(text: str, before: Table, after: Table) -> str:
    """ValueError if the library cannot make the change."""
    try:
        import tomlkit
    except ModuleNotFoundError:
        raise UsageError(
            "keeping the comments of a scene file needs the Python package tomlkit: type `pip "
            "install 'glrt[view]'`, or save under another name."
        ) from None
    try:
        document = tomlkit.parse(text)
        _follow(document, before, after)
        return tomlkit.dumps(document)
    except (LookupError, TypeError, AttributeError) as error:  # ways to write TOML are many
        raise ValueError(str(error)) from error


def _follow(table: Any, before: Table, after: Table) -> None:
    """Make the same changes to a table of the document as lead from one table to another."""
    for key in before.keys() - after.keys():
        table.pop(key, None)
    for key, value in after.items():
        old = before.get(key)
        if value == old:
            continue
        if isinstance(value, dict):
            _follow(table.setdefault(key, {}), old or {}, value)
        elif key in table and isinstance(old, list) and len(old) == len(value):
            _follow_items(table[key], old, value)
        else:
            table[key] = value


def _follow_items(items: Any, before: list[Any], after: list[Any]) -> None:
    """The same for a list, whose items may be tables."""
    for index, (old, value) in enumerate(zip(before, after, strict=True)):
        if isinstance(value, dict) and value != old:
            _follow(items[index], old, value)
        elif value != old:
            items[index] = value
