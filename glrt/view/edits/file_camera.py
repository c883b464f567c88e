"""A camera that a glTF file gives: what a reload of the scene shows, and what a save writes."""

from typing import Any

from glrt.scene.camera import OF_FILE, Camera
from glrt.scene.loading.file_camera import TIME
from glrt.scene.scene import Scene
from glrt.view.controls import replaced

LOOKS = (*OF_FILE, "focus_distance", "defocus_angle")
PLACE = ("position", "look_at", "up")


def seen_as_before(found: Scene, camera: Camera) -> Scene:
    """Return a scene that was read again, seen by the camera of the window.

    Where that follows a file, the camera is that of the file as it is now.
    """
    looks = {name: value for name, value in camera if name in LOOKS}
    return replaced(found, camera=replaced(found.camera, **looks))


def to_be_saved(scene: Scene, opened: Camera) -> Scene:
    """Return the scene that a save writes; `opened` is the camera of the scene as it was opened.

    A camera that its file moves keeps the place that it was opened with: a place of its own, to
    which the user moved it in the window, would hold it there in a film.
    """
    camera = scene.camera
    if TIME not in (track.keys for track in (scene.animation.tracks if scene.animation else ())):
        return scene
    fields: dict[str, Any] = {name: value for name, value in camera if name not in PLACE}
    fields |= {name: value for name, value in opened if name in PLACE}
    return replaced(scene, camera=Camera.model_validate(fields))
