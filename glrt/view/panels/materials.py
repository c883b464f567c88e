"""Section of the panel that edits the material of the selected object."""

from collections import Counter
from dataclasses import replace
from functools import partial
from typing import Any

from imgui_bundle import imgui

from glrt.core.memo import kept_for_the_same
from glrt.scene.lights.cone import Cone
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.conductors import PRESETS
from glrt.scene.materials.kinds import TYPES, Material
from glrt.scene.materials.light import Light
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.scene.shapes.kinds import Shape
from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.controls import Control, choice, controls_of, replaced, switch
from glrt.view.edits.ready_materials import READY, ready_name, with_ready
from glrt.view.edits.scene_edits import (
    unused_materials,
    with_cone,
    with_material,
    with_new_material,
    with_objects,
    with_own_material,
    with_renamed_material,
    with_retyped,
    with_texture,
    without_unused_materials,
)
from glrt.view.panels.lights import draw_lamp
from glrt.view.widgets.fields import beside, button, edited, edited_fields, named, tip

_OF_TEXTURE = ("rotation", "filter", "strength")  # editable fields of a texture
_MATERIAL = "of this object; compiles where the kernel lacks it, and else restarts the picture"
_WAYS = ("color", "preset", "ior", "k")  # fields that may describe the reflectance of metal
_DOWN = (0.0, -1.0, 0.0)
CONE = switch("cone", "light a cone of directions alone: a spot", Cost.RECOMPILE)
_REFLECTS = "how it is said what the metal reflects: by a colour, a measured metal, or its index"
REFLECTS = choice("reflects", _REFLECTS, Cost.RECOMPILE, ("color", "preset", "ior"))
TINTED = switch("tinted", "let the inside of the glass absorb light", Cost.RECOMPILE)
NESTS = switch("nests", "give the glass a priority over other glass", Cost.RECOMPILE)
_OPTIONS: dict[Control, dict[str, Any]] = {  # values that a switch sets when it is turned on
    TINTED: {"attenuation_color": (0.6, 0.9, 0.7), "attenuation_distance": 1.0},
    NESTS: {"priority": 0},
}
_TYPE = "what kind of surface it is; the values that both kinds have stay"
_KINDS = {
    "lambertian": "matte",
    "metal": "mirror, gold",
    "dielectric": "glass, water",
    "principled": "plastic, paint",
    "light": "a lamp",
    "none": "no surface",
}
TYPE = replace(
    choice("type", _TYPE, Cost.RECOMPILE, tuple(TYPES)), told=tuple(_KINDS[kind] for kind in TYPES)
)
_READY = "values of a common metal, glass, plastic or paint, in place of those below"
READY_MADE = replace(
    choice("ready-made", _READY, Cost.RECOMPILE, tuple(READY)),
    told=tuple(_KINDS[ready.type] for ready in READY.values()),
)
MATERIAL = choice("material", _MATERIAL, Cost.RECOMPILE)


def draw_material(app: App, index: int, shape: Shape) -> None:
    """Draw the choice of the object's material, and the values of that material."""
    scene, name = app.session.scene, shape.material
    kinds = tuple(material.type for material in scene.materials.values())
    chosen = edited(replace(MATERIAL, choices=tuple(scene.materials), told=kinds), name)
    if chosen is not None:
        take = partial(replaced, material=chosen)
        app.edit_scene("", partial(with_objects, numbers=app.chosen, make=take))
        return
    if _commands(app, index, name):
        return
    material = scene.materials[name]
    ready = edited(READY_MADE, ready_name(material), f"material {name}")
    kind = edited(TYPE, material.type, f"material {name}")
    if ready is not None:
        app.edit_scene("", partial(with_ready, name=name, ready=ready))
    elif kind is not None:
        app.edit_scene("", partial(with_retyped, name=name, kind=kind))
    elif wanted := _another_way(material, name):
        app.edit_scene("", partial(with_material, name=name, **wanted))
    else:
        _values(app, name, material, scene.finish(shape).group)


def _commands(app: App, index: int, name: str) -> bool:
    """Draw the name of the material and its buttons; return whether the scene was changed."""
    scene = app.session.scene
    renamed = named("name", name, f"material {name}")
    sharing = _uses(scene.objects)[name]
    is_new = button("new##material")
    tip("A matte material of its own for this object")
    beside("make unique")
    is_own = button("make unique", sharing > 1)
    tip("A copy of the material for this object alone; the other objects keep theirs")
    told = f"of {sharing} objects" if sharing > 1 else "of this object alone"
    beside(told)
    imgui.text_disabled(told)
    unused = _unused(scene)
    is_cleared = bool(unused) and _removes(unused)
    if renamed:
        app.edit_scene("", partial(with_renamed_material, old=name, new=renamed))
    elif is_new:
        app.edit_scene("", partial(with_new_material, index=index))
    elif is_own:
        app.edit_scene("", partial(with_own_material, index=index))
    elif is_cleared:
        app.edit_scene("", without_unused_materials)
    return bool(renamed) or is_new or is_own or is_cleared


_unused = kept_for_the_same(unused_materials)


def _removes(unused: list[str]) -> bool:
    """Draw the button that removes unused materials; return whether it was pressed."""
    label = f"remove {len(unused)} unused"
    beside(label)
    is_pressed = button(f"{label}###remove unused")
    tip(f"Materials that no object has: {', '.join(unused[:10])}")
    return is_pressed


def _values(app: App, name: str, material: Material, group: str) -> None:
    """Draw the values, cone and textures of a material; `group`: light group of its object."""
    if isinstance(material, Light):
        draw_lamp(app, name, group)
    before = app.session.opened.scene.materials.get(name)
    opened = before if type(before) is type(material) else None
    changes = edited_fields(_controls(material), dict(material), f"material {name}", opened)
    if changes:
        app.edit_scene(f"{name} {list(changes)}", partial(with_material, name=name, **changes))
    elif isinstance(material, Opaque):
        if material.emits:
            _cone(app, name, material.cone)
        _textures(app, name, material)


def _textures(app: App, name: str, material: Opaque) -> None:
    """Draw the placement of a material's textures; the values above are factors of the images."""
    for key, texture in material.textures.items():
        imgui.separator_text(f"{key}: {texture.told}")
        names = _OF_TEXTURE if texture.image is not None else _OF_TEXTURE[:1]
        controls = tuple(c for c in controls_of(type(texture)) if c.name in names)
        changes = edited_fields(controls, dict(texture), f"{key} of {name}")
        if changes:
            edit = partial(with_texture, name=name, key=key, changes=changes)
            app.edit_scene(f"{name} {key} {list(changes)}", edit)


def _another_way(material: Material, name: str) -> dict[str, Any]:
    """Draw the choices of optional fields; return the fields to set, or to clear with None."""
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
    """Draw the switch of a lamp's cone, and its values if it is on."""
    wanted = edited(CONE, cone is not None, name)
    if wanted is not None:
        new = Cone(axis=_DOWN) if wanted else None
        app.edit_scene("", partial(with_material, name=name, cone=new))
    elif cone and (changes := edited_fields(controls_of(Cone), dict(cone), f"cone {name}")):
        edit = partial(with_cone, name=name, changes=changes)
        app.edit_scene(f"cone {name} {list(changes)}", edit)


@kept_for_the_same
def _uses(objects: tuple[Shape, ...]) -> Counter[str]:
    """Return the number of objects that use each material."""
    return Counter(shape.material for shape in objects)


def _controls(material: Material) -> tuple[Control, ...]:
    """Return the controls of fields that are set; the emission of lamps is drawn by `draw_lamp`.

    A change of the roughness of transmissive materials compiles another kernel.
    """
    is_lamp = isinstance(material, Light)
    open_ = (name for name, value in material if value is None or (is_lamp and name == "emission"))
    controls = controls_of(type(material), tuple(open_))
    if not isinstance(material, Principled) or not material.transmission:
        return controls
    return tuple(c.costing(Cost.RECOMPILE) if c.name == "roughness" else c for c in controls)


def _reflecting(metal: Metal, way: str) -> dict[str, Any]:
    """Return fields that describe a metal in another way, as close to its look as possible."""
    index = metal.conductor or PRESETS["gold"]
    ways: dict[str, dict[str, Any]] = {
        "color": {"color": metal.head_on},
        "preset": {"preset": metal.preset or "gold"},
        "ior": {"ior": index.ior, "k": index.k},
    }
    return {**dict.fromkeys(_WAYS), **ways[way]}
