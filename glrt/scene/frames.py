"""A scene with other values in it: those of a frame of its animation, or of a sweep."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, TypeVar

from pydantic import BaseModel

from glrt.core.errors import SceneError
from glrt.core.text import quoted, unknown
from glrt.scene.animation.tracks import Track
from glrt.scene.schema.fields import SceneFields
from glrt.scene.schema.validation import Place, validated
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.values import LARGEST

SceneType = TypeVar("SceneType", bound=SceneFields)
Keys = tuple[str, ...]


def with_values(scene: SceneType, values: Mapping[Keys, Any], source: str) -> SceneType:
    """Return the scene with other values, by keys such as ("objects", "ball", "center").

    Raises `SceneError`, as `source: key: ...`, for a value that the scene lacks, for one out of
    range, and if the parts no longer fit together.
    """
    update = dict[str, Any]()
    for keys, value in values.items():
        table = keys[0]
        now = update.get(table, getattr(scene, table))
        if table == "lights":
            update[table] = {**now, keys[1]: value}
            continue
        parts = _parts(now, keys)
        for part in parts.values():
            _check_key(part, keys)
        new = {place: _part(part, keys, value, source) for place, part in parts.items()}
        if table == "objects":
            update[table] = tuple(new.get(place, thing) for place, thing in enumerate(now))
        else:
            update[table] = {**now, **new} if table == "materials" else new[table]
    return validated(type(scene), dict(scene) | update, source) if update else scene


def animation_problems(scene: SceneFields, groups: Collection[str]) -> Iterator[tuple[Place, str]]:
    """Yield place and advice for tracks without a target in the scene, and for wrong values.

    `groups` are the light groups of the scene.
    """
    for number, track in enumerate(scene.animation.tracks if scene.animation else ()):
        here: Place = ("animation", "tracks", number)
        if track.keys[0] == "lights" and track.keys[1] not in groups:
            yield (*here, "target"), unknown("light group", track.keys[1], sorted(groups))
            continue
        try:
            parts = list(_parts(getattr(scene, track.keys[0]), track.keys).values())
            for part in parts:
                _check_key(part, track.keys)
        except SceneError as error:
            yield (*here, "target"), str(error)
            continue
        problem = next(_wrong_values(track, parts), None)
        if problem:
            yield (*here, "values", problem[0]), problem[1]


def _wrong_values(track: Track, parts: Sequence[Any]) -> Iterator[tuple[int, str]]:
    """Yield the numbers of keys whose values are out of range, with advice."""
    is_light = track.keys[0] == "lights"
    for number, value in enumerate(track.plain_values):
        if is_light and not (isinstance(value, float) and value >= 0):
            yield number, f"must be a number from 0 to {LARGEST:g}"
        try:
            for part in [] if is_light else parts:
                _part(part, track.keys, value, "")
        except SceneError as error:
            yield number, str(error).removeprefix(": ")


def _parts(now: Any, keys: Keys) -> dict[Any, Any]:
    """Return the parts of a table that a target changes, by their place in it."""
    table, name = keys[:2]
    if table == "lights":
        return {}
    if table == "materials":
        if name not in now:
            raise SceneError(unknown("material", name, sorted(now)))
        return {name: now[name]}
    if table == "objects":
        return {number: now[number] for number in _called(now, name)}
    if now is None:
        raise SceneError(f"the scene has no [{table}]")
    return {table: now}


def _check_key(part: BaseModel, keys: Keys) -> None:
    if keys[-1] not in type(part).model_fields:
        owner = f"Keys of {'.'.join(keys[:-1])}"
        raise SceneError(unknown("key", keys[-1], type(part).model_fields, owner))


def _part(part: BaseModel, keys: Keys, value: Any, source: str) -> BaseModel:
    """Return a part of a scene with another value of the last of some keys."""
    where = f"{source}: {'.'.join(keys[:-1])}" if source else ""
    fields = {name: item for name, item in part if item is not None}
    return validated(type(part), {**fields, keys[-1]: value}, where)


def _called(things: Sequence[Shape], name: str) -> list[int]:
    """Return the numbers of the objects of a name: one, or the parts of one model."""
    found = [number for number, thing in enumerate(things) if thing.name == name]
    if not found:
        names = sorted({thing.name for thing in things if thing.name})
        raise SceneError(unknown("object", name, names, "Names of objects"))
    models = {_model(things[number]) for number in found}
    if len(found) > 1 and (len(models) > 1 or None in models):
        raise SceneError(f"{len(found)} objects are named {quoted(name)}: give each its own name")
    return found


def _model(thing: Shape) -> str | None:
    return thing.file.path if isinstance(thing, Mesh) and thing.part is not None else None
