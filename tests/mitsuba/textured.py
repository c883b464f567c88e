"""Triangles with texture coordinates, and textures, in the words of Mitsuba."""

from typing import Any

import numpy as np

from glrt.scene.materials.textures import Texture
from glrt.scene.values import Radiance
from tests.mitsuba.near import Vector

Words = dict[str, Any]

_FILTERS = {"linear": "bilinear", "nearest": "nearest"}


def mesh_of(
    mi: Any,
    surface: Words,
    points: Vector,
    triangles: Any,
    normals: Vector | None = None,
    uv: Vector | None = None,
) -> Any:
    """A mesh; `uv`, (v, 2), grows downwards, as in glrt."""
    properties = mi.Properties()
    for name, part in surface.items():
        properties[name] = mi.load_dict(part)
    has = {"has_vertex_normals": normals is not None, "has_vertex_texcoords": uv is not None}
    mesh = mi.Mesh("mesh", len(points), len(triangles), properties, **has)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = np.ravel(points)
    parameters["faces"] = np.ravel(triangles)
    if normals is not None:
        parameters["vertex_normals"] = np.ravel(normals)
    if uv is not None:
        parameters["vertex_texcoords"] = np.ravel(uv)
    parameters.update()
    return mesh


def bitmap(texture: Texture, factor: Radiance) -> Words:
    """An image whose colours are linear already."""
    import mitsuba as mi  # type: ignore[import-not-found, unused-ignore]

    pixels = texture.texels[..., :3].astype(np.float32) * np.array(factor, np.float32)
    matrix = np.eye(4)
    matrix[:2, [0, 1, 3]] = texture.transform
    return {
        "type": "bitmap",
        "bitmap": mi.Bitmap(np.ascontiguousarray(pixels)),
        "raw": True,
        "filter_type": _FILTERS[texture.filter],
        "wrap_mode": texture.wrap[0],
        "to_uv": mi.ScalarTransform4f(matrix.tolist()),
    }
