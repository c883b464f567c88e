"""Twins: objects of equal geometry in one place, where one surface hides the others.

An emitter comes before an object that does not emit to that side, then the one that the file names
first (shaders_glsl/shapes/coincident.glsl has the same order).
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from glrt.core.memo import kept_for_the_same
from glrt.scene.materials.kinds import Material, glass_of
from glrt.scene.materials.nothing import Nothing
from glrt.scene.materials.principled import Principled
from glrt.scene.shapes.kinds import KINDS, Shape
from glrt.scene.shapes.mesh import Mesh


class Twin(NamedTuple):
    """An object that no ray sees, and the one in its place; numbers in the scene."""

    unseen: int
    seen: int


@kept_for_the_same
def twins(objects: Sequence[Shape], materials: Mapping[str, Material]) -> tuple[Twin, ...]:
    """Return each object that is left out since another one covers it, in the order of the scene.

    Objects are equal if the float32 numbers that the kernel gets are equal. Glass and surfaces with
    holes cover objects of their own material alone.
    """
    found = (_covered(group, objects, materials) for group in _groups(objects))
    return tuple(sorted(twin for some in found for twin in some))


@kept_for_the_same
def shown(objects: Sequence[Shape], materials: Mapping[str, Material]) -> tuple[int, ...]:
    """Return the numbers of objects that rays can meet: not hidden, and not covered by a twin."""
    covered = {twin.unseen for twin in twins(objects, materials)}
    return tuple(n for n, it in enumerate(objects) if not it.hidden and n not in covered)


def _groups(objects: Sequence[Shape]) -> Iterator[list[int]]:
    """Yield numbers of visible objects of equal geometry, two or more each."""
    for kind in KINDS.values():
        numbers = [n for n, thing in enumerate(objects) if type(thing) is kind and not thing.hidden]
        if len(numbers) < 2 or not all(_is_read(objects[n]) for n in numbers):
            continue
        rows = np.array([objects[n].row for n in numbers], np.float64)
        boxes = np.concatenate(kind.bounds(rows), axis=1).astype(np.float32)
        for near in _equal_rows(boxes, numbers):
            middle = np.array(objects[near[0]].middle)
            outlines = [objects[n].outline(middle).astype(np.float32) for n in near]
            yield from _equal_rows([_in_order(outline) for outline in outlines], near)


def _is_read(thing: Shape) -> bool:
    return not isinstance(thing, Mesh) or thing.file.is_read


def _equal_rows(rows: Iterable[Any], numbers: Sequence[int]) -> Iterator[list[int]]:
    alike: dict[bytes, list[int]] = {}
    for row, number in zip(rows, numbers, strict=True):
        alike.setdefault((row + np.float32(0)).tobytes(), []).append(number)  # 0 without a sign
    return (group for group in alike.values() if len(group) > 1)


def _in_order(outline: Any) -> Any:
    return outline[np.lexsort(outline.T)]


def _covered(
    group: Sequence[int], objects: Sequence[Shape], materials: Mapping[str, Material]
) -> list[Twin]:
    """Return the objects of one geometry that are seen from neither side."""
    things = [objects[n] for n in group]
    if any(isinstance(it, Mesh) and it.hides_backs for it in things):
        return []  # a hidden back covers nothing
    if any(isinstance(it, Mesh) and it.is_one_sided for it in things) and not _are_alike(things):
        return []
    sides = [_side(thing, things[0]) for thing in things]
    seen = {
        side: next(
            (
                n
                for n, thing, own in zip(group, things, sides, strict=True)
                if _emits(thing, materials) and (own == side or not thing.is_one_sided)
            ),
            group[0],
        )
        for side in (1, -1)
    }
    names = {objects[n].material for n in seen.values()}
    are_opaque = all(_is_opaque(materials.get(name)) for name in names)
    return [
        Twin(n, seen[1])
        for n in group
        if n not in seen.values() and (are_opaque or names == {objects[n].material})
    ]


def _are_alike(meshes: Sequence[Any]) -> bool:
    """Return whether meshes are one mesh, with the same linear transform."""
    first = meshes[0]
    return all(
        (mesh.file, mesh.part) == (first.file, first.part)
        and np.array_equal(mesh.linear, first.linear)
        for mesh in meshes
    )


def _side(thing: Any, first: Any) -> int:
    """Return 1 if an object's normal is that of the first one in its place, else -1."""
    bodies = thing.lamp_body, first.lamp_body
    return -1 if all(bodies) and np.dot(bodies[0].normal, bodies[1].normal) < 0 else 1


def _emits(thing: Shape, materials: Mapping[str, Material]) -> bool:
    material = materials.get(thing.material)
    return material is not None and material.emits


def _is_opaque(material: Material | None) -> bool:
    has_holes = isinstance(material, Principled) and material.has_holes
    return glass_of(material) is None and not has_holes and not isinstance(material, Nothing)
