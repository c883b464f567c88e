"""Frames of a scene that is edited, and the keys of its animation, by pure functions."""

import json
import re
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from glrt.core.errors import SceneError, UsageError
from glrt.core.memo import kept_for_the_same
from glrt.scene.animation.rotations import QUATERNION, of_angles
from glrt.scene.animation.tracks import Animation, Track
from glrt.scene.frames import with_values
from glrt.scene.scene import Scene
from glrt.view.controls import replaced
from glrt.view.edits.scene_edits import free_name, with_object

Keys = tuple[str, ...]
SAME = 1e-6  # seconds: keys of one moment
MOST_NUMBERS = 4  # of a value
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_CAMERA = "position", "look_at", "fov", "focus_distance", "defocus_angle"


def at_frame(scene: Scene, frame: float) -> Scene:
    """Return the scene with the values of a frame, from 0, and with its animation.

    A frame after the last one has the values of the last keys. Raises `SceneError` if a curve
    leaves the range of its value.
    """
    animation = scene.animation
    if not animation or not animation.tracks:
        return scene
    moment = animation.moment(frame)
    values = {track.keys: track.at(moment) for track in animation.tracks}
    still = with_values(scene.still, values, f"frame {frame:g}")
    return still.model_copy(update={"animation": animation})


@kept_for_the_same
def rested(scene: Scene, saved: Scene) -> Scene:
    """Return the scene with the values of `saved` wherever its animation changes values.

    So a frame that is shown is no edit. Where `saved` lacks a value, frame 0 has it.
    """
    if not scene.animation or not scene.animation.tracks:
        return scene
    try:
        values = {keys: value_of(saved, keys) for keys in scene.moved}
        known = {keys: value for keys, value in values.items() if value is not None}
        base = scene if len(known) == len(values) else at_frame(scene, 0)
        still = with_values(base.still, known, "the scene")
        return still.model_copy(update={"animation": scene.animation})
    except SceneError:
        return scene


def value_of(scene: Scene, keys: Keys) -> Any:
    """Return the value that keys name, such as ("objects", "ball", "center"); None if none."""
    table, *rest = keys
    if table == "lights":
        return scene.light_groups.get(rest[0])
    part: Any = getattr(scene, table)
    if table == "objects":
        part = next((it for it in part if it.name == rest[0]), None)
        rest = rest[1:]
    for key in rest:
        part = part.get(key) if isinstance(part, dict) else getattr(part, key, None)
    return part


def target_of(keys: Keys) -> str:
    """Return keys as a target of a track; names with other signs stand in quotes."""
    return ".".join(key if _BARE.fullmatch(key) else json.dumps(key) for key in keys)


def values_with_keys(scene: Scene, selected: int | None) -> list[Keys]:
    """Return what keys can be set for: animated values, then object, camera and light groups.

    An object without a name stands under the name that it would get.
    """
    found = [*scene.moved]
    if selected is not None and selected < len(scene.objects):
        shape = scene.objects[selected]
        name = _name_of(scene, selected)
        found += [("objects", name, key) for key in _numbers(shape)]
        material = scene.materials[shape.material]
        found += [("materials", shape.material, key) for key in _numbers(material)]
    found += [("camera", key) for key in _CAMERA if _is_number(getattr(scene.camera, key))]
    found += [("lights", group) for group in scene.light_groups]
    return [*dict.fromkeys(found)]


def with_key(scene: Scene, keys: Keys, frame: float, selected: int | None = None) -> Scene:
    """Return the scene with a key for the present value at a frame; it replaces one at the frame.

    The animation and the track are made if there are none. A selected object without a name gets
    one. Angles become a quaternion where the track holds quaternions. Raises `UsageError` for a
    value that cannot have keys.
    """
    if keys[0] == "objects" and selected is not None and not scene.objects[selected].name:
        named = replaced(scene.objects[selected], name=_name_of(scene, selected))
        scene = with_object(scene, selected, named)
    value = value_of(scene, keys)
    if not _is_number(value):
        raise UsageError(f"{target_of(keys)} is no number in this scene, so it can have no key.")
    animation = scene.animation or Animation()
    moment = round(animation.moment(frame), 6)
    track = _track(animation, keys) or Track(
        target=target_of(keys), times=(moment,), values=(value,)
    )
    if _length(track.values[0]) == QUATERNION > _length(value):
        value = tuple(of_angles(value).tolist())
    others = [key for key in zip(track.times, track.values, strict=True) if key[0] != moment]
    others = [key for key in others if abs(key[0] - moment) > SAME]
    times, values = zip(*sorted([*others, (moment, value)], key=lambda key: key[0]), strict=True)
    return _with_track(
        scene, animation, track.model_copy(update={"times": times, "values": values})
    )


def without_key(scene: Scene, keys: Keys, frame: float) -> Scene:
    """Return the scene without the key of a value at a frame; a track without keys goes, too."""
    animation = scene.animation
    track = _track(animation, keys) if animation else None
    if not animation or not track:
        return scene
    moment = animation.moment(frame)
    left = [it for it in zip(track.times, track.values, strict=True) if abs(it[0] - moment) > SAME]
    if not left:
        tracks = tuple(it for it in animation.tracks if it is not track)
        return replaced(scene, animation=replaced(animation, tracks=tracks))
    times, values = zip(*left, strict=True)
    return _with_track(
        scene, animation, track.model_copy(update={"times": times, "values": values})
    )


def frames_of_keys(scene: Scene, keys: Keys | None) -> list[float]:
    """Return the frames at which a value has keys; those of all values for None."""
    animation = scene.animation
    if not animation:
        return []
    tracks = [it for it in animation.tracks if keys is None or it.keys == keys]
    moments = {time for track in tracks for time in track.times}
    return sorted((time - animation.start) * animation.fps for time in moments)


def last_frame(scene: Scene) -> int:
    """Return the last frame that can be shown: a second after the last key, or of `frames`."""
    animation = scene.animation or Animation()
    is_open = animation.frames is None
    return animation.count - 1 + is_open * max(1, round(animation.fps))


def _track(animation: Animation, keys: Keys) -> Track | None:
    return next((track for track in animation.tracks if track.keys == keys), None)


def _with_track(scene: Scene, animation: Animation, track: Track, **keys: Any) -> Scene:
    """Return the scene with other keys of a track, which may be a new one."""
    track = track.model_copy(update=keys)
    tracks = tuple(track if it.keys == track.keys else it for it in animation.tracks)
    if track not in tracks:
        tracks = (*tracks, track)
    return replaced(scene, animation=replaced(animation, tracks=tracks))


def _name_of(scene: Scene, number: int) -> str:
    shape = scene.objects[number]
    names = {it.name for it in scene.objects if it.name}
    return shape.name or free_name(shape.shape, names)


def _numbers(part: BaseModel) -> Iterator[str]:
    return (name for name, value in part if _is_number(value))


def _is_number(value: Any) -> bool:
    if isinstance(value, tuple):
        return 0 < len(value) <= MOST_NUMBERS and all(map(_is_number, value))
    return isinstance(value, int | float) and not isinstance(value, bool)


def _length(value: Any) -> int:
    return len(value) if isinstance(value, tuple) else 0
