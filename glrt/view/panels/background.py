"""Section of the panel for light from infinity: an image, a clear sky, a colour or a gradient."""

from functools import partial
from typing import Any

from imgui_bundle import imgui

from glrt.scene.lights.background import Background
from glrt.scene.lights.clear_sky import ClearSky
from glrt.scene.lights.sun import Sun
from glrt.scene.lit_scene import SKY_GROUP
from glrt.scene.scene import Scene
from glrt.scene.values import Radiance
from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.controls import controls_of, replaced, switch
from glrt.view.file_dialogs import PHOTOS
from glrt.view.state.costs import cost_of_light
from glrt.view.widgets.cost_badges import tag
from glrt.view.widgets.fields import button, edited, edited_fields, tip

BACKGROUND = {c.name: c for c in controls_of(Background)}
SKY = {c.name: c for c in controls_of(ClearSky)}
GRADIENT = switch("gradient", "another colour above than below", Cost.RECOMPILE)
HORIZON = switch("horizon", "a colour of its own between below and above", Cost.RECOMPILE)
_CLEAR = "the sky of a clear day, with the sun that belongs to it; its place is set under Sun"
CLEAR = switch("clear_sky", _CLEAR, Cost.RECOMPILE)
_DULL = (0.5, 0.6, 0.8)  # colour after a clear sky was turned off
_MORNING = Sun(elevation=40.0, azimuth=30.0)


def draw_background(app: App) -> None:
    """Draw the kind of the background and its values."""
    background = app.session.scene.background
    if button("another photo..." if background.image else "photo..."):
        app.files.dialogs.ask_open("Choose an image of radiance", PHOTOS, app.files.ask_open)
    tip("An image of all directions, .hdr or .exr, lights the scene; one may be dropped, too")
    tag(Cost.RECOMPILE)
    if background.image:
        _image(app)
        return
    wanted = edited(CLEAR, background.sky is not None)
    if wanted is not None:
        app.edit_scene("", _under_a_clear_sky if wanted else _under_a_color)
    elif background.sky:
        _sky(app, background.sky)
    else:
        _gradient(app)


def _image(app: App) -> None:
    background = app.session.scene.background
    assert background.image
    imgui.text_wrapped(background.image.file)
    color, *_ = background.gradient
    _edit(app, {"color": color, "rotation": background.rotation or 0.0}, image=background.image)


def _sky(app: App, sky: ClearSky) -> None:
    cost = cost_of_light(app.session, SKY_GROUP)
    rows = tuple(row.costing(cost) if row.name == "scale" else row for row in SKY.values())
    changes = edited_fields(rows, dict(sky), "sky", app.session.opened.scene.background.sky)
    if changes:
        changed = partial(_with_background, sky=replaced(sky, **changes))
        app.edit_scene(f"sky {list(changes)}", changed)


def _gradient(app: App) -> None:
    """Draw one colour, or a gradient from bottom to top, with or without a horizon."""
    background = app.session.scene.background
    bottom, *_, top = background.gradient
    values = {name: value for name, value in background if value is not None}
    _edit(app, values or {"color": bottom})
    ends: dict[str, Any] = {"bottom": bottom, "top": top}
    wanted = edited(GRADIENT, background.top is not None)
    if wanted is not None:
        other: dict[str, Any] = ends if wanted else {"color": top}
        app.edit_scene("", partial(_with_background, **other))
    if background.top is None:
        return
    wanted = edited(HORIZON, background.horizon is not None)
    if wanted is not None:
        other = {**ends, "horizon": _between(bottom, top)} if wanted else ends
        app.edit_scene("", partial(_with_background, **other))


def _edit(app: App, values: dict[str, Any], **kept: Any) -> None:
    """Draw widgets for `values`; after an edit, the background has these keys and `kept` alone."""
    controls, opened = (BACKGROUND[name] for name in values), app.session.opened.scene.background
    changes = edited_fields(tuple(controls), values, "background", opened)
    if changes:
        app.edit_scene("background", partial(_with_background, **{**kept, **values, **changes}))


def _with_background(scene: Scene, **keys: Any) -> Scene:
    return replaced(scene, background=replaced(Background(), **keys))


def _under_a_clear_sky(scene: Scene) -> Scene:
    """Return the scene with a clear sky; a sun keeps its place, with the model's irradiance."""
    sun = replaced(scene.sun, irradiance=None) if scene.sun else _MORNING
    return replaced(scene, background=Background(sky=ClearSky()), sun=sun)


def _under_a_color(scene: Scene) -> Scene:
    """Return the scene with a background of one colour; the sun stays as bright as it was."""
    sun = scene.sun and replaced(scene.sun, irradiance=scene.sun_irradiance)
    return replaced(scene, background=Background(color=_DULL), sun=sun)


def _between(bottom: Radiance, top: Radiance) -> Radiance:
    """Return the middle of a gradient: as a horizon it changes nothing."""
    red, green, blue = (0.5 * (low + high) for low, high in zip(bottom, top, strict=True))
    return (red, green, blue)
