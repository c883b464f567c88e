"""Which medium lies inside and outside each object that bounds a volume.

Volumes without priorities lie apart from each other or one within another. So the medium around
each is known before a render, and a path needs no stack of the volumes around it. Volumes with
priorities may overlap: the one of the highest rank holds the place. Its rank is its priority, and
among equal ones how many of them it lies in.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.memo import kept_for_the_same
from glrt.core.text import quoted
from glrt.scene.camera import Camera
from glrt.scene.crossing_glass import Relation, relations
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material, glass_of
from glrt.scene.materials.nothing import Nothing
from glrt.scene.schema.fields import SceneFields
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane

MOST_VOLUMES = 24  # in a scene with media: every pair of them is compared
LENS_POINTS = 16  # points on the rim of the lens

Floats = NDArray[np.float64]


class Bounds(NamedTuple):
    """An object that bounds a volume, and the names of the media on both sides."""

    number: int  # of the object in the scene
    inside: str | None  # None: vacuum
    outside: str | None
    around: int | None = None  # number of the volume that it lies in
    ior: float = 0.0  # of its glass, against air, where volumes have ranks; 0: it is not of glass


def bounds_a_volume(material: Material | None) -> bool:
    """Return whether an object of this material bounds a volume, with or without a surface."""
    glass = glass_of(material)
    return isinstance(material, Nothing) or (glass is not None and not glass.thin)


def bounds_of(scene: SceneFields) -> tuple[Bounds, ...]:
    """Return the bounds of all volumes; none in a scene without media.

    They are in the order of objects or, where volumes have ranks, in ascending order of rank. Then
    what lies outside is what lies outside of all.
    """
    around = _around(scene) if scene.media else {}
    things = scene.objects
    if has_ranks(scene):
        rows = sorted(around, key=lambda n: _rank(scene, n, around[n]))
        return tuple(Bounds(n, things[n].medium, scene.medium, None, _ior(scene, n)) for n in rows)
    holders = {n: outer[-1] if outer else None for n, outer in around.items()}
    return tuple(
        Bounds(n, things[n].medium, medium_in(scene, holder), holder)
        for n, holder in holders.items()
    )


def outer_volumes(scene: SceneFields) -> dict[int, list[int]]:
    """Return the volumes that hold each of the first MOST_VOLUMES volumes, the innermost last.

    Volumes are given by the numbers of their objects.
    """
    return _around(scene)


def medium_in(scene: SceneFields, number: int | None) -> str | None:
    """Return the name of the medium in an object, or with None outside of all; None for vacuum."""
    return scene.medium if number is None else scene.objects[number].medium


def volume_around(scene: SceneFields, point: Floats) -> int | None:
    """Return the number of the volume that holds a point, (3,); None outside of all.

    It is the innermost one, or that of the highest rank.
    """
    around = _around(scene) if scene.media else {}
    holding = [n for n in around if scene.objects[n].holds(point)]
    if has_ranks(scene):
        return max(holding, key=lambda n: _rank(scene, n, around[n]), default=None)
    return max(holding, key=lambda n: len(around[n]), default=None)


def medium_around(scene: SceneFields, point: Floats) -> str | None:
    """Return the name of the medium at a point, (3,); None for vacuum."""
    return medium_in(scene, volume_around(scene, point))


def has_ranks(scene: SceneFields) -> bool:
    """Return whether volumes of a scene that uses media have priorities."""
    if not scene.media:
        return False
    shown = [thing for thing in scene.objects if not thing.hidden]
    used = {scene.medium, *(thing.medium for thing in shown)}
    return not used.isdisjoint(scene.media) and any(
        bounds_a_volume(scene.materials.get(it.material)) and _priority(scene, it) is not None
        for it in shown
    )


def idle_priorities(scene: SceneFields) -> list[int]:
    """Return the numbers of visible objects whose own priority changes nothing.

    Without media, each is. With media, one is that no other volume overlaps; an object of an
    animated scene may come to overlap another one, so none is returned there.
    """
    ranked = [n for n, it in enumerate(scene.objects) if it.priority is not None and not it.hidden]
    if not has_ranks(scene):
        return ranked
    related = {n for _, pair in _related(scene.objects, scene.materials) for n in pair}
    return [] if scene.animation else [n for n in ranked if n not in related]


def _priority(scene: SceneFields, thing: Shape) -> int | None:
    """Return the priority of the volume of an object, or of its glass; None if it has none."""
    material = scene.materials.get(thing.material)
    of_glass = material.priority if isinstance(material, Dielectric) else None
    return of_glass if thing.priority is None else thing.priority


def _rank(scene: SceneFields, number: int, around: Sequence[int]) -> tuple[int, int, int]:
    """Return by what volumes that overlap are ordered, for one that lies in those `around` it."""
    things = scene.objects
    own = _priority(scene, things[number]) or 0
    equal = sum((_priority(scene, things[n]) or 0) == own for n in around)
    return own, equal, number


def _ior(scene: SceneFields, number: int) -> float:
    glass = glass_of(scene.materials.get(scene.objects[number].material))
    return glass.ior if glass else 0.0


def volume_problems(scene: SceneFields) -> Iterator[str]:
    """Yield why the media at some places are not known, as `key: ...`."""
    if not scene.media:
        return
    volumes = _volumes(scene.objects, scene.materials)
    if len(volumes) > MOST_VOLUMES:
        yield (
            f"objects[{volumes[MOST_VOLUMES]}]: {len(volumes)} objects are of glass or bound a "
            f"medium, and {MOST_VOLUMES} can be in a scene with media; join some, or remove some"
        )
        return
    if has_ranks(scene):
        yield from _glass_problems(scene, volumes)
    for relation, (first, second) in _related(scene.objects, scene.materials):
        pair = (scene.objects[first], scene.objects[second])
        names = f"objects[{first}] ({_called(pair[0])}) and objects[{second}] ({_called(pair[1])})"
        is_mesh = isinstance(pair[0], Mesh) or isinstance(pair[1], Mesh)
        if (_priority(scene, pair[0]) or 0) != (_priority(scene, pair[1]) or 0):
            if relation == "share a face" and not is_mesh:  # of a mesh, the box around it is known
                yield f"{names} {_RELATION[relation]}, so {_FACE_ADVICE}"
        elif relation != "inside":
            yield f"{names} {_RELATION[relation]}, so {_ADVICE}"
        elif isinstance(pair[1], Mesh):
            yield f"{names}: the first lies in the box around a mesh, so {_ADVICE}"
    yield from _lens_problems(scene, volumes)


def _glass_problems(scene: SceneFields, volumes: Sequence[int]) -> Iterator[str]:
    """Yield the objects of glass that do not go with ranks of volumes."""
    glass = {n: glass_of(scene.materials.get(scene.objects[n].material)) for n in volumes}
    for number, it in glass.items():
        if it and any(it.absorption):
            yield (
                f"objects[{number}] ({_called(scene.objects[number])}): glass with "
                "attenuation_color does not go with priorities in a scene with media; give the "
                "object a medium with absorption in place of it"
            )
        if it and it.spread:
            yield (
                f"objects[{number}] ({_called(scene.objects[number])}): glass with dispersion does "
                "not go with priorities in a scene with media; leave one of the two out"
            )
    for _, pair in _related(scene.objects, scene.materials):
        first, second = (glass[n] for n in pair)
        plain = [isinstance(scene.materials[scene.objects[n].material], Dielectric) for n in pair]
        if first and second and (first.alpha or second.alpha or not all(plain)):
            yield (
                f"objects[{pair[0]}] and objects[{pair[1]}] are of glass and overlap, and rough or "
                "principled glass does not go with priorities there; move them apart, or make "
                "both of smooth dielectric"
            )


def _lens_problems(scene: SceneFields, volumes: Sequence[int]) -> Iterator[str]:
    rim = _lens(scene.camera)
    for number in volumes:
        thing = scene.objects[number]
        if len({thing.holds(point) for point in rim}) > 1:
            yield (
                f"camera: its lens lies across the surface of objects[{number}] "
                f"({_called(thing)}); move the camera, or make the lens smaller"
            )


def _lens(camera: Camera) -> Floats:
    """Return points on the rim of the lens, (LENS_POINTS, 3), and its middle last."""
    middle = np.array(camera.position, np.float64)
    if not camera.defocus_angle:
        return middle[None]
    forward = np.subtract(camera.look_at, camera.position)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    up = np.cross(right, forward / np.linalg.norm(forward))
    radius = np.tan(np.radians(camera.defocus_angle) / 2) * camera.resolved_focus_distance
    turn = 2 * np.pi * np.arange(LENS_POINTS)[:, None] / LENS_POINTS
    rim: Floats = middle + radius * (np.cos(turn) * right + np.sin(turn) * up)
    return np.concatenate([rim, middle[None]])


_RELATION: dict[Relation, str] = {"cross": "cross", "share a face": "share a part of a face"}
_ADVICE = (
    "which medium lies where is not known: in a scene with media, move objects of glass and "
    "objects that bound a medium apart, or one wholly into another, or give them different "
    "values of priority"
)
_FACE_ADVICE = "light misses one of the two there; let one reach into the other by a hair"


def _called(thing: Shape) -> str:
    return quoted(thing.name) if thing.name else thing.shape


def _around(scene: SceneFields) -> dict[int, list[int]]:
    """Return the volumes that hold each volume, the innermost last."""
    volumes = _volumes(scene.objects, scene.materials)
    outer: dict[int, list[int]] = {number: [] for number in volumes}
    for relation, (inner, holder) in _related(scene.objects, scene.materials):
        if relation == "inside":
            outer[inner].append(holder)
    return {n: sorted(held, key=lambda one: len(outer[one])) for n, held in outer.items()}


def _volumes(objects: Sequence[Shape], materials: Mapping[str, Material]) -> list[int]:
    """Return the numbers of visible objects that bound a volume."""
    return [
        n
        for n, thing in enumerate(objects)
        if not thing.hidden and bounds_a_volume(materials.get(thing.material))
    ]


@kept_for_the_same
def _related(
    objects: Sequence[Shape], materials: Mapping[str, Material]
) -> tuple[tuple[Relation, tuple[int, int]], ...]:
    """Return which volumes cross, share a face or lie in each other, by numbers of objects."""
    volumes = _volumes(objects, materials)[:MOST_VOLUMES]
    solids = [_solid(objects[n]) for n in volumes]
    found = [(it.relation, it.pair) for it in relations(solids, np.zeros(3))]
    found += [("inside", pair) for pair in _within_planes(solids)]
    return tuple((relation, (volumes[a], volumes[b])) for relation, (a, b) in found)


def _solid(thing: Shape) -> Shape:
    """Return a convex solid in place of a mesh: the box around it."""
    if not isinstance(thing, Mesh):
        return thing
    corners = thing.world_vertices
    low, high = corners.min(axis=0), corners.max(axis=0)
    return Box(min=tuple(low), max=tuple(high), material=thing.material)


def _within_planes(solids: Sequence[Shape]) -> Iterator[tuple[int, int]]:
    """Yield parallel planes: the first lies behind the second, and both face the same way."""
    planes = [n for n, solid in enumerate(solids) if isinstance(solid, Plane)]
    for a in planes:
        for b in planes:
            first, second = solids[a], solids[b]
            assert isinstance(first, Plane)
            assert isinstance(second, Plane)
            faces_alike = float(np.dot(first.normal, second.normal)) > 0
            if a != b and faces_alike and second.holds(np.array(first.point)):
                yield a, b
