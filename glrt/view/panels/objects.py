"""Section of the panel that adds objects and edits the selected one."""

from collections import Counter
from functools import partial
from pathlib import Path
from typing import Any

from imgui_bundle import imgui

from glrt.core.memo import kept_for_the_same
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from glrt.settings import Cost
from glrt.view import file_dialogs
from glrt.view.app import App
from glrt.view.controls import choice, controls_of, replaced
from glrt.view.edits.new_objects import ADDED
from glrt.view.edits.scene_edits import opened_shape, with_object, with_own_group
from glrt.view.outliner.listing import OUTLINER
from glrt.view.panels.materials import draw_material
from glrt.view.panels.media import draw_medium
from glrt.view.widgets.cost_badges import tag
from glrt.view.widgets.fields import beside, button, edited, edited_fields, named, tip
from glrt.view.widgets.rows import WORDS, Row
from glrt.view.widgets.steady_widget import ANCHOR

_NONE = "nothing"
_HANDLES = "what a drag of the handles in the picture does to the object; with Shift it scales it"
HANDLES = choice("handles", _HANDLES, Cost.RESTART, ("move", "turn"))


def draw_object(app: App) -> None:
    """Draw the choice of the object, and the shape and the material of the selected one."""
    if app.is_to_be_seen:
        if not OUTLINER.is_first:
            ANCHOR.go_here()
        app.is_to_be_seen = OUTLINER.is_first = False
    _chooser(app)
    _commands(app)
    shape = app.selected_shape
    if shape is None or app.selected is None:
        imgui.text_disabled("click an object in the picture")
        return
    _buttons(app, shape)
    imgui.begin_disabled(app.is_locked)
    if len(app.chosen) > 1:
        imgui.text_disabled(f"{len(app.chosen)} selected, moved and deleted together")
    _name_of(app, app.selected, shape)
    _shape(app, app.selected, shape)
    draw_medium(app, app.selected, shape)
    imgui.separator_text(f"material of {_name(app.selected, shape)}")
    draw_material(app, app.selected, shape)
    imgui.end_disabled()


def _chooser(app: App) -> None:
    """Draw a list of all objects; only the visible rows are drawn, as there may be thousands."""
    objects, index = app.session.scene.objects, app.selected
    row = 0 if app.selected_shape is None or index is None else index + 1
    Row("object", WORDS).draw(lambda: _list(app, objects, row))


def _list(app: App, objects: tuple[Shape, ...], row: int) -> None:
    is_open = imgui.begin_combo("object", _row(objects, row))
    if not is_open:
        ANCHOR.note()
        return
    clipper = imgui.ListClipper()
    clipper.begin(len(objects) + 1)
    clipper.include_item_by_index(row)
    while clipper.step():
        for number in range(clipper.display_start, clipper.display_end):
            imgui.push_id(number)
            if imgui.selectable(_row(objects, number), number == row)[0]:
                app.selected = number - 1 if number else None
            if number == row and imgui.is_window_appearing():
                imgui.set_item_default_focus()
            imgui.pop_id()
    imgui.end_combo()


def _row(objects: tuple[Shape, ...], number: int) -> str:
    """Return the text of a row of the list, whose first row stands for no object."""
    return _name(number - 1, objects[number - 1]) if number else _NONE


def _name(index: int, shape: Shape) -> str:
    return f"{index}: {shape.name or shape.shape + ' of ' + shape.material}"


def _commands(app: App) -> None:
    """Draw the buttons that add an object, and copy or delete the selected one."""
    has_one = app.selected_shape is not None
    if button("add"):
        imgui.open_popup("what to add")
    tip("Adds an object at the pivot, with a material of its own")
    _menu(app)
    beside("duplicate")
    if button("duplicate", has_one):
        app.duplicate()
    tip("A copy above or below it, of the same material")
    beside("delete")
    if button("delete", has_one and not app.is_locked):
        app.delete()
    tag(Cost.RECOMPILE)


def _menu(app: App) -> None:
    if not imgui.begin_popup("what to add"):
        return
    for kind in ADDED:
        if imgui.menu_item_simple(kind):
            app.add(kind)
    if imgui.menu_item_simple("mesh from a file"):
        app.files.dialogs.ask_open("Add a model", file_dialogs.MODELS, partial(_add_from, app))
    imgui.end_popup()


def _buttons(app: App, shape: Shape) -> None:
    if button("frame"):
        app.frame_selected()
    beside("focus here")
    if button("focus here"):
        app.focus_on(shape.middle)
    if app.is_locked:
        beside("unlock")
        if button("unlock"):
            app.session.lock(app.selected or 0, False)
        tip("A lock keeps edits away from the values below; the list of the part Scene locks")
        tag(Cost.FREE)
        return
    handles = edited(HANDLES, app.handles)
    app.handles = app.handles if handles is None else handles


def _name_of(app: App, index: int, shape: Shape) -> None:
    """Draw the name of the object and, of a lamp, its light group."""
    if name := named("name", shape.name or "", f"shape {index}"):
        app.edit_scene("", partial(_reshaped, index, {"name": name}))
    group = app.session.scene.finish(shape).group
    if not group:
        return
    imgui.text_disabled(f"light group {group}")
    beside("own group")
    if button("own group", _lamps_of(app.session.scene)[group] > 1):
        app.edit_scene("", partial(with_own_group, index=index))
    tip("A light group for this object alone, so that it can be dimmed by itself")
    tag(Cost.RECOMPILE)


@kept_for_the_same
def _lamps_of(scene: Scene) -> Counter[str]:
    """Return the number of objects that emit in each light group."""
    return Counter(scene.finish(thing).group for thing in scene.objects)


def _shape(app: App, index: int, shape: Shape) -> None:
    values = dict(shape)
    controls = tuple(it for it in controls_of(type(shape)) if values[it.name] is not None)
    opened = opened_shape(app.session.opened.scene.objects, app.session.scene.objects, index)
    changes = edited_fields(controls, values, f"shape {index}", opened)
    if changes:
        app.edit_scene(f"object {index} {list(changes)}", partial(_reshaped, index, changes))


def _reshaped(index: int, changes: dict[str, Any], scene: Scene) -> Scene:
    return with_object(scene, index, replaced(scene.objects[index], **changes))


def _add_from(app: App, path: str) -> None:
    app.files.add(Path(path))
