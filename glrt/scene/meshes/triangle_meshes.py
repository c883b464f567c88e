"""Triangle meshes as arrays: with normals, and whether they enclose a volume."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from glrt.core.memo import computed_once
from glrt.core.text import counted, unknown
from glrt.scene.meshes.creases import by_angle, by_groups
from glrt.scene.meshes.repeated_triangles import repeated
from glrt.scene.meshes.rounded_edges import rounded_share
from glrt.scene.meshes.vertex_means import mean_normals, mean_tangents, places

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST_TRIANGLES = 4_000_000  # triangles in a scene
MOST_KEPT = 8  # forms of a mesh that are kept: objects of one file may differ in them
_CACHES = ("_varied", "_creased")  # functions with a cache
NO_MATERIAL = "without material"  # name for triangles without one, in a file with materials


class Poses(Protocol):
    """A mesh at moments of the animations of its file."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the animations."""

    @property
    def usual(self) -> str:
        """The animation to show if none is named."""

    def seconds(self, name: str) -> float:
        """Return the time of the last key of an animation."""

    def at(self, name: str | None, moment: float) -> "TriangleMesh":
        """Return the mesh at a moment in seconds; ValueError for data that do not fit."""


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
    sorts: Ints | None = None  # (n,): triangles of one sort share their materials in all variants
    variants: Mapping[str, tuple[str, ...]] = field(default_factory=dict)  # a material of each sort
    poses: Poses | None = None  # at moments of the file's animations; None if it has none
    repeated: int = 0  # triangles that were left out, since another one had the same corners
    unread: tuple[str, ...] = ()  # parts of the file that were left out, in words
    is_turned: bool = False  # whether the file winds its triangles the other way

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy in another process needs: forms of the mesh are made again there."""
        return {key: value for key, value in vars(self).items() if key not in _CACHES}

    @computed_once
    def box(self) -> tuple[Floats, Floats]:
        """Lowest and highest coordinates of the vertices in use, (3,) each."""
        used = np.zeros(len(self.vertices), bool)
        used[self.faces] = True
        return self.vertices[used].min(axis=0), self.vertices[used].max(axis=0)

    @computed_once
    def _place(self) -> Ints:
        return places(self.vertices)

    @computed_once
    def _sums(self) -> Floats:
        """Normals, (v, 3), of any length: the given ones, and means where none is given."""
        if self.normals is None:
            return self._mean_normals()
        is_given = self.normals.any(axis=1, keepdims=True)
        if is_given.all():
            return self.normals
        return np.where(is_given, self.normals, self._mean_normals())

    @computed_once
    def shading_normals(self) -> Floats:
        """Unit normals, (v, 3): the given ones, else means of the triangles around each vertex."""
        given = self._sums
        length = np.linalg.norm(given, axis=1, keepdims=True)
        unit: Floats = np.divide(given, length, out=np.zeros_like(given), where=length > 0)
        return unit

    @computed_once
    def rounded(self) -> float:
        """The share of its area on which interpolated normals round sharp edges off, 0 to 1.

        0 for a file with normals of its own: it means them.
        """
        if self.normals is not None and self.normals.any():
            return 0.0
        return rounded_share(self.vertices, self.faces, self.shading_normals)

    @computed_once
    def shading_tangents(self) -> Floats:
        """Tangents, (v, 3): the given ones, else means; zero where there is none."""
        given = np.zeros_like(self.vertices) if self.tangents is None else self.tangents
        is_given = given.any(axis=1, keepdims=True)
        if self.uv is None or is_given.all():
            return given
        normals, uv = self.shading_normals, self.uv[:, :2]
        return np.where(is_given, given, mean_tangents(self.vertices, self.faces, normals, uv))

    @computed_once
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

    @computed_once
    def outward(self) -> "TriangleMesh":
        """The mesh, with the triangles of a closed one turned over if they face inwards."""
        if self.opening or self._volume() >= 0:
            return self
        return replace(self, faces=self.faces[:, ::-1].copy(), is_turned=not self.is_turned)

    @computed_once
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
        is_all = len(kept) == len(self.faces) and _are_all_used(self.faces, len(self.vertices))
        used: Any = slice(None)
        faces = self.faces
        if not is_all:
            used, faces = np.unique(self.faces[kept], return_inverse=True)
        given = self.colors, self.uv, self.tangents
        colors, uv, tangents = (None if rows is None else rows[used] for rows in given)
        own = self.vertices[used], faces.reshape(-1, 3), normals[used], colors
        groups = None if self.groups is None else self.groups[kept]
        part = TriangleMesh(*own, uv=uv, groups=groups, tangents=tangents, is_turned=self.is_turned)
        return part if is_all and self.outward is self else part.outward

    def varied(self, name: str | None) -> "TriangleMesh":
        """Return the mesh with the materials of a variant, by default with those without one.

        Triangles that repeat another one of their material are left out. ValueError if the file
        lacks the variant.
        """
        if not self.variants:
            if name is None:
                return self
            raise ValueError("it has no variants of its materials: leave `variant` out")
        if name is not None and name not in self.variants:
            raise ValueError(unknown("variant", name, self.variants, "The file has"))
        return self._varied(name)

    @computed_once
    def _varied(self) -> Callable[[str | None], "TriangleMesh"]:
        return lru_cache(MOST_KEPT)(self._with_variant)

    def _with_variant(self, name: str | None) -> "TriangleMesh":
        if name is None:
            return self._each_once()
        assert self.sorts is not None
        materials = self.variants[name]
        names = tuple(dict.fromkeys(materials))
        labels = np.array([names.index(material) for material in materials])[self.sorts]
        return replace(self, names=names, labels=labels)._each_once()

    def _each_once(self) -> "TriangleMesh":
        assert self.sorts is not None
        assert self.labels is not None
        again = repeated(self.vertices, self.faces, self.labels)
        if not again.any():
            return self
        rows = {"faces": self.faces, "labels": self.labels, "sorts": self.sorts}
        kept: dict[str, Any] = {name: given[~again] for name, given in rows.items()}
        return replace(self, **kept, repeated=self.repeated + int(again.sum()))

    def creased(self, degrees: float) -> "TriangleMesh":
        """Return the mesh with normals as its format means them, and vertices divided at creases.

        Given normals are kept. The rest follows smoothing groups, or in a format without them the
        angle between triangles: beyond it an edge is sharp.
        """
        return self._creased(degrees)

    @computed_once
    def _creased(self) -> Callable[[float], "TriangleMesh"]:
        return lru_cache(MOST_KEPT)(self._divided)

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


def _are_all_used(faces: Ints, count: int) -> bool:
    used = np.zeros(count, bool)
    used[faces] = True
    return bool(used.all())
