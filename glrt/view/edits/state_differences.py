"""Differences between two states of the window in a few words, as undo and redo show them."""

from collections.abc import Mapping

from pydantic import BaseModel

from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from glrt.view.edits.edited_state import State

MOST = 3  # differences that are named; the others are counted


def change_text(before: State, after: State) -> str:
    """Return the edit between two states in words: "center of glass ball", "camera, bounces"."""
    parts = [*_of_scene(before.scene, after.scene), *_fields(before.settings, after.settings)]
    if len(before.scene.objects) == len(after.scene.objects):  # else the numbers differ
        changed = sorted(before.locked ^ after.locked)
        parts += [f"lock of {name_of(after.scene.objects[number])}" for number in changed]
    if before.by_length != after.by_length:
        parts.append("bounces live")
    more = f" and {len(parts) - MOST} more" if len(parts) > MOST else ""
    return ", ".join(parts[:MOST]) + more


def _of_scene(before: Scene, after: Scene) -> list[str]:
    renamed = _renamed(before, after)
    told = _of_objects(before.objects, after.objects, renamed)
    told += [f"name of material {new}" for new in renamed.values()]
    if not renamed and set(before.materials) != set(after.materials) and not told:
        told.append("unused materials")
    for kind, old, new in (
        ("material", before.materials, after.materials),
        ("light", before.light_groups, after.light_groups),
    ):
        told += [f"{kind} {name}" for name in new if name in old and old[name] != new[name]]
    for part in ("camera", "background", "sun", "animation"):
        if getattr(before, part) != getattr(after, part):
            told.append(part)
    return told


def _renamed(before: Scene, after: Scene) -> dict[str, str]:
    """Return old and new names of materials; empty if the number of materials changed."""
    gone = [name for name in before.materials if name not in after.materials]
    came = [name for name in after.materials if name not in before.materials]
    return dict(zip(gone, came, strict=True)) if len(gone) == len(came) else {}


def _of_objects(
    before: tuple[Shape, ...], after: tuple[Shape, ...], renamed: Mapping[str, str]
) -> list[str]:
    """Return the changed fields of objects, or the added or deleted ones, in words."""
    if len(before) == len(after):
        pairs = [(old, new) for old, new in zip(before, after, strict=True) if old is not new]
        return [
            _of_shape(old, new)
            for old, new in pairs
            if old.model_copy(update={"material": renamed.get(old.material, old.material)}) != new
        ]
    kept = {id(shape) for shape in before} & {id(shape) for shape in after}
    gone = [f"{name_of(shape)} deleted" for shape in before if id(shape) not in kept]
    came = [f"{name_of(shape)} added" for shape in after if id(shape) not in kept]
    return came if len(after) > len(before) else gone


def _of_shape(before: Shape, after: Shape) -> str:
    if type(before) is not type(after):
        return name_of(after)
    return f"{', '.join(_fields(before, after)[:MOST])} of {name_of(after)}"


def name_of(shape: Shape) -> str:
    """Return the name of an object, or its shape and material if it has none."""
    return shape.name or f"{shape.shape} of {shape.material}"


def _fields(before: BaseModel, after: BaseModel) -> list[str]:
    return [
        name.replace("_", " ")
        for name in type(before).model_fields
        if getattr(before, name) != getattr(after, name)
    ]
