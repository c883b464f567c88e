"""The motion of the camera of a glTF file, and the shape of its picture."""

from typing import Any, TypeVar

from glrt.scene.animation.tracks import Animation, Track
from glrt.scene.schema.fields import SceneFields
from glrt.scene.schema.validation import validated

SceneType = TypeVar("SceneType", bound=SceneFields)

EDGE = 512  # longer edge of a picture, pixels
TIME = ("camera", "time")  # keys of the track by which a camera of a file moves


def with_camera_of_file(scene: SceneType, source: str) -> SceneType:
    """Return the scene with what the file of its camera gives and the scene does not.

    That is the size of the picture where it has neither width nor height, and a track of
    `camera.time` where the file moves the camera and the scene states neither `time` nor a track.
    Raises `SceneError` for a motion of too many frames.
    """
    camera, update = scene.camera, dict[str, Any]()
    found = camera.in_file
    if found is None:
        return scene
    if found.aspect and not scene.render.model_fields_set & {"width", "height"}:
        update["render"] = scene.render.model_copy(update=picture_size(found.aspect))
    name = camera.animation or found.usual
    seconds = found.seconds(name) if name is not None else 0.0
    own = scene.animation or Animation()
    if seconds > 0 and camera.time is None and TIME not in (track.keys for track in own.tracks):
        tracks = (*own.tracks, track_of_time(seconds))
        where = f"{source}: animation"
        update["animation"] = validated(Animation, {**dict(own), "tracks": tracks}, where)
    return scene.model_copy(update=update) if update else scene


def track_of_time(seconds: float, target: tuple[str, ...] = TIME) -> Track:
    """Return the track of a time that runs from 0 to a number of seconds."""
    return Track(target=".".join(target), times=(0.0, seconds), values=(0.0, seconds))


def picture_size(aspect: float) -> dict[str, int]:
    """Return width and height in pixels of a picture of a width over height; the longer: EDGE."""
    longest = max(aspect, 1.0)
    width, height = (max(round(EDGE * edge / longest), 1) for edge in (aspect, 1.0))
    return {"width": width, "height": height}
