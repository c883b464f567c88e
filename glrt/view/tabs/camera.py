"""Part `Camera`: the camera, and what is shown while it moves."""

from functools import partial
from typing import Any

from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.view.app import App
from glrt.view.controls import controls_of, replaced
from glrt.view.tabs.kept import MOVING, PREFERENCES, preferences_rows
from glrt.view.widgets.fields import button, edited_fields

CAMERA = {c.name: c for c in controls_of(Camera)}


def _with_camera(scene: Scene, **changes: Any) -> Scene:
    return replaced(scene, camera=replaced(scene.camera, **changes))


def _numbers(camera: Camera) -> dict[str, Any]:
    """Return the fields of a camera, with the distance to which it is in focus."""
    return {**dict(camera), "focus_distance": camera.resolved_focus_distance}


def draw_camera(app: App) -> None:
    """Draw the values of the camera, and how it moves."""
    camera = app.camera
    values = _numbers(camera)
    blurs = ("shutter",) if app.session.scene.animation else ()
    names = ("fov", "focus_distance", "defocus_angle", *blurs, "position", "look_at")
    controls, opened = tuple(CAMERA[name] for name in names), app.session.opened.scene.camera
    changes = edited_fields(controls, values, opened=_numbers(opened))
    if changes:
        app.edit_scene(f"camera {list(changes)}", partial(_with_camera, **changes))
    if camera.focus_distance is not None and button("focus on look at"):
        app.edit_scene("", partial(_with_camera, focus_distance=None))
    if button("home"):
        app.home()
    preferences_rows(app, [c for c in PREFERENCES if c.name in MOVING])
