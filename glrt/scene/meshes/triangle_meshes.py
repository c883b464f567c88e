"""Triangle meshes as arrays: checked, with normals, and whether they enclose a volume."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.text import counted, number
from glrt.scene.meshes.creases import by_angle, by_groups
from glrt.scene.meshes.repeated_triangles import repeated
from glrt.scene.meshes.vertex_means import mean_normals, mean_tangents, places
from glrt.scene.values import LARGEST

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST_TRIANGLES = 4_000_000  # triangles in a scene
ROUNDING = 1e-3  # how far out of its range a color may be by rounding
NO_MATERIAL = "without material"  # name for triangles without one, in a file with materials


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Triangles in the coordinates of their file, counter-clockwise seen from outside."""

    vertices: Floats  # (v, 3)
    faces: Ints  # (n, 3): numbers of vertices
    normals: Floats | None  # (v, 3), of any length, 0 if unknown; None if not given
    colors: Floats | None = None  # (v, 3), linear sRGB, 0 to 1 each; None if not given
    names: tuple[str, ...] = ()  # names of the file's materials
    labels: Ints | None = None  # (n,): numbers of names; None if the file names none
    uv: Floats | None = None  # (v, 4): u and v of two sets of texture coordinates; None without
    groups: Ints | None = None  # (n,): smoothing groups, 0 for flat; None for a format without them
    tangents: Floats | None = None  # (v, 3), along which the first u grows; None if not given
    repeated: int = 0  # triangles that were left out, since another one had the same corners
    unread: tuple[str, ...] = ()  # parts of the file that were left out, in words

    @cached_property
    def box(self) -> tuple[Floats, Floats]:
        """Lowest and highest coordinates of the vertices in use, (3,) each."""
        used = np.zeros(len(self.vertices), bool)
        used[self.faces] = True
        return self.vertices[used].min(axis=0), self.vertices[used].max(axis=0)

    @cached_property
    def _place(self) -> Ints:
        return places(self.vertices)

    @cached_property
    def _sums(self) -> Floats:
        """Normals, (v, 3), of any length: the given ones, and means where none is given."""
        if self.normals is None:
            return self._mean_normals()
        is_given = self.normals.any(axis=1, keepdims=True)
        if is_given.all():
            return self.normals
        return np.where(is_given, self.normals, self._mean_normals())

    @cached_property
    def shading_normals(self) -> Floats:
        """Unit normals, (v, 3): the given ones, else means of the triangles around each vertex."""
        given = self._sums
        length = np.linalg.norm(given, axis=1, keepdims=True)
        unit: Floats = np.divide(given, length, out=np.zeros_like(given), where=length > 0)
        return unit

    @cached_property
    def shading_tangents(self) -> Floats:
        """Tangents, (v, 3): the given ones, else means; zero where there is none."""
        given = np.zeros_like(self.vertices) if self.tangents is None else self.tangents
        is_given = given.any(axis=1, keepdims=True)
        if self.uv is None or is_given.all():
            return given
        normals, uv = self.shading_normals, self.uv[:, :2]
        return np.where(is_given, given, mean_tangents(self.vertices, self.faces, normals, uv))

    @cached_property
    def opening(self) -> str:
        """Why the mesh encloses no volume, in words; empty if it encloses one."""
        place = self._place
        face: Ints = place[self.faces]
        face = face[(face != np.roll(face, 1, axis=1)).all(axis=1)]
        start, end = face.ravel(), np.roll(face, -1, axis=1).ravel()
        forth = np.sort(start * len(place) + end)
        back = np.sort(end * len(place) + start)
        if (twice := int((forth[1:] == forth[:-1]).sum())) > 0:
            edges = counted(twice, "edge")
            return f"at {edges} neighbouring triangles face opposite ways, or more than two meet"
        if not np.array_equal(forth, back):
            lonely = int((~np.isin(forth, back, assume_unique=True)).sum())
            return f"{counted(lonely, 'edge')} belong{'s' if lonely == 1 else ''} to one triangle"
        return ""

    @cached_property
    def outward(self) -> "TriangleMesh":
        """The mesh, with the triangles of a closed one turned over if they face inwards."""
        if self.opening or self._volume() >= 0:
            return self
        return replace(self, faces=self.faces[:, ::-1].copy())

    @cached_property
    def parts(self) -> dict[str, "TriangleMesh"]:
        """Triangles of each material of the file, by name, with the normals of the whole mesh."""
        if self.labels is None:
            return {}
        sums = self._sums
        counts = np.bincount(self.labels, minlength=len(self.names))
        rows = np.split(np.argsort(self.labels, kind="stable"), np.cumsum(counts)[:-1])
        named = zip(self.names, rows, strict=True)
        return {name: self._only(kept, sums) for name, kept in named if len(kept)}

    def _only(self, kept: Ints, normals: Floats) -> "TriangleMesh":
        used, faces = np.unique(self.faces[kept], return_inverse=True)
        given = self.colors, self.uv, self.tangents
        colors, uv, tangents = (None if rows is None else rows[used] for rows in given)
        own = self.vertices[used], faces.reshape(-1, 3), normals[used], colors
        groups = None if self.groups is None else self.groups[kept]
        return TriangleMesh(*own, uv=uv, groups=groups, tangents=tangents).outward

    def creased(self, degrees: float) -> "TriangleMesh":
        """Return the mesh with normals as its format means them, and vertices divided at creases.

        Given normals are kept. The rest follows smoothing groups, or in a format without them the
        angle between triangles: beyond it an edge is sharp.
        """
        if degrees not in self._creased:
            self._creased[degrees] = self._divided(degrees)
        return self._creased[degrees]

    @cached_property
    def _creased(self) -> dict[float, "TriangleMesh"]:
        return {}

    def _divided(self, degrees: float) -> "TriangleMesh":
        if self.normals is not None and self.normals.any(axis=1).all():
            return self
        own = self.vertices, self.faces, self.normals
        by = by_angle(*own, degrees) if self.groups is None else by_groups(*own, self.groups)
        given = self.colors, self.uv, self.tangents
        colors, uv, tangents = (None if rows is None else rows[by.vertex] for rows in given)
        vertices = self.vertices[by.vertex]
        new = replace(self, vertices=vertices, faces=by.faces, normals=by.normals)
        return replace(new, colors=colors, uv=uv, tangents=tangents)

    def _volume(self) -> float:
        a, b, c = (self.vertices[self.faces[:, k]] - self.box[0] for k in range(3))
        return float((a * np.cross(b, c)).sum() / 6)

    def _mean_normals(self) -> Floats:
        return mean_normals(self.vertices, self.faces, self._place)


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


def checked(given: MeshArrays) -> TriangleMesh:
    """Return a mesh of arrays.

    Left out are triangles with two equal corners, and triangles that repeat another one of their
    label.

    Raises ValueError, which says what is wrong with which row.
    """
    vertices, faces, normals, colors, names, labels, uv, groups, tangents = given
    points = _table(vertices, "vertices", np.float64)
    triangles = _table(faces, "faces", np.int64)
    turned = None if normals is None else _table(normals, "normals", np.float64)
    dyes = None if colors is None else _table(colors, "colors", np.float64)
    sets = None if uv is None else np.ascontiguousarray(uv, np.float64)
    along = None if tangents is None else _table(tangents, "tangents", np.float64)
    vectors = {"normal": turned, "tangent": along}
    problem = next(_problems(points, triangles, vectors, dyes, sets), None)
    if problem:
        raise ValueError(problem)
    equal = triangles == np.roll(triangles, 1, axis=1)
    whole = ~equal.any(axis=1)
    if not whole.any():
        raise ValueError("it has no triangle with three corners")
    again = repeated(points, triangles, labels) & whole
    whole &= ~again
    kept = triangles[whole]
    used = np.zeros(len(points), bool)
    used[kept] = True
    rank = np.cumsum(used) - 1
    all_rows = turned, dyes, sets, along
    turned, dyes, sets, along = (None if rows is None else rows[used] for rows in all_rows)
    labels = None if labels is None else labels[whole]
    groups = None if groups is None else groups[whole]
    own = points[used], rank[kept], turned, dyes
    return TriangleMesh(*own, names, labels, sets, groups, along, int(again.sum()))


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
        raise ValueError(f"{name} must be an array of shape (n, 3)") from None
    if found.ndim != 2 or found.shape[1] != 3 or found.dtype.kind not in "fiu":
        raise ValueError(
            f"{name} must be an array of numbers of shape (n, 3), got one of shape {found.shape}"
        )
    if dtype is np.int64 and found.dtype.kind == "f":
        raise ValueError(f"{name} must be whole numbers, the numbers of vertices")
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
