"""Meshes that a scene names: the path of a file, its SHA-256, and its triangles once it is read."""

import hashlib
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, PlainSerializer, PrivateAttr, WithJsonSchema

from glrt.scene.files.named_files import PATH_SCHEMA, NamedFile, by_path, to_path
from glrt.scene.meshes.checked_meshes import MeshArrays, checked
from glrt.scene.meshes.triangle_meshes import TriangleMesh


class MeshFile(NamedFile):
    """A mesh from a file, or from arrays under the name of the file that it is saved as."""

    _triangles: TriangleMesh | None = PrivateAttr(None)
    _libraries: Mapping[str, str] = PrivateAttr({})
    _unread: tuple[str, ...] = PrivateAttr(())

    @property
    def is_read(self) -> bool:
        """Whether its triangles are there."""
        return self._triangles is not None

    @property
    def triangles(self) -> TriangleMesh | None:
        """The triangles of the mesh; None before the file is read."""
        return self._triangles

    @property
    def libraries(self) -> Mapping[str, str]:
        """SHA-256 in hex, by path, of the files from which materials alone were taken."""
        return self._libraries

    @property
    def unread(self) -> tuple[str, ...]:
        """Parts of this file and of its libraries that were left out, in words."""
        own = self._triangles.unread if self._triangles else ()
        return tuple(sorted({*self._unread, *own}))

    def with_libraries(self, hashes: Mapping[str, str], unread: tuple[str, ...]) -> "MeshFile":
        """Return a copy with the files of its materials, SHA-256 by path, and more omissions."""
        found = self.model_copy()
        found._libraries, found._unread = hashes, (*self._unread, *unread)
        return found

    def read_as(self, sha256: str, triangles: TriangleMesh, origin: Path | None) -> "MeshFile":
        """Return the mesh with its content."""
        found = MeshFile(file=self.file, sha256=sha256)
        found._triangles, found._origin = triangles.outward, origin
        return found


def mesh_of_arrays(
    vertices: Any, faces: Any, normals: Any = None, colors: Any = None, uv: Any = None
) -> MeshFile:
    """Return a mesh from arrays, under the name of the file that it is saved as.

    Raises ValueError, which says what is wrong with which row.
    """
    sets = None if uv is None else np.tile(two_columns(uv), (1, 2))
    triangles = checked(MeshArrays(vertices, faces, normals, colors, uv=sets))
    content = _ply(triangles)
    sha256 = hashlib.sha256(content).hexdigest()
    named = MeshFile(file=f"mesh-{sha256[:12]}.ply")
    found = named.read_as(sha256, triangles, None)
    found._content = content
    return found


def two_columns(uv: Any) -> NDArray[np.float64]:
    """Return texture coordinates as (v, 2) float64; ValueError if they have no such shape."""
    found = np.asarray(uv)
    if found.ndim != 2 or found.shape[1] != 2 or found.dtype.kind not in "fiu":
        raise ValueError(f"uv must be an array of numbers of shape (n, 2), got {found.shape}")
    return found.astype(np.float64)


def _ply(mesh: TriangleMesh) -> bytes:
    """Return a binary PLY file with every digit of the mesh."""
    tables = {"x y z": mesh.vertices, "nx ny nz": mesh.normals, "red green blue": mesh.colors}
    if mesh.uv is not None:  # t grows upwards, as other programs have it
        tables["s t"] = np.stack([mesh.uv[:, 0], 1 - mesh.uv[:, 1]], axis=1)
    there = {names: rows for names, rows in tables.items() if rows is not None}
    names, columns = " ".join(there).split(), list(there.values())
    rows = np.zeros(len(mesh.faces), [("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, mesh.faces
    lines = [
        "ply",
        "format binary_little_endian 1.0",
        f"element vertex {len(mesh.vertices)}",
        *(f"property double {name}" for name in names),
        f"element face {len(mesh.faces)}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    out = BytesIO()
    out.write(("\n".join(lines) + "\n").encode("ascii"))
    out.write(np.concatenate(columns, axis=1).astype("<f8").tobytes())
    out.write(rows.tobytes())
    return out.getvalue()


# A scene file holds the path alone.
NamedMesh = Annotated[
    MeshFile,
    BeforeValidator(by_path(MeshFile)),
    PlainSerializer(to_path, return_type=str),
    WithJsonSchema(PATH_SCHEMA),
]
