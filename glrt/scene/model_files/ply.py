"""PLY files as arrays, in text and binary."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import ContentError, NothingShownError
from glrt.core.text import counted
from glrt.scene.images.codes import decode_srgb
from glrt.scene.meshes.checked_meshes import MeshArrays
from glrt.scene.model_files.ply_tables import Columns, Ragged, tables_of
from glrt.scene.model_files.polygons import triangulated

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_CORNERS = ("vertex_indices", "vertex_index")  # names that programs give the lists of faces
_UV = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))
_OF_CORNERS = "texcoord"  # lists of u and v of each corner of a face
_STRIPS = "tristrips"
_LEAST = 3  # corners of a face


def read_ply(content: bytes) -> tuple[MeshArrays, tuple[str, ...]]:
    """Return the mesh of a PLY file, and what is left out of it, in words.

    Colors that are floats are linear, and whole numbers are codes of sRGB up to the largest of
    their type. ValueError says what is wrong.
    """
    tables = tables_of(content)
    vertex = tables.get("vertex", {})
    points = _columns(vertex, "xyz")
    if points is None:
        raise ContentError("it has no vertices with x, y and z")
    corners, counts, uv, unread = _faces(tables)
    if corners.size and not 0 <= corners.min() <= corners.max() < len(points):
        wrong = corners[(corners < 0) | (corners >= len(points))][0]
        has = counted(len(points), "vertex")
        raise ContentError(f"a face names vertex {wrong}, and the file has {has}, numbered from 0")
    triangles, _ = triangulated(points, corners, counts)
    normals, colors = _columns(vertex, ("nx", "ny", "nz")), _colors(vertex)
    if uv is not None:
        keys = np.column_stack([corners, np.ascontiguousarray(uv).view(np.int64)])
        kept, numbers = np.unique(keys, axis=0, return_inverse=True)
        at = kept[:, 0]
        sets = _both(*np.ascontiguousarray(kept[:, 1:]).view(np.float64).T)
        turned, dyes = (None if rows is None else rows[at] for rows in (normals, colors))
        arrays = MeshArrays(points[at], numbers.ravel()[triangles], turned, dyes, uv=sets)
        return arrays, tuple(unread)
    found = next((rows for names in _UV if (rows := _columns(vertex, names)) is not None), None)
    both = None if found is None else _both(*found.T)
    return MeshArrays(points, corners[triangles], normals, colors, uv=both), tuple(unread)


def _columns(table: Columns, names: Sequence[str]) -> Floats | None:
    """Return columns of numbers side by side, (n, k) float64; None if one is missing."""
    if any(name not in table or isinstance(table[name], Ragged) for name in names):
        return None
    return np.stack([np.asarray(table[name], np.float64) for name in names], axis=1)


def _colors(vertex: Columns) -> Floats | None:
    """Return linear colors of vertices, (v, 3), or None."""
    names = next((n for n in (("red", "green", "blue"), tuple("rgb")) if n[0] in vertex), ())
    found = _columns(vertex, names) if names else None
    if found is None:
        return None
    kind = vertex[names[0]].dtype
    return decode_srgb(found / np.iinfo(kind).max) if kind.kind in "iu" else found


def _both(u: Floats, v: Floats) -> Floats:
    """Return texture coordinates, (n, 4), both sets the same, with v growing downwards."""
    return np.stack([u, 1 - v, u, 1 - v], axis=1)


def _faces(tables: dict[str, Columns]) -> tuple[Ints, Ints, Floats | None, list[str]]:
    """Return corners, (c,), their counts, (p,), their u and v, (c, 2), and what is left out."""
    face, strips = tables.get("face", {}), tables.get(_STRIPS, {})
    lists = next((face[name] for name in _CORNERS if isinstance(face.get(name), Ragged)), None)
    if lists is None:
        strip = next((c for c in strips.values() if isinstance(c, Ragged)), None)
        if strip is None:
            raise NothingShownError("it has no faces with a list of vertex_indices")
        corners = _of_strips(strip.values.astype(np.int64))
        return corners.ravel(), np.full(len(corners), 3), None, []
    corners, counts = lists.values.astype(np.int64), lists.counts
    uv, unread = None, list[str]()
    given = face.get(_OF_CORNERS)
    if isinstance(given, Ragged) and (given.counts == 2 * counts).all():
        uv = given.values.astype(np.float64).reshape(-1, 2)
    elif isinstance(given, Ragged) and given.values.size:
        unread.append("the texture coordinates of corners")
    if (short := counts < _LEAST).any():
        left = counted(int(short.sum()), "face")
        unread.append(f"{left} of fewer than three corners")
        kept = np.repeat(~short, counts)
        corners, uv = corners[kept], None if uv is None else uv[kept]
        counts = counts[~short]
    return corners, counts, uv, unread


def _of_strips(strip: Ints) -> Ints:
    """Return the triangles of strips, (n, 3), which -1 separates; every second one is turned."""
    found = np.stack([strip[:-2], strip[1:-1], strip[2:]], axis=1)
    begins = np.concatenate([[0], np.flatnonzero(strip == -1) + 1])
    since = (
        np.arange(len(found)) - begins[np.searchsorted(begins, np.arange(len(found)), "right") - 1]
    )
    is_odd = since % 2 == 1
    found[is_odd] = found[is_odd][:, [1, 0, 2]]
    kept: Ints = found[(found >= 0).all(axis=1)]
    return kept
