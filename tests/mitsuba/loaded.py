"""Words of a scene as objects of Mitsuba, whose variant is set."""

from typing import Any

import numpy as np

from glrt.scene.export.meshes import Form
from glrt.scene.export.mitsuba.words import COMMENT, Pixels, Voxels, Words


def loaded(mi: Any, value: Any) -> Any:
    """The object that `mitsuba.load_dict` takes in place of a value of words."""
    if isinstance(value, np.ndarray):
        return mi.ScalarTransform4f(value.tolist())
    if isinstance(value, Pixels):
        return mi.Bitmap(value.values)
    if isinstance(value, Voxels):
        return mi.VolumeGrid(value.values)
    if not isinstance(value, dict):
        return value
    if value["type"] == "rgb":
        return value
    if value["type"] == "look_at":
        return mi.ScalarTransform4f().look_at(*value["places"])
    if value["type"] == "mesh":
        return _mesh(mi, value)
    return {key: loaded(mi, part) for key, part in value.items() if key != COMMENT}


def _mesh(mi: Any, words: Words) -> Any:
    """A mesh, placed in float64."""
    form: Form = words["form"]
    points, normals = form.points, form.normals
    if (place := words.get("to_world")) is not None:
        points = points @ place[:3, :3].T + place[:3, 3]
        if normals is not None:
            normals = normals @ np.linalg.inv(place[:3, :3])
            normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    properties = mi.Properties()
    for name, part in words.items():
        if name not in ("type", "form", "to_world", COMMENT):
            properties[name] = mi.load_dict(loaded(mi, part))
    has = {"has_vertex_normals": normals is not None, "has_vertex_texcoords": form.uv is not None}
    mesh = mi.Mesh("mesh", len(points), len(form.faces), properties, **has)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = np.ravel(points)
    parameters["faces"] = np.ravel(form.faces)
    if normals is not None:
        parameters["vertex_normals"] = np.ravel(normals)
    if form.uv is not None:
        parameters["vertex_texcoords"] = np.ravel(form.uv)
    parameters.update()
    return mesh
