"""Polygons as primitives of a glTF file: triangles, with a material for each subset of faces."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom, UsdShade

from glrt.scene.meshes.creases import by_angle
from glrt.scene.model_files.conversion.reports import LeftOut
from glrt.scene.model_files.gltf_file import GltfFile, Table
from glrt.scene.model_files.polygons import triangulated
from glrt.scene.model_files.usd.looks import COLORS, Looks, UsdLook
from glrt.scene.model_files.usd.polygons_of_prims import Ints, Polygons, Rows, rows_of

_CREASE = 40.0  # degrees: edges of a control mesh from which they are sharp

Groups = list[tuple[Any, NDArray[np.bool_]]]  # materials or None, and their faces, (p,)


class Primitives:
    """Adds meshes to a glTF file."""

    def __init__(self, glb: GltfFile, looks: Looks, left: LeftOut, time: Usd.TimeCode) -> None:
        self._glb, self._looks, self._left, self._time = glb, looks, left, time

    def groups(self, prim: Usd.Prim, polygons: Polygons) -> Groups:
        """Return materials of a prim with the faces that have each; None for no material."""
        api = UsdShade.MaterialBindingAPI(prim)
        rest, found = np.ones(len(polygons.counts), bool), Groups()
        for subset in api.GetMaterialBindSubsets():
            if subset.GetElementTypeAttr().Get(self._time) != "face":
                self._left.add("subsets of other things than faces")
                continue
            numbers = np.array(subset.GetIndicesAttr().Get(self._time) or [], np.int64)
            faces = np.zeros_like(rest)
            faces[numbers[(numbers >= 0) & (numbers < len(rest))]] = True
            material = bound_material(subset.GetPrim()) or bound_material(prim)
            found.append((material, faces & rest))
            rest &= ~faces
        return [*found, (bound_material(prim), rest)]

    def added(self, prim: Usd.Prim, polygons: Polygons, groups: Groups) -> int | None:
        """Add a mesh to the glTF file; return its number, or None if it has no triangles."""
        kept = np.flatnonzero(np.repeat(polygons.kept, polygons.counts))
        counts = polygons.counts[polygons.kept]
        triangles, owners = triangulated(polygons.points, polygons.corners[kept], counts)
        corners = kept[triangles]
        if polygons.is_mirrored:
            corners = corners[:, ::-1]
        faces = np.flatnonzero(polygons.kept)[owners]
        sided = UsdGeom.Mesh(prim).GetDoubleSidedAttr()  # not valid for other shapes
        is_two_sided = not (sided and sided.HasAuthoredValue()) or bool(sided.Get(self._time))
        has_colors = bool(UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance(COLORS).HasValue())
        normals = self._normals(polygons, corners)
        primitives = list[Table]()
        for material, members in groups:
            some = members[faces]
            if not some.any():
                continue
            number = self._looks.number(material, has_colors)
            rows = dict[str, Rows]()
            if number is not None:
                look = self._looks.found[number]
                look.is_two_sided |= is_two_sided
                rows |= self._rows(prim, polygons, look, corners[some])
            if normals is not None:
                rows["NORMAL"] = Rows(normals.values, normals.at.reshape(-1, 3)[some].ravel())
            points = Rows(polygons.points, polygons.corners[corners[some]].ravel())
            look_of_it = {} if number is None else {"material": number}
            primitives.append({**self._primitive(points, rows), **look_of_it})
        return self._glb.add("meshes", {"primitives": primitives}) if primitives else None

    def _normals(self, polygons: Polygons, corners: Ints) -> Rows | None:
        """Return normals of the corners of triangles, (n, 3); None for facets."""
        if polygons.normals is not None:
            return Rows(polygons.normals.values, polygons.normals.at[corners].ravel())
        if polygons.is_flat or not len(corners):
            return None
        split = by_angle(polygons.points, polygons.corners[corners], None, _CREASE)
        return Rows(split.normals, split.faces.ravel())

    def _rows(
        self, prim: Usd.Prim, polygons: Polygons, look: UsdLook, corners: Ints
    ) -> Iterator[tuple[str, Rows]]:
        """Yield texture coordinates and colors of the corners of triangles, (n, 3), by name."""
        api, left = UsdGeom.PrimvarsAPI(prim), self._left
        for number, name in enumerate(look.sets):
            primvar = api.FindPrimvarWithInheritance(name)
            rows = rows_of(primvar, polygons, self._time, left, 2) if primvar else None
            if rows is None:
                left.name("texture coordinates that meshes lack", name)
                continue
            values = np.stack([rows.values[:, 0], 1 - rows.values[:, 1]], axis=1)
            yield f"TEXCOORD_{number}", Rows(values, rows.at[corners].ravel())
        if look.colors:
            primvar = api.FindPrimvarWithInheritance(look.colors)
            rows = rows_of(primvar, polygons, self._time, left, 3) if primvar else None
            if rows is not None:
                yield "COLOR_0", Rows(rows.values, rows.at[corners].ravel())
            if api.FindPrimvarWithInheritance("displayOpacity").HasAuthoredValue():
                left.add("displayOpacity")

    def _primitive(self, points: Rows, rows: dict[str, Rows]) -> Table:
        """Return a primitive, with a vertex for each different set of values at corners."""
        key = points.at
        for each in rows.values():
            key = _joined(key, each.at)
        _, first, number = np.unique(key, return_index=True, return_inverse=True)
        named: dict[str, Rows] = {"POSITION": points, **rows}
        attributes = {
            name: self._glb.vertices(each.values[each.at[first]]) for name, each in named.items()
        }
        return {"attributes": attributes, "indices": self._glb.corners(number)}


def _joined(first: Ints, second: Ints) -> Ints:
    """Return a number for each pair of numbers; in the order of the first ones."""
    if np.array_equal(first, second):
        return first
    pairs = first * (int(second.max()) + 1) + second
    numbers: Ints = np.unique(pairs, return_inverse=True)[1]
    return numbers


def bound_material(prim: Usd.Prim) -> Any:
    """Return the material of a prim; None without one."""
    material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial("full")[0]
    return material if material else None
