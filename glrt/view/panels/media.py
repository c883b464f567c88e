"""The medium in the selected object: which one, and its values."""

from dataclasses import replace
from functools import partial

from imgui_bundle import imgui

from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.nothing import Nothing
from glrt.scene.medium import Medium
from glrt.scene.shapes.kinds import Shape
from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.controls import choice, controls_of
from glrt.view.edits.media_edits import with_fog, with_medium, with_medium_of
from glrt.view.widgets.cost_badges import tag
from glrt.view.widgets.fields import button, edited, edited_fields, tip

_VACUUM = "vacuum"
MEDIUM = choice("medium inside", "what fills the object", Cost.RECOMPILE)
VALUES = controls_of(Medium)


def draw_medium(app: App, index: int, shape: Shape) -> None:
    """Draw the choice of the medium in an object that encloses one, and its values."""
    if not shape.encloses:
        return
    scene = app.session.scene
    material = scene.materials[shape.material]
    can_hold = isinstance(material, Nothing) or (
        isinstance(material, Dielectric) and not material.thin
    )
    if not can_hold or not scene.media:
        if button("fill with fog"):
            app.edit_scene("", partial(with_fog, index=index))
        tip("Fog in place of the object, whose surface becomes its bounds")
        tag(Cost.RECOMPILE)
        return
    names = (_VACUUM, *scene.media)
    chosen = edited(replace(MEDIUM, choices=names), shape.medium or _VACUUM, f"shape {index}")
    if chosen is not None:
        name = None if chosen == _VACUUM else chosen
        app.edit_scene("", partial(with_medium_of, index=index, name=name))
    elif shape.medium is not None:
        _values(app, shape.medium)


def _values(app: App, name: str) -> None:
    imgui.separator_text(f"medium {name}")
    medium, opened = app.session.scene.media[name], app.session.opened.scene.media.get(name)
    changes = edited_fields(VALUES, dict(medium), f"medium {name}", opened)
    if changes:
        app.edit_scene(f"{name} {list(changes)}", partial(with_medium, name=name, **changes))
