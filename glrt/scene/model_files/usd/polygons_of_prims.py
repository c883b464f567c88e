"""Polygons of the meshes of a USD file, and of its simple solids."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from glrt.core.text import quoted
from glrt.scene.model_files.conversion.reports import LeftOut, UnshownError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_AROUND = 64  # sides of a solid that is round
_AXES = {"X": (2, 0, 1), "Y": (1, 2, 0), "Z": (0, 1, 2)}  # columns of a solid about z


class Rows(NamedTuple):
    """Values, (k, size), and for each corner the number of its own, (c,)."""

    values: Floats
    at: Ints


class Polygons(NamedTuple):
    """Polygons, one after another; holes and those of less than three corners are not `kept`."""

    points: Floats  # (v, 3)
    corners: Ints  # (c,): numbers of points
    counts: Ints  # (p,): corners of each polygon
    kept: NDArray[np.bool_]  # (p,)
    is_mirrored: bool = False  # whether corners run clockwise, seen from outside
    normals: Rows | None = None
    is_flat: bool = False  # whether facets are meant where there are no normals


def polygons_of(prim: Usd.Prim, time: Usd.TimeCode, left: LeftOut) -> Polygons | None:
    """Return the polygons of a mesh or solid; None for another prim, and for one without any.

    Raises `UnshownError` for a damaged mesh.
    """
    if prim.IsA(UsdGeom.Mesh):
        return _of_mesh(UsdGeom.Mesh(prim), time, left)
    make = _SOLIDS.get(prim.GetTypeName())
    return make(prim, time) if make else None


def _of_mesh(mesh: UsdGeom.Mesh, time: Usd.TimeCode, left: LeftOut) -> Polygons | None:
    points = _array(mesh.GetPointsAttr(), time, np.float64).reshape(-1, 3)
    counts = _array(mesh.GetFaceVertexCountsAttr(), time, np.int64)
    corners = _array(mesh.GetFaceVertexIndicesAttr(), time, np.int64)
    if not len(counts) or not len(points):
        left.add("meshes without polygons")
        return None
    is_sound = (counts >= 0).all() and counts.sum() == len(corners)
    if not is_sound or (corners < 0).any() or (corners >= len(points)).any():
        raise UnshownError(
            f"is damaged: the mesh {_path(mesh)} has corners that are none of its points"
        )
    if not np.isfinite(points).all():
        raise UnshownError(f"is damaged: the mesh {_path(mesh)} has a point that is no number")
    kept = counts >= 3
    holes = _array(mesh.GetHoleIndicesAttr(), time, np.int64)
    kept[holes[(holes >= 0) & (holes < len(counts))]] = False
    scheme = mesh.GetSubdivisionSchemeAttr().Get(time)
    if scheme != "none":
        left.add("subdivision of meshes (their control meshes are shown)")
    is_mirrored = mesh.GetOrientationAttr().Get(time) == "leftHanded"
    bare = Polygons(points, corners, counts, kept, is_mirrored, None, scheme == "none")
    return bare._replace(normals=_normals(mesh, bare, time, left))


def _normals(
    mesh: UsdGeom.Mesh, polygons: Polygons, time: Usd.TimeCode, left: LeftOut
) -> Rows | None:
    primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals")
    if primvar and primvar.HasAuthoredValue():
        return rows_of(primvar, polygons, time, left, 3)
    values = mesh.GetNormalsAttr().Get(time)
    if not values:
        return None
    rows = np.array(values, np.float64).reshape(-1, 3)
    return placed_rows(rows, mesh.GetNormalsInterpolation(), polygons, "normals", left)


def rows_of(
    primvar: UsdGeom.Primvar, polygons: Polygons, time: Usd.TimeCode, left: LeftOut, size: int
) -> Rows | None:
    """Return the values of a primvar at corners; None if they do not fit."""
    name = primvar.GetPrimvarName()
    values = primvar.Get(time)
    if values is None:
        return None
    try:
        rows = np.array(values, np.float64).reshape(-1, size)
    except (TypeError, ValueError):
        left.name("primvars of other sizes", name)
        return None
    if primvar.IsIndexed():
        order = np.array(primvar.GetIndices(time), np.int64)
        if (order < 0).any() or (order >= len(rows)).any():
            left.name("primvars that do not fit their meshes", name)
            return None
        rows = rows[order]
    return placed_rows(rows, primvar.GetInterpolation(), polygons, name, left)


def placed_rows(
    rows: Floats, interpolation: str, polygons: Polygons, name: str, left: LeftOut
) -> Rows | None:
    """Return values with the number of each corner's own; None if they do not fit."""
    corners, counts = polygons.corners, polygons.counts
    if interpolation == "faceVarying":
        at, needed = np.arange(len(corners)), len(corners)
    elif interpolation == "uniform":
        at, needed = np.repeat(np.arange(len(counts)), counts), len(counts)
    elif interpolation in ("vertex", "varying"):
        at, needed = corners, len(polygons.points)
    else:
        at, needed = np.zeros(len(corners), np.int64), 1
    if len(rows) != needed:
        left.name("primvars that do not fit their meshes", name)
        return None
    if not np.isfinite(rows).all():
        left.name("primvars that are no numbers", name)
        rows = np.where(np.isfinite(rows), rows, 0.0)
    return Rows(rows, at)


def _path(mesh: UsdGeom.Mesh) -> str:
    return quoted(str(mesh.GetPath()))


def _array(attribute: Usd.Attribute, time: Usd.TimeCode, dtype: Any) -> NDArray[Any]:
    values = attribute.Get(time)
    return np.array([] if values is None else values, dtype)


def _solid(points: Any, faces: list[list[int]], axis: str = "Z") -> Polygons:
    rows = np.array(points, np.float64)[:, _AXES.get(axis, _AXES["Z"])]
    counts = np.array([len(face) for face in faces])
    corners = np.array([corner for face in faces for corner in face])
    return Polygons(rows, corners, counts, np.ones(len(faces), bool))


def _cube(prim: Usd.Prim, time: Usd.TimeCode) -> Polygons:
    half = float(UsdGeom.Cube(prim).GetSizeAttr().Get(time)) / 2
    points = [[x, y, z] for x in (-half, half) for y in (-half, half) for z in (-half, half)]
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return _solid(points, faces)._replace(is_flat=True)


def _plane(prim: Usd.Prim, time: Usd.TimeCode) -> Polygons:
    plane = UsdGeom.Plane(prim)
    x, y = (float(it.Get(time)) / 2 for it in (plane.GetWidthAttr(), plane.GetLengthAttr()))
    axis = plane.GetAxisAttr().Get(time)
    if axis == "X":  # its width lies along z
        corners = [[0, -y, -x], [0, y, -x], [0, y, x], [0, -y, x]]
    elif axis == "Y":  # its length lies along z
        corners = [[-x, 0, -y], [-x, 0, y], [x, 0, y], [x, 0, -y]]
    else:
        corners = [[-x, -y, 0], [x, -y, 0], [x, y, 0], [-x, y, 0]]
    return _solid(corners, [[0, 1, 2, 3]])


def _sphere(prim: Usd.Prim, time: Usd.TimeCode) -> Polygons:
    radius = float(UsdGeom.Sphere(prim).GetRadiusAttr().Get(time))
    half = _AROUND // 2
    rings = [
        (radius * math.sin(math.pi * k / half), radius * -math.cos(math.pi * k / half))
        for k in range(1, half)
    ]
    found = _turned([(0.0, -radius), *rings, (0.0, radius)], "Z")
    normals = found.points / (radius or 1.0)
    return found._replace(normals=Rows(normals, found.corners))


def _cylinder(prim: Usd.Prim, time: Usd.TimeCode) -> Polygons:
    solid = UsdGeom.Cylinder(prim)
    radius, half = (
        float(solid.GetRadiusAttr().Get(time)),
        float(solid.GetHeightAttr().Get(time)) / 2,
    )
    profile = [(0.0, -half), (radius, -half), (radius, half), (0.0, half)]
    return _turned(profile, solid.GetAxisAttr().Get(time))


def _cone(prim: Usd.Prim, time: Usd.TimeCode) -> Polygons:
    solid = UsdGeom.Cone(prim)
    radius, half = (
        float(solid.GetRadiusAttr().Get(time)),
        float(solid.GetHeightAttr().Get(time)) / 2,
    )
    return _turned([(0.0, -half), (radius, -half), (0.0, half)], solid.GetAxisAttr().Get(time))


def _capsule(prim: Usd.Prim, time: Usd.TimeCode) -> Polygons:
    solid = UsdGeom.Capsule(prim)
    radius, half = (
        float(solid.GetRadiusAttr().Get(time)),
        float(solid.GetHeightAttr().Get(time)) / 2,
    )
    steps = [math.pi / 2 * k / (_AROUND // 4) for k in range(1, _AROUND // 4 + 1)]
    bottom = [(radius * math.sin(it), -half - radius * math.cos(it)) for it in steps]
    top = [(x, -z) for x, z in reversed(bottom)]
    ends = (0.0, -half - radius), (0.0, half + radius)
    return _turned([ends[0], *bottom, *top, ends[1]], solid.GetAxisAttr().Get(time))


def _turned(profile: list[tuple[float, float]], axis: str) -> Polygons:
    """Return a solid of revolution about z, or another axis; its profile begins and ends there."""
    circle = [
        (math.cos(math.tau * k / _AROUND), math.sin(math.tau * k / _AROUND)) for k in range(_AROUND)
    ]
    points = [(0.0, 0.0, profile[0][1])]
    points += [(radius * x, radius * y, z) for radius, z in profile[1:-1] for x, y in circle]
    points.append((0.0, 0.0, profile[-1][1]))
    last, faces = len(points) - 1, list[list[int]]()
    for k in range(_AROUND):
        after = (k + 1) % _AROUND
        faces.append([0, 1 + after, 1 + k])
        for ring in range(len(profile) - 3):
            low, high = 1 + ring * _AROUND, 1 + (ring + 1) * _AROUND
            faces.append([low + k, low + after, high + after, high + k])
        top = 1 + (len(profile) - 3) * _AROUND
        faces.append([top + k, top + after, last])
    return _solid(points, faces, axis)


_SOLIDS = {
    "Cube": _cube,
    "Plane": _plane,
    "Sphere": _sphere,
    "Cylinder": _cylinder,
    "Cone": _cone,
    "Capsule": _capsule,
}
