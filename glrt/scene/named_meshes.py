"""Meshes that a scene names: the path of a file, its SHA-256, and its triangles once it is read."""

import hashlib
from io import BytesIO
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field, PlainSerializer, PrivateAttr, WithJsonSchema

from glrt.scene.triangle_meshes import TriangleMesh, checked
from glrt.scene.values import Name
from glrt.settings import Frozen

_LONGEST = 1000  # characters of a path


class MeshFile(Frozen):
    """A mesh in a file; equal to another if path and content are."""

    file: Annotated[Name, Field(max_length=_LONGEST)] = Field(
        description="path with '/', relative to the folder of the scene"
    )
    sha256: str | None = Field(None, description="of the content, in hex, where it is known")

    _triangles: TriangleMesh | None = PrivateAttr(None)
    _origin: Path | None = PrivateAttr(None)
    _content: bytes | None = PrivateAttr(None)

    @property
    def triangles(self) -> TriangleMesh | None:
        """None before the file is read."""
        return self._triangles

    @property
    def origin(self) -> Path | None:
        """The file that was read; None for a mesh from arrays."""
        return self._origin

    @property
    def content(self) -> bytes | None:
        """What the file of a mesh from arrays holds; None for one that was read."""
        return self._content

    def read_as(self, sha256: str, triangles: TriangleMesh, origin: Path | None) -> "MeshFile":
        """The mesh with its content."""
        found = MeshFile(file=self.file, sha256=sha256)
        found._triangles, found._origin = triangles.outward, origin
        return found

    def __eq__(self, other: object) -> bool:
        same = isinstance(other, MeshFile)
        return same and (self.file, self.sha256) == (other.file, other.sha256)  # type: ignore[attr-defined]

    def __hash__(self) -> int:
        return hash((self.file, self.sha256))


def mesh_of_arrays(vertices: Any, faces: Any, normals: Any = None) -> MeshFile:
    """A mesh from arrays, under the name of the file that it is saved as.

    Raises ValueError, which says what is wrong with which row.
    """
    triangles = checked(vertices, faces, normals)
    content = _ply(triangles)
    sha256 = hashlib.sha256(content).hexdigest()
    named = MeshFile(file=f"mesh-{sha256[:12]}.ply")
    found = named.read_as(sha256, triangles, None)
    found._content = content
    return found


def _ply(mesh: TriangleMesh) -> bytes:
    """A binary PLY file with every digit."""
    names = ["x", "y", "z"] + (["nx", "ny", "nz"] if mesh.normals is not None else [])
    columns = [mesh.vertices] + ([mesh.normals] if mesh.normals is not None else [])
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


def _of_path(value: Any) -> Any:
    if isinstance(value, MeshFile):
        return value
    if not isinstance(value, str):
        raise ValueError("must be the path of a file, a text")
    return MeshFile.model_validate({"file": value})


def _to_path(mesh: MeshFile) -> str:
    return mesh.file


# In a scene file, the path alone.
NamedMesh = Annotated[
    MeshFile,
    BeforeValidator(_of_path),
    PlainSerializer(_to_path, return_type=str),
    WithJsonSchema({"type": "string", "minLength": 1, "maxLength": _LONGEST}),
]
