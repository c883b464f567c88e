"""Meshes from the content of model files, written out in a test."""

import numpy as np
import pytest

from glrt.core.errors import SceneError
from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.model_files.mesh_formats import decode_mesh


def read(content: str | bytes, suffix: str = ".obj") -> TriangleMesh:
    """The mesh in the content of a file."""
    data = content.encode() if isinstance(content, str) else content
    return decode_mesh(data, f"thing{suffix}", "x")


def refusal(content: str | bytes, suffix: str = ".obj") -> str:
    """Why the content of a file is refused."""
    with pytest.raises(SceneError) as refused:
        read(content, suffix)
    return str(refused.value)


def area(mesh: TriangleMesh) -> float:
    """Area of all triangles."""
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)
