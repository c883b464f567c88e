"""The medium in the selected object: which one, and its values."""

from dataclasses import replace
from functools import partial
from pathlib import Path

from imgui_bundle import imgui

from glrt.core.text import escaped
from glrt.scene.density import Density
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.nothing import Nothing
from glrt.scene.medium import Medium
from glrt.scene.shapes.kinds import Shape
from glrt.scene.transfer import MOST_OPACITY, Transfer
from glrt.scene.values import LARGEST
from glrt.settings import Cost
from glrt.view import file_dialogs
from glrt.view.app import App
from glrt.view.controls import Control, choice, controls_of, switch
from glrt.view.edits.grid_files import with_grid_file
from glrt.view.edits.media_edits import (
    knots_of,
    with_fog,
    with_knot,
    with_medium,
    with_medium_of,
    with_medium_part,
    with_priority,
    with_transfer,
)
from glrt.view.widgets.cost_badges import tag
from glrt.view.widgets.fields import button, edited, edited_fields, tip

_VACUUM = "vacuum"
MEDIUM = choice("medium inside", "what fills the object", Cost.RECOMPILE)
RANKED = switch(
    "has priority", "the volume takes the place of others that it overlaps", Cost.RECOMPILE
)
VALUES = controls_of(Medium)
SCALE = controls_of(Density, ("min", "max"))
LENGTH = controls_of(Transfer)
VALUE = Control("value", "number", "density of the knot, between its neighbours", Cost.RESTART)
COLOR = Control("color", "color", "radiance of what is opaque", Cost.RESTART, low=0, high=LARGEST)
OPACITY = Control(
    "opacity",
    "number",
    "share of light that is lost over `length`",
    Cost.RESTART,
    low=0,
    high=MOST_OPACITY,
    slider=(0, 1),
)
COLORED = switch("colour by density", "show the grid by a transfer function", Cost.RECOMPILE)


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
    is_ranked = edited(RANKED, shape.priority is not None, f"shape {index}")
    if is_ranked is not None:
        priority = 0 if is_ranked else None
        app.edit_scene("", partial(with_priority, index=index, priority=priority))
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
    _grid(app, name)
    if medium.density:
        _scale(app, name, medium.density)
        is_colored = edited(COLORED, medium.transfer is not None, name)
        if is_colored is not None:
            app.edit_scene("", partial(with_transfer, name=name, is_on=is_colored))
            return
    if medium.transfer:
        _knots(app, name, medium.transfer)
        return
    changes = edited_fields(VALUES, dict(medium), f"medium {name}", opened)
    if changes:
        app.edit_scene(f"{name} {list(changes)}", partial(with_medium, name=name, **changes))


def _grid(app: App, name: str) -> None:
    """Draw the choice of a file of densities."""
    density = app.session.scene.media[name].density
    if density:
        imgui.text_wrapped(escaped(density.file.file))
    if button("another grid..." if density else "grid..."):
        use = partial(_take_grid, app, name)
        app.files.dialogs.ask_open("Choose a grid of densities", file_dialogs.GRIDS, use)
    tip("The density varies as in a file of NumPy, NanoVDB or OpenVDB")
    tag(Cost.RECOMPILE)


def _take_grid(app: App, name: str, path: str) -> None:
    app.edit_scene("", partial(with_grid_file, name=name, path=Path(path)))


def _scale(app: App, name: str, density: Density) -> None:
    """Draw the factor of the densities of a grid."""
    changes = edited_fields(SCALE, dict(density), f"density {name}")
    if changes:
        edit = partial(with_medium_part, name=name, key="density", changes=changes)
        app.edit_scene(f"{name} {list(changes)}", edit)


def _knots(app: App, name: str, transfer: Transfer) -> None:
    """Draw the knots of a transfer function."""
    changes = edited_fields(LENGTH, dict(transfer), f"transfer {name}")
    if changes:
        edit = partial(with_medium_part, name=name, key="transfer", changes=changes)
        app.edit_scene(f"{name} {list(changes)}", edit)
    ends = (-LARGEST, *transfer.values, LARGEST)
    for number, knot in enumerate(knots_of(transfer)):
        imgui.separator_text(f"knot {number + 1}")
        value = replace(VALUE, low=ends[number], high=ends[number + 2])
        new = edited_fields((value, COLOR, OPACITY), knot, f"{name} {number}")
        if new:
            edit = partial(with_knot, name=name, number=number, **new)
            app.edit_scene(f"{name} {number} {list(new)}", edit)
