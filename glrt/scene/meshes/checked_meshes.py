"""Triangle meshes from arrays, after a check of each row."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import ContentError
from glrt.core.text import counted, number
from glrt.scene.meshes.repeated_triangles import repeated
from glrt.scene.meshes.triangle_meshes import MOST_TRIANGLES, TriangleMesh
from glrt.scene.values import LARGEST

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ROUNDING = 1e-3  # how far out of its range a color may be by rounding


class MeshArrays(NamedTuple):
    """Arrays that a mesh is made of, with the shapes of the fields of `TriangleMesh`."""

    vertices: Any
    faces: Any
    normals: Any = None
    colors: Any = None
    names: tuple[str, ...] = ()
    labels: Ints | None = None
    uv: Any = None
    groups: Ints | None = None
    tangents: Any = None
    sorts: Ints | None = None


def checked(given: MeshArrays) -> TriangleMesh:
    """Return a mesh of arrays.

    Left out are triangles with two equal corners, and triangles that repeat another one of their
    label, or of their sort if there are sorts: then labels may differ in a variant.

    Raises ValueError, which says what is wrong with which row.
    """
    vertices, faces, normals, colors, names, labels, uv, groups, tangents, sorts = given
    points = _table(vertices, "vertices", np.float64)
    triangles = _table(faces, "faces", np.int64)
    turned = None if normals is None else _table(normals, "normals", np.float64)
    dyes = None if colors is None else _table(colors, "colors", np.float64)
    sets = None if uv is None else np.ascontiguousarray(uv, np.float64)
    along = None if tangents is None else _table(tangents, "tangents", np.float64)
    vectors = {"normal": turned, "tangent": along}
    problem = next(_problems(points, triangles, vectors, dyes, sets), None)
    if problem:
        raise ContentError(problem)
    equal = triangles == np.roll(triangles, 1, axis=1)
    whole = ~equal.any(axis=1)
    if not whole.any():
        raise ContentError("it has no triangle with three corners")
    again = repeated(points, triangles, labels if sorts is None else sorts) & whole
    whole &= ~again
    kept = triangles[whole]
    used = np.zeros(len(points), bool)
    used[kept] = True
    rank = np.cumsum(used) - 1
    all_rows = turned, dyes, sets, along
    turned, dyes, sets, along = (None if rows is None else rows[used] for rows in all_rows)
    labels = None if labels is None else labels[whole]
    groups = None if groups is None else groups[whole]
    sorts = None if sorts is None else sorts[whole]
    own = points[used], rank[kept], turned, dyes
    count = int(again.sum())
    return TriangleMesh(*own, names, labels, sets, groups, along, sorts, repeated=count)


def of_file(given: MeshArrays, left_out: Sequence[str] = ()) -> TriangleMesh:
    """Return a mesh as `checked` does, with invalid colors, coordinates and normals replaced.

    A color far out of range becomes white, such texture coordinates become 0, and a normal that is
    not finite becomes the mean of its triangles; `unread` of the mesh counts the vertices, in
    addition to what is `left_out` already.
    """
    unread = list(left_out)
    colors: Any = given.colors
    uv: Any = given.uv
    if colors is not None:
        colors = np.array(colors, np.float64)
        wrong = ~((colors >= -ROUNDING) & (colors <= 1 + ROUNDING)).all(axis=1)
        colors = np.where(wrong[:, None], 1.0, colors.clip(0, 1))
        unread += [f"the color of {counted(int(wrong.sum()), 'vertex')}"] if wrong.any() else []
    if uv is not None:
        wrong = ~(np.abs(uv) <= LARGEST).all(axis=1)
        uv = np.where(wrong[:, None], 0.0, uv)
        count = counted(int(wrong.sum()), "vertex")
        unread += [f"the texture coordinates of {count}"] if wrong.any() else []
    normals = given.normals
    if normals is not None and (wrong := ~np.isfinite(normals).all(axis=1)).any():
        normals = np.where(wrong[:, None], 0.0, normals)
        unread.append(f"the normal of {counted(int(wrong.sum()), 'vertex')}")
    found = checked(given._replace(normals=normals, colors=colors, uv=uv))
    return replace(found, unread=tuple(unread))


def _table(value: Any, name: str, dtype: type) -> NDArray[Any]:
    try:
        found = np.asarray(value)
    except ValueError:
        raise ContentError(f"{name} must be an array of shape (n, 3)") from None
    if found.ndim != 2 or found.shape[1] != 3 or found.dtype.kind not in "fiu":
        raise ContentError(
            f"{name} must be an array of numbers of shape (n, 3), got one of shape {found.shape}"
        )
    if dtype is np.int64 and found.dtype.kind == "f":
        raise ContentError(f"{name} must be whole numbers, the numbers of vertices")
    return np.ascontiguousarray(found, dtype)


def _problems(
    vertices: Floats,
    faces: Ints,
    vectors: Mapping[str, Floats | None],
    colors: Floats | None,
    uv: Floats | None,
) -> Iterator[str]:
    if not len(faces):
        yield "it has no triangles"
    if len(faces) > MOST_TRIANGLES:
        yield f"it has {len(faces):,} triangles, and a scene may have {MOST_TRIANGLES:,}"
    outside = ((faces < 0) | (faces >= len(vertices))).any(axis=1)
    if outside.any():
        row = int(outside.argmax())
        corners = ", ".join(map(str, faces[row]))
        yield (
            f"triangle {row} has the corners {corners}, and there are {len(vertices):,} vertices, "
            "numbered from 0"
        )
        return
    used = np.zeros(len(vertices), bool)
    used[faces] = True
    wrong = used & ~(np.abs(vertices) <= LARGEST).all(axis=1)
    if wrong.any():
        row = int(wrong.argmax())
        yield f"vertex {row} has a coordinate that is no number from {_range()}"
    named = {f"{name}s": rows for name, rows in vectors.items()}
    for name, rows in (named | {"colors": colors, "texture coordinates": uv}).items():
        if rows is not None and len(rows) != len(vertices):
            yield f"it has {len(rows):,} {name} for {len(vertices):,} vertices"
            return
    for name, rows in vectors.items():
        if rows is not None and not np.isfinite(rows[used]).all():
            row = int((used & ~np.isfinite(rows).all(axis=1)).argmax())
            yield f"the {name} of vertex {row} is not finite"
    if uv is not None and not (np.abs(uv) <= LARGEST)[used].all():
        row = int((used & ~(np.abs(uv) <= LARGEST).all(axis=1)).argmax())
        yield f"the texture coordinates of vertex {row} are no numbers from {_range()}"
    if colors is not None and not ((colors >= 0) & (colors <= 1))[used].all():
        row = int((used & ~((colors >= 0) & (colors <= 1)).all(axis=1)).argmax())
        yield f"the color of vertex {row} is not three numbers from 0 to 1"


def _range() -> str:
    return f"{number(-LARGEST)} to {number(LARGEST)}"
