"""Compare scenes without the names of their parts, on which no light depends."""

from collections.abc import Callable, Collection
from typing import TypeVar

from glrt.scene.lit_scene import SKY_GROUP, SUN_GROUP
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.kinds import Material
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape

T = TypeVar("T")
_KEPT = {SKY_GROUP: SKY_GROUP, SUN_GROUP: SUN_GROUP}  # groups with fixed names


def less_names(first: Scene, second: Scene) -> tuple[Scene, Scene]:
    """Return both scenes with numbers for names, if their names differ; else as they are.

    The results are equal if one scene is the other with other names of title, objects, materials or
    light groups. Numbers follow the order in the scene, which decides the order in the kernel.
    """
    if _are_named_alike(first, second):
        return first, second
    return _nameless(first), _nameless(second)


def _are_named_alike(first: Scene, second: Scene) -> bool:
    """Return whether all names are equal; the many objects that an edit keeps are not compared."""
    if first.title != second.title or [*first.materials] != [*second.materials]:
        return False
    return _alike(first.objects, second.objects, _names_of) and _alike(
        first.materials.values(), second.materials.values(), _group_of
    )


def _alike(first: Collection[T], second: Collection[T], names: Callable[[T], object]) -> bool:
    pairs = zip(first, second, strict=False)
    return first is second or (
        len(first) == len(second) and all(a is b or names(a) == names(b) for a, b in pairs)
    )


def _names_of(thing: Shape) -> object:
    return thing.name, thing.material, thing.group


def _group_of(material: Material) -> object:
    return getattr(material, "group", None)


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
