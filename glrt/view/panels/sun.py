"""Section of the panel for the sun."""

from dataclasses import replace
from functools import partial
from typing import Any

from glrt.scene.lights.sun import Sun
from glrt.scene.scene import Scene
from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.controls import controls_of, replaced, switch
from glrt.view.widgets.fields import edited, edited_fields

SUN = {c.name: c for c in controls_of(Sun)}
SHINES = switch("sun", "a disc at infinity, which is sampled", Cost.RECOMPILE)
_FIRST = Sun(elevation=40, azimuth=30, irradiance=(3.0, 2.8, 2.5))


def draw_sun(app: App) -> None:
    """Draw the switch of the sun, and its direction, size and brightness."""
    sun = app.session.scene.sun
    wanted = edited(SHINES, sun is not None)
    if wanted is not None:
        app.edit_scene("", partial(replaced, sun=_FIRST if wanted else None))
    if sun is None:
        return
    values: dict[str, Any] = {name: value for name, value in sun if value is not None}
    if sun.direction is None:
        values = {"elevation": sun.elevation, "azimuth": sun.azimuth or 0.0, **values}
    rows = [SUN[name] for name in values]
    if app.session.scene.background.sky:  # which needs the sun above the horizon
        rows = [
            replace(row, low=0.0, slider=(0, 90)) if row.name == "elevation" else row
            for row in rows
        ]
    changes = edited_fields(tuple(rows), values, "sun", app.session.opened.scene.sun)
    if changes:
        app.edit_scene(f"sun {list(changes)}", partial(_with_sun, **changes))


def _with_sun(scene: Scene, **changes: Any) -> Scene:
    return replaced(scene, sun=replaced(scene.sun or _FIRST, **changes))
