"""Edits of a scene by pure functions: a scene in, the edited one out.

They raise `UsageError` where the result would not be a valid scene.
"""

from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Any

from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import TYPES, Material
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.nothing import Nothing
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from glrt.view.controls import made, replaced

_STARTS: dict[str, Any] = {  # of values that the former type does not have
    "color": (0.7, 0.7, 0.7),
    "emission": (8.0, 8.0, 8.0),
}
_WAYS_OF_METAL = ("preset", "ior", "k")  # not kept when a material becomes metal, or was it


def with_object(scene: Scene, index: int, shape: Shape) -> Scene:
    """Return the scene with another shape in place of object `index`."""
    objects = (*scene.objects[:index], shape, *scene.objects[index + 1 :])
    return replaced(scene, objects=objects)


def with_added(scene: Scene, shape: Shape, material: Material | None = None) -> Scene:
    """Return the scene with one more shape at the end, and `material` under the name it uses."""
    new = {} if material is None else {shape.material: material}
    return replaced(scene, objects=(*scene.objects, shape), materials={**scene.materials, **new})


def with_duplicate(scene: Scene, index: int, moved: Shape | None = None) -> Scene:
    """Return the scene with a copy of object `index` at the end, or `moved`, under a free name."""
    shape = moved or scene.objects[index]
    if shape.name:
        shape = replaced(shape, name=free_name(shape.name, _names(scene)))
    return with_added(scene, shape)


def without_objects(scene: Scene, numbers: Collection[int]) -> Scene:
    """Return the scene without some objects; their materials stay."""
    left = (shape for number, shape in enumerate(scene.objects) if number not in numbers)
    return replaced(scene, objects=tuple(left))


def with_objects(scene: Scene, numbers: Collection[int], make: Callable[[Shape], Shape]) -> Scene:
    """Return the scene with some objects replaced by what `make` makes of them."""
    objects = enumerate(scene.objects)
    new = tuple(make(shape) if number in numbers else shape for number, shape in objects)
    return replaced(scene, objects=new)


def with_material(scene: Scene, name: str, **changes: Any) -> Scene:
    """Return the scene with other values of a material."""
    return _with_materials(scene, {name: replaced(scene.materials[name], **changes)})


def with_retyped(scene: Scene, name: str, kind: str) -> Scene:
    """Return the scene with another type of a material; values that both types have stay."""
    if TYPES[kind] not in (Dielectric, Nothing):  # light does not enter other materials
        emptied = (
            replaced(it, medium=None, priority=None) if it.material == name else it
            for it in scene.objects
        )
        scene = scene.model_copy(update={"objects": tuple(emptied)})
    return _with_materials(scene, {name: retyped(scene.materials[name], kind)})


def retyped(material: Material, kind: str) -> Material:
    """Return a material of another type; values that both types have stay."""
    if kind == material.type:
        return material
    model = TYPES[kind]
    fields = model.model_fields
    kept = {key: value for key, value in _kept(material, kind).items() if key in fields}
    needed = {key: start for key, start in _STARTS.items() if _is_needed(model, key)}
    result: Material = made(model, {**needed, **kept})
    return result


def _kept(material: Material, kind: str) -> dict[str, Any]:
    """Return the values that a material keeps when its type becomes `kind`."""
    kept = {key: value for key, value in material if key != "type" and value is not None}
    if "metal" in (kind, material.type):
        kept = {key: value for key, value in kept.items() if key not in _WAYS_OF_METAL}
    if isinstance(material, Metal):
        kept["color"] = material.head_on
    if not material.emits or material.type == "light":  # a former lamp does not shine
        kept.pop("emission", None)
    if not any(kept.get("color", ())):
        kept.pop("color", None)
    return kept


def _is_needed(model: type[Material], key: str) -> bool:
    """Whether a type of material needs a value; metal needs one of several, here a colour."""
    field = model.model_fields.get(key)
    return field is not None and (field.is_required() or (model is Metal and key == "color"))


def with_own_material(scene: Scene, index: int) -> Scene:
    """Return the scene with a copy of its material for object `index` alone."""
    shape = scene.objects[index]
    name = free_name(shape.material, scene.materials)
    copied = _with_materials(scene, {name: scene.materials[shape.material]})
    return with_object(copied, index, replaced(shape, material=name))


def with_new_material(scene: Scene, index: int) -> Scene:
    """Return the scene with a new matte material for object `index`."""
    name = free_name("material", scene.materials)
    matte = Lambertian(color=_STARTS["color"])
    shape = replaced(scene.objects[index], material=name)
    objects = (*scene.objects[:index], shape, *scene.objects[index + 1 :])
    return replaced(scene, objects=objects, materials={**scene.materials, name: matte})


def with_renamed_material(scene: Scene, old: str, new: str) -> Scene:
    """Return the scene with a renamed material; its objects and its light group follow."""
    if new == old:
        return scene
    new = free_name(new, scene.materials)
    materials = {new if name == old else name: m for name, m in scene.materials.items()}
    objects = tuple(
        replaced(shape, material=new) if shape.material == old else shape for shape in scene.objects
    )
    lights = dict(scene.lights)
    material = scene.materials[old]
    if isinstance(material, Opaque) and material.group is None and old in lights:
        lights[new] = lights.pop(old)
    return replaced(scene, materials=materials, objects=objects, lights=lights)


def without_unused_materials(scene: Scene) -> Scene:
    """Return the scene without materials that no object has, and without their light groups."""
    used = {shape.material for shape in scene.objects}
    kept = {name: m for name, m in scene.materials.items() if name in used}
    groups = scene.model_copy(update={"materials": kept}).light_groups
    lights = {group: value for group, value in scene.lights.items() if group in groups}
    return replaced(scene, materials=kept, lights=lights)


def unused_materials(scene: Scene) -> list[str]:
    """Return the names of materials that no object has."""
    used = {shape.material for shape in scene.objects}
    return [name for name in scene.materials if name not in used]


def with_own_group(scene: Scene, index: int) -> Scene:
    """Return the scene with a light group for the emission of object `index` alone."""
    shape = scene.objects[index]
    name = free_name(shape.name or shape.material, scene.light_groups)
    return with_object(scene, index, replaced(shape, group=name))


def found_again(
    before: tuple[Shape, ...], after: tuple[Shape, ...], selected: int | None
) -> int | None:
    """Return the new number of the selected object; without one, that of a single new object."""
    if selected is not None and selected < len(before):
        if len(before) == len(after):
            return selected
        return next((n for n, shape in enumerate(after) if shape is before[selected]), None)
    known = set(map(id, before))
    new = [number for number, shape in enumerate(after) if id(shape) not in known]
    return new[0] if len(after) == len(before) + 1 and len(new) == 1 else None


def opened_shape(opened: tuple[Shape, ...], now: tuple[Shape, ...], index: int) -> Shape | None:
    """Return object `index` of the scene as the scene was opened; None if none is known.

    It has the same name. Without a name it has the same number, if no objects came or went.
    """
    shape = now[index]
    same = opened[index : index + 1] if len(opened) == len(now) else ()
    if shape.name and not (same and same[0].name == shape.name):
        same = tuple(it for it in opened if it.name == shape.name)
    is_known = len(same) == 1 and same[0].name == shape.name and type(same[0]) is type(shape)
    return same[0] if is_known else None


def free_name(wanted: str, taken: Iterable[str]) -> str:
    """Return the name, with a number appended if it is taken: "ball", "ball 2", "ball 3"."""
    names = set(taken)
    stem, _, last = wanted.rpartition(" ")
    stem, number = (stem, int(last)) if stem and last.isdecimal() else (wanted, 1)
    name = wanted
    while name in names:
        number += 1
        name = f"{stem} {number}"
    return name


def _names(scene: Scene) -> set[str]:
    return {shape.name for shape in scene.objects if shape.name}


def _with_materials(scene: Scene, changed: Mapping[str, Material]) -> Scene:
    return replaced(scene, materials={**scene.materials, **changed})


def with_texture(scene: Scene, name: str, key: str, changes: dict[str, Any]) -> Scene:
    """Return the scene with other values of a texture of a material; `key`: its channel."""
    material = scene.materials[name]
    field = key if key == "normal" else f"{key}_map"
    return with_material(scene, name, **{field: replaced(getattr(material, field), **changes)})


def with_cone(scene: Scene, name: str, changes: dict[str, Any]) -> Scene:
    """Return the scene with another cone of a material; its inner half angle is not the larger."""
    material = scene.materials[name]
    if not isinstance(material, Opaque) or material.cone is None:
        return scene
    if "inner" in changes:
        changes = {"outer": max(material.cone.outer, changes["inner"]), **changes}
    elif "outer" in changes:
        changes = {"inner": min(material.cone.inner, changes["outer"]), **changes}
    return with_material(scene, name, cone=replaced(material.cone, **changes))
