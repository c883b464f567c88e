"""Scenes of what `glrt.show` takes: scenes, files, names, meshes and arrays."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import UsageError
from glrt.image.sources import load
from glrt.scene.images.codes import decode_srgb
from glrt.scene.model_scene import mesh_scene
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh

_KINDS = "a glrt.Scene, a path or name, a mesh of trimesh, or arrays of vertices and faces"


def scene_of(source: Any, faces: Any = None) -> Scene:
    """Return the scene to show; a mesh stands in a studio, seen from three quarters above.

    `source` is a Scene, a path or name as `glrt.load` takes it, a mesh or scene of trimesh, or an
    array of vertices, (v, 3), with `faces`, (n, 3). Colours of a mesh's vertices are kept, its
    textures are not. Raises UsageError for anything else and for arrays that are no mesh, and the
    errors of `load`.
    """
    if faces is not None:
        return _of_arrays(source, faces)
    if isinstance(source, Scene):
        return source
    if isinstance(source, str | Path):
        return load(source)
    if hasattr(source, "to_mesh"):  # a trimesh.Scene: its meshes, joined
        source = source.to_mesh()
    if hasattr(source, "vertices") and hasattr(source, "faces"):
        return _of_arrays(source.vertices, source.faces, _vertex_colors(source))
    if isinstance(source, np.ndarray):
        raise UsageError("show got an array of vertices alone: give faces, (n, 3), as well.")
    raise UsageError(f"show takes {_KINDS}, got {type(source).__name__}.")


def _of_arrays(vertices: Any, faces: Any, colors: Any = None) -> Scene:
    try:
        mesh = Mesh(vertices, faces, colors=colors, smooth="auto")
    except ValueError as error:
        raise UsageError(f"show got arrays that are no mesh: {error}.") from None
    return mesh_scene(mesh, "show")


def _vertex_colors(mesh: Any) -> NDArray[np.float64] | None:
    """Return linear colours of a mesh of trimesh, (v, 3); None if its vertices have none."""
    visual: Any = getattr(mesh, "visual", None)
    if getattr(visual, "kind", None) != "vertex":
        return None
    return decode_srgb(np.asarray(visual.vertex_colors, np.float64)[:, :3] / 255)
