"""Flat lamps, and bounds of volumes, that lie in the place of other surfaces, up to rounding.

The kernel then decides which one a ray sees (shaders_glsl/shapes/coincident.glsl).
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.box_pairs import box_pairs
from glrt.core.memo import kept_for_the_same
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.nothing import Nothing
from glrt.scene.scene import Scene
from glrt.scene.shapes.flat_polygons import Polygons, joined, polygons_of
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane

TOGETHER = 2.0**-17  # largest gap over the size of two surfaces: twice the kernel's rounding
LEAST_OVERLAP = 1e-4  # least overlap over the smaller size: neighbours that only touch are apart
MOST_TRIANGLES = 65_535  # emitting triangles; if there are more, meshes are not compared as lamps
LEANING = 2.0**-8  # rise over the size of a surface, beyond which it lies in no other's plane

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Coincidence(NamedTuple):
    """Pairs of surfaces that lie in the same place."""

    pairs: tuple[tuple[int, int], ...]  # numbers of objects, equal if one overlaps itself
    low: tuple[float, ...]  # a box around these surfaces
    high: tuple[float, ...]


NOWHERE = Coincidence((), (0.0,) * 3, (0.0,) * 3)


def coincidence_of(scene: Scene) -> Coincidence:
    """Find each pair of a lamp, or bounds of a volume, and another object that share a plane.

    Spheres and the walls of cylinders are not compared: they share a circle or a line with other
    shapes, unless they are twins.
    """
    return _coincidence(scene.objects, scene.materials, scene.shown)


@kept_for_the_same
def _coincidence(
    objects: Sequence[Shape], materials: Mapping[str, Material], shown: Sequence[int]
) -> Coincidence:
    lamps = _deciding(objects, materials, shown)
    bright_planes = [
        n for n in shown if isinstance(objects[n], Plane) and _decides(objects[n], materials)
    ]
    found: list[_Shared] = []
    if len(lamps.owner):
        low, high = lamps.corners.min(axis=(0, 1)), lamps.corners.max(axis=(0, 1))
        found += _overlaps(lamps, _near(objects, shown, low, high))
        found += _on_planes(lamps, [n for n in shown if isinstance(objects[n], Plane)], objects)
    if bright_planes:
        everywhere = np.full(3, np.inf)
        found += _on_planes(_near(objects, shown, -everywhere, everywhere), bright_planes, objects)
    if not found:
        return NOWHERE
    corners = np.concatenate([shared.corners for shared in found])
    return Coincidence(
        tuple(sorted(set().union(*(shared.pairs for shared in found)))),
        tuple(corners.min(axis=0).tolist()),
        tuple(corners.max(axis=0).tolist()),
    )


class _Shared(NamedTuple):
    pairs: set[tuple[int, int]]
    corners: Floats  # (n, 3): corners of the polygons that overlap


def _decides(thing: Shape, materials: Mapping[str, Material]) -> bool:
    """Return whether a surface is a lamp, or only bounds a volume: others may share its place."""
    material = materials.get(thing.material)
    return material is not None and (material.emits or isinstance(material, Nothing))


def _deciding(
    objects: Sequence[Shape], materials: Mapping[str, Material], shown: Sequence[int]
) -> Polygons:
    """Return the flat surfaces that `_decides` names."""
    bright = [n for n in shown if _decides(objects[n], materials)]
    meshes = [thing for n in bright if isinstance(thing := objects[n], Mesh)]
    if any(mesh.file.triangles is None for mesh in meshes):
        return joined([])
    if sum(len(mesh.triangles.faces) for mesh in meshes) > MOST_TRIANGLES:
        bright = [n for n in bright if not isinstance(objects[n], Mesh)]
    everywhere = np.full(3, np.inf)
    return joined([polygons_of(objects[n], n, -everywhere, everywhere) for n in bright])


def _near(objects: Sequence[Shape], shown: Sequence[int], low: Floats, high: Floats) -> Polygons:
    """Return the flat surfaces that touch a box, or nearly so."""
    with np.errstate(invalid="ignore"):  # for an infinite box
        slack = np.nan_to_num(TOGETHER * np.linalg.norm(high - low), nan=0.0, posinf=0.0)
    low, high = low - slack, high + slack
    near = [n for n in shown if _touches(objects[n], low, high)]
    return joined([polygons_of(objects[n], n, low, high) for n in near])


def _touches(thing: Shape, low: Floats, high: Floats) -> bool:
    """Return whether a box around an object touches another box."""
    if isinstance(thing, Plane):
        return False
    lower, upper = (edge[0] for edge in thing.bounds(np.array([thing.row], np.float64)))
    return bool((upper >= low).all() and (lower <= high).all())


def _on_planes(
    some: Polygons, planes: Sequence[int], objects: Sequence[Shape]
) -> Iterator[_Shared]:
    """Yield polygons that lie in infinite planes."""
    for number in planes:
        plane = objects[number]
        assert isinstance(plane, Plane)
        normal = np.array(plane.normal) / np.linalg.norm(plane.normal)
        gaps = np.abs((some.corners - np.array(plane.point)) @ normal).max(axis=1)
        low, high = some.boxes
        there = gaps <= TOGETHER * np.linalg.norm(high - low, axis=1)
        if there.any():
            lying = some.of(there)
            yield _shared(lying, np.full(len(lying.owner), number), lying.corners)


def _overlaps(lamps: Polygons, others: Polygons) -> Iterator[_Shared]:
    """Yield polygons that overlap lamps in one plane."""
    normals = lamps.normals, others.normals
    for a, b in box_pairs(lamps.boxes, others.boxes, TOGETHER):
        flat = normals[0][a], normals[1][b]
        rows = np.flatnonzero(_lie_together(lamps.of(a), others.of(b), flat))
        first, second = lamps.of(a[rows]), others.of(b[rows])
        same = (first.corners[:, :3] == second.corners[:, :3]).all(axis=(1, 2))
        apart = ~same | (first.owner != second.owner)
        if apart.any():
            yield _shared(first.of(apart), second.owner[apart], second.corners[apart])


def _gaps(at: Floats, corners: Floats, normals: Floats) -> Floats:
    """Return the largest distance of corners, (n, k, 3), from planes through points, (n,)."""
    heights = np.einsum("nkc,nc->nk", corners - at[:, None], normals)
    gaps: Floats = np.maximum.reduce(np.abs(heights).T)
    return gaps


def _shared(some: Polygons, others: Ints, more: Floats) -> _Shared:
    """Return coinciding polygons as pairs of objects, with the corners of both.

    `others`, (n,), are the objects of the other polygons, and `more` the corners of those.
    """
    pairs = np.unique(np.sort(np.column_stack([some.owner, others]), axis=1), axis=0)
    corners = np.concatenate([some.corners.reshape(-1, 3), more.reshape(-1, 3)])
    return _Shared({(int(a), int(b)) for a, b in pairs}, corners)


def _lie_together(
    first: Polygons, second: Polygons, flat: tuple[Floats, Floats]
) -> NDArray[np.bool_]:
    """Return whether pairs of polygons lie in one plane, up to rounding, and overlap, (n,).

    `flat` are their unit normals, (n, 3) each, or 0.
    """
    (low, high), (lower, higher) = first.boxes, second.boxes
    size = np.linalg.norm(np.maximum(high, higher) - np.minimum(low, lower), axis=1)
    gaps = (
        _gaps(first.corners[:, 0], second.corners, flat[0]),
        _gaps(second.corners[:, 0], first.corners, flat[1]),
    )
    together: NDArray[np.bool_] = np.minimum(*gaps) <= TOGETHER * size
    together &= flat[0].any(axis=1) & flat[1].any(axis=1)
    rows = np.flatnonzero(together)
    some, others = first.of(rows), second.of(rows)
    together[rows] = ~_lean(some, others) & _overlap(some, others, flat[0][rows])
    return together


def _lean(first: Polygons, second: Polygons) -> NDArray[np.bool_]:
    """Return whether the smaller polygon of a pair leans on the plane of the other one, (n,).

    So does a part of a round lamp where it touches a floor: the two share a point there, and no
    part of a plane. Corners are known to a float32.
    """
    sizes = [np.linalg.norm(np.ptp(it.corners, axis=1), axis=1) for it in (first, second)]
    leans = [
        np.ptp(_dots(small.corners, large.normals[:, None]), axis=1)
        > LEANING * size + 2.0**-22 * np.abs(small.corners).max(axis=(1, 2))
        for small, large, size in ((first, second, sizes[0]), (second, first, sizes[1]))
    ]
    found: NDArray[np.bool_] = np.where(sizes[0] < sizes[1], *leans)
    return found


def _overlap(first: Polygons, second: Polygons, normals: Floats) -> NDArray[np.bool_]:
    """Return whether pairs of polygons in one plane overlap, (n,): no edge separates the two."""
    overlap = np.ones(len(normals), bool)
    for corners in (first.corners, second.corners):
        edges = np.roll(corners, -1, axis=1) - corners
        for k in range(edges.shape[1]):
            axis = np.cross(normals, edges[:, k])[:, None]
            ends = [_dots(it.corners, axis) for it in (first, second)]
            low, high = ([end(side, axis=1) for side in ends] for end in (np.min, np.max))
            depth = np.minimum(*high) - np.maximum(*low)
            width = np.minimum(high[0] - low[0], high[1] - low[1])
            overlap &= (depth > LEAST_OVERLAP * width) | ~axis[:, 0].any(axis=1)
    return overlap


def _dots(a: Floats, b: Floats) -> Floats:
    products: Floats = (a * b).sum(axis=-1)
    return products
