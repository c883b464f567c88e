"""A scene with other values in it: those of a frame of its animation, or of a sweep."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any, TypeVar

from pydantic import BaseModel

from glrt.core.errors import SceneError
from glrt.core.text import quoted, unknown
from glrt.phong import Phong
from glrt.scene.animation.tracks import PHONG, Track
from glrt.scene.schema.fields import SceneFields
from glrt.scene.schema.validation import Place, validated
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.values import LARGEST
from glrt.settings import Settings

SceneType = TypeVar("SceneType", bound=SceneFields)
Keys = tuple[str, ...]

_OF_PART = 3  # keys down to a value of a named part
_WHOLE = int | None  # the type of a value that is rounded between keys
_BY_NAME = {"materials": "material", "media": "medium"}  # tables of named parts; what each is


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
        new = {place: _part(part, keys, value, source) for place, part in parts.items()}
        if table == PHONG[0]:
            update[table] = now.model_copy(update={PHONG[1]: new[PHONG]})
        elif table == "objects":
            update[table] = tuple(new.get(place, thing) for place, thing in enumerate(now))
        else:
            update[table] = {**now, **new} if table in _BY_NAME else new[table]
    return validated(type(scene), dict(scene) | update, source) if update else scene


def holds_whole(scene: SceneFields, keys: Keys) -> bool:
    """Return whether a value of a scene is a whole number.

    Raises `SceneError` for a value that the scene lacks.
    """
    table = keys[0]
    part: BaseModel = next(iter(_parts(getattr(scene, table), keys).values()))
    holder = getattr(part, keys[2]) if _is_inner(keys) else part
    return type(holder).model_fields[keys[-1]].annotation == _WHOLE


def with_phong_of(still: SceneFields, moved: Iterable[Keys], settings: Settings) -> Settings:
    """Return settings with the constants of Phong's model of a still, if `moved` names some."""
    if not any(keys[:2] == PHONG for keys in moved):
        return settings
    return settings.model_copy(update={PHONG[1]: still.render.phong})


def animation_problems(scene: SceneFields, groups: Collection[str]) -> Iterator[tuple[Place, str]]:
    """Yield place and advice for tracks without a target in the scene, and for wrong values.

    `groups` are the light groups of the scene.
    """
    for number, track in enumerate(scene.animation.tracks if scene.animation else ()):
        is_of_light = track.keys[0] == "lights"
        found = _of_light(track, groups) if is_of_light else _of_part(scene, track)
        if problem := next(found, None):
            yield ("animation", "tracks", number, *problem[0]), problem[1]


def _of_light(track: Track, groups: Collection[str]) -> Iterator[tuple[Place, str]]:
    """Yield problems of the track of a light group, with their place in the track."""
    group = track.keys[1]
    if group not in groups:
        yield ("target",), unknown("light group", group, sorted(groups))
    for number, value in enumerate(track.plain_values):
        if not (isinstance(value, float) and value >= 0):
            yield ("values", number), f"must be a number from 0 to {LARGEST:g}"


def _of_part(scene: SceneFields, track: Track) -> Iterator[tuple[Place, str]]:
    """Yield problems of the track of a value of a part, with their place in the track."""
    try:
        parts = _parts(getattr(scene, track.keys[0]), track.keys)
    except SceneError as error:
        yield ("target",), str(error)
        return
    for number, value in enumerate(track.plain_values):
        try:
            for part in parts.values():
                _part(part, track.keys, value, "")
        except SceneError as error:
            yield ("values", number), str(error).removeprefix(": ")


def _parts(now: Any, keys: Keys) -> dict[Any, Any]:
    """Return the parts of a table that have the value of a target, by their place in it."""
    table, name, *_ = keys
    if table in _BY_NAME:
        if name not in now:
            raise SceneError(unknown(_BY_NAME[table], name, sorted(now)))
        parts: dict[Any, Any] = {name: now[name]}
    elif table == "objects":
        parts = {number: now[number] for number in _called(now, name)}
    elif keys[:2] == PHONG:
        parts = {PHONG: now.phong or Phong()}
    elif now is None:
        raise SceneError(f"the scene has no [{table}]")
    else:
        parts = {table: now}
    for part in parts.values():
        inner = getattr(part, keys[2]) if _is_inner(keys) else part
        if inner is None:
            raise SceneError(f"{_BY_NAME[table]} {quoted(name)} has no {keys[2]}")
        if keys[-1] not in type(inner).model_fields:
            owner = f"Keys of {'.'.join(keys[:-1])}"
            raise SceneError(unknown("key", keys[-1], type(inner).model_fields, owner))
    return parts


def _is_inner(keys: Keys) -> bool:
    """Return whether a value lies in a table of a part, as media.NAME.density.scale does."""
    return len(keys) > _OF_PART


def _part(part: BaseModel, keys: Keys, value: Any, source: str) -> BaseModel:
    """Return a part of a scene with another value of the last of some keys."""
    if _is_inner(keys):
        inner = _valued(getattr(part, keys[2]), keys, value, source)
        return part.model_copy(update={keys[2]: inner})
    return _valued(part, keys, value, source)


def _valued(part: BaseModel, keys: Keys, value: Any, source: str) -> BaseModel:
    """Return a part, or a table in it, with another value of the last key."""
    where = f"{source}: {'.'.join(keys[:-1])}" if source else ""
    fields = {name: item for name, item in part if item is not None}
    if type(part).model_fields[keys[-1]].annotation == _WHOLE and isinstance(value, float):
        value = round(value)
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
