"""The part of the panel that edits the selected object and its material."""

from collections import Counter
from dataclasses import replace
from functools import partial
from typing import Any

from imgui_bundle import hello_imgui, imgui

from glrt.scene.conductors import PRESETS
from glrt.scene.cone import Cone
from glrt.scene.materials import Light, Material, Metal, Opaque, Principled
from glrt.scene.scene import Scene
from glrt.scene.shapes import Shape
from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.memo import kept_for_the_same
from glrt.view.panels.widgets import edited, edited_fields, tag, tip
from glrt.view.state.controls import Control, controls_of, replaced, switch
from glrt.view.viewport.transform import with_object

_NONE = "nothing"
_OF_TEXTURE = ("rotation", "filter", "strength")  # what a widget edits of a texture
_MATERIAL = "of this object; compiles where the kernel lacks it, and else restarts the picture"
_WAYS = ("color", "preset", "ior", "k")  # in which metal may say what it reflects
_DOWN = (0.0, -1.0, 0.0)
CONE = switch("cone", "light a cone of directions alone: a spot", Cost.RECOMPILE)
_REFLECTS = "how it is said what the metal reflects: by a colour, a measured metal, or its index"
REFLECTS = Control(
    "reflects",
    "choice",
    _REFLECTS,
    Cost.RECOMPILE,
    "",
    None,
    None,
    None,
    ("color", "preset", "ior"),
)
TINTED = switch("tinted", "let the inside of the glass absorb light", Cost.RECOMPILE)
NESTS = switch("nests", "give the glass a priority over other glass", Cost.RECOMPILE)
_OPTIONS: dict[Control, dict[str, Any]] = {  # what begins where a switch is turned on
    TINTED: {"attenuation_color": (0.6, 0.9, 0.7), "attenuation_distance": 1.0},
    NESTS: {"priority": 0},
}
MATERIAL = Control("material", "choice", _MATERIAL, Cost.RECOMPILE, "", None, None, None)


def draw_object(app: App) -> None:
    """Which object is selected, its shape and its material."""
    _chooser(app)
    shape = app.selected_shape
    if shape is None or app.selected is None:
        imgui.text_disabled("click an object in the picture")
        return
    _buttons(app, shape)
    _shape(app, app.selected, shape)
    _material(app, app.selected, shape)


def _chooser(app: App) -> None:
    """A list of all objects, of which those in sight are drawn: there may be thousands."""
    objects, index = app.session.scene.objects, app.selected
    row = 0 if app.selected_shape is None or index is None else index + 1
    imgui.set_next_item_width(hello_imgui.em_size(12))
    if not imgui.begin_combo("object", _row(objects, row)):
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
    """Of the list, whose first row is no object."""
    return _name(number - 1, objects[number - 1]) if number else _NONE


def _name(index: int, shape: Shape) -> str:
    return f"{index}: {shape.name or shape.shape + ' of ' + shape.material}"


def _buttons(app: App, shape: Shape) -> None:
    if imgui.button("frame"):
        app.frame_selected()
    imgui.same_line()
    if imgui.button("focus here"):
        app.focus_on(shape.middle)
    imgui.same_line()
    imgui.text_disabled("handles; Shift scales")
    tip("Drag the handles of the selected object in the picture to move it")
    tag(Cost.RESTART)


def _shape(app: App, index: int, shape: Shape) -> None:
    changes = edited_fields(controls_of(type(shape)), dict(shape), f"shape {index}")
    if changes:
        app.edit_scene(f"object {index} {list(changes)}", partial(_reshaped, index, changes))


def _reshaped(index: int, changes: dict[str, Any], scene: Scene) -> Scene:
    return with_object(scene, index, replaced(scene.objects[index], **changes))


def _material(app: App, index: int, shape: Shape) -> None:
    scene, name = app.session.scene, shape.material
    names = list(scene.materials)
    chosen = edited(replace(MATERIAL, choices=tuple(names)), name)
    if chosen is not None:
        app.edit_scene("", partial(_reshaped, index, {"material": chosen}))
        return
    sharing = _uses(scene.objects)[name]
    group = scene.finish(shape).group
    light = f", light group {group}" if group else ""
    imgui.text_disabled(f"{scene.materials[name].type}, of {sharing} object(s){light}")
    material = scene.materials[name]
    if wanted := _another_way(material, name):
        app.edit_scene("", partial(with_material, name=name, **wanted))
        return
    changes = edited_fields(_controls(material), dict(material), f"material {name}")
    if changes:
        app.edit_scene(f"{name} {list(changes)}", partial(with_material, name=name, **changes))
    elif isinstance(material, Opaque) and material.emits:
        _cone(app, name, material.cone)
    if isinstance(material, Opaque) and not changes:
        _textures(app, name, material)


def _textures(app: App, name: str, material: Opaque) -> None:
    """How the images of a material lie on its surfaces; the values above are their factors."""
    for key, texture in material.textures.items():
        imgui.separator_text(f"{key}: {texture.told}")
        names = _OF_TEXTURE if texture.image is not None else _OF_TEXTURE[:1]
        controls = tuple(c for c in controls_of(type(texture)) if c.name in names)
        changes = edited_fields(controls, dict(texture), f"{key} of {name}")
        if changes:
            edit = partial(with_texture, name=name, key=key, changes=changes)
            app.edit_scene(f"{name} {key} {list(changes)}", edit)


def _another_way(material: Material, name: str) -> dict[str, Any]:
    """Fields to set, or to leave open, as the user has just chosen."""
    label = f"material {name}"
    if isinstance(material, Metal):
        way = next(way for way in REFLECTS.choices if getattr(material, way) is not None)
        other = edited(REFLECTS, way, label)
        return {} if other is None else _reflecting(material, other)
    changes: dict[str, Any] = {}
    for control, start in _OPTIONS.items():
        if all(hasattr(material, field) for field in start):
            is_on = all(getattr(material, field) is not None for field in start)
            wanted = edited(control, is_on, label)
            if wanted is not None:
                changes |= start if wanted else dict.fromkeys(start)
    return changes


def _cone(app: App, name: str, cone: Cone | None) -> None:
    """Whether a lamp lights a cone alone, and which."""
    wanted = edited(CONE, cone is not None, name)
    if wanted is not None:
        new = Cone(axis=_DOWN) if wanted else None
        app.edit_scene("", partial(with_material, name=name, cone=new))
    elif cone and (changes := edited_fields(controls_of(Cone), dict(cone), f"cone {name}")):
        edit = partial(with_cone, name=name, changes=changes)
        app.edit_scene(f"cone {name} {list(changes)}", edit)


@kept_for_the_same
def _uses(objects: tuple[Shape, ...]) -> Counter[str]:
    """How many objects each material is of."""
    return Counter(shape.material for shape in objects)


def _controls(material: Material) -> tuple[Control, ...]:
    """Of what is given; the emission of lamps stands with the light groups.

    Glass that becomes rough is another kernel.
    """
    is_lamp = isinstance(material, Light)
    open_ = (name for name, value in material if value is None or (is_lamp and name == "emission"))
    controls = controls_of(type(material), tuple(open_))
    if not isinstance(material, Principled) or not material.transmission:
        return controls
    return tuple(c.costing(Cost.RECOMPILE) if c.name == "roughness" else c for c in controls)


def _reflecting(metal: Metal, way: str) -> dict[str, Any]:
    """What says in another way what a metal reflects, as near to before as can be."""
    index = metal.conductor or PRESETS["gold"]
    ways: dict[str, dict[str, Any]] = {
        "color": {"color": metal.head_on},
        "preset": {"preset": metal.preset or "gold"},
        "ior": {"ior": index.ior, "k": index.k},
    }
    return {**dict.fromkeys(_WAYS), **ways[way]}


def with_material(scene: Scene, name: str, **changes: Any) -> Scene:
    """The scene with other values of a material."""
    material = replaced(scene.materials[name], **changes)
    return replaced(scene, materials={**scene.materials, name: material})


def with_texture(scene: Scene, name: str, key: str, changes: dict[str, Any]) -> Scene:
    """The scene with other values of a texture of a material."""
    material = scene.materials[name]
    field = key if key == "normal" else f"{key}_map"
    return with_material(scene, name, **{field: replaced(getattr(material, field), **changes)})


def with_cone(scene: Scene, name: str, changes: dict[str, Any]) -> Scene:
    """The scene with another cone of a material: neither half angle passes the other."""
    material = scene.materials[name]
    if not isinstance(material, Opaque) or material.cone is None:
        return scene
    if "inner" in changes:
        changes = {"outer": max(material.cone.outer, changes["inner"]), **changes}
    elif "outer" in changes:
        changes = {"inner": min(material.cone.inner, changes["outer"]), **changes}
    return with_material(scene, name, cone=replaced(material.cone, **changes))
