"""Scenes without their names, which no light depends on."""

from typing import Any

from glrt.scene.materials import Material, Opaque
from glrt.scene.scene import SKY_GROUP, SUN_GROUP, Scene
from glrt.scene.shapes import Shape

_KEPT = {SKY_GROUP: SKY_GROUP, SUN_GROUP: SUN_GROUP}  # groups of what has no other name


def less_names(first: Scene, second: Scene) -> tuple[Scene, Scene]:
    """Both scenes with numbers for names, if their names differ; else as they are.

    They are equal then if one is the other under other names: title, objects, materials, light
    groups. Numbers are those of the order in the scene, which decides on a kernel's.
    """
    if _names(first) == _names(second):
        return first, second
    return _nameless(first), _nameless(second)


def _names(scene: Scene) -> list[Any]:
    objects = [(thing.name, thing.material, thing.group) for thing in scene.objects]
    groups = [getattr(material, "group", None) for material in scene.materials.values()]
    return [scene.title, objects, [*scene.materials], groups]


def _nameless(scene: Scene) -> Scene:
    groups = {name: f"\0{number}" for number, name in enumerate(scene.light_groups)} | _KEPT
    numbers = {name: str(number) for number, name in enumerate(scene.materials)}

    def unnamed(thing: Shape) -> Shape:
        group = scene.finish(thing).group
        names = {"name": None, "material": numbers.get(thing.material, thing.material)}
        return thing.model_copy(update={**names, "group": groups[group] if group else thing.group})

    def plain(material: Material) -> Material:
        is_lamp = isinstance(material, Opaque) and material.emits
        return material.model_copy(update={"group": None}) if is_lamp else material

    update = {
        "title": None,
        "materials": {numbers[name]: plain(m) for name, m in scene.materials.items()},
        "objects": tuple(map(unnamed, scene.objects)),
        "lights": {groups.get(name, name): value for name, value in scene.lights.items()},
    }
    return scene.model_copy(update=update)
