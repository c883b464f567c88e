"""A scene of a model file alone: with its own cameras and lights, or usual ones."""

import math
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from glrt.errors import SceneError
from glrt.scene.assets import Asset, AssetFolder, AssetReader
from glrt.scene.file_contents import Beside, with_content
from glrt.scene.gltf.document import Document
from glrt.scene.gltf.looks import looks_of
from glrt.scene.gltf.stage import camera_of, left_out, lights_of
from glrt.scene.loading import with_files
from glrt.scene.mesh_formats import FORMATS, GLTF, libraries
from glrt.scene.named_meshes import MeshFile
from glrt.scene.path_text import name_of, text_of
from glrt.scene.scene import Scene
from glrt.scene.triangle_meshes import TriangleMesh
from glrt.scene.validation import validated

Table = dict[str, Any]

FOV = 35.0  # degrees
_FROM = np.array([0.65, 0.45, 1.0])  # where the camera stands: three quarters, above
_LIGHT_FROM = np.array([-0.7, 1.0, 0.8])
_EDGE = 512  # the longer one of the picture, pixels
_CLAY = {"type": "lambertian", "color": [0.6, 0.58, 0.55]}


def is_model(path: Path) -> bool:
    """Whether the name of a file is that of a model."""
    return path.suffix.lower() in FORMATS


def model_scene(path: Path, folder: AssetFolder, source: str) -> Scene:
    """The scene of a model with the content of its files; `source` is what messages call it.

    Without a camera it is seen from three quarters above; without lights and emission a soft light
    of a studio stands beside it. Raises `SceneError`.
    """
    reader = AssetReader(folder)
    name = text_of(path.name)
    asset = reader.read(name, source)
    file = with_content(validated(MeshFile, {"file": name}, source), reader, source)
    assert isinstance(file, MeshFile)
    assert file.triangles
    tables: Table = {
        "title": name,
        "materials": {},
        "objects": [{"shape": "mesh", "file": file, "material": ""}],
        **_view(file.triangles),
    }
    if path.suffix.lower() in GLTF:
        _add_stage(tables, asset, reader, file.triangles, source)
    else:
        _add_studio(tables, file.triangles)
        if not _has_materials(asset, folder, file.triangles):
            tables["materials"]["clay"] = _CLAY
            tables["objects"][0]["material"] = "clay"
    return with_files(validated(Scene, tables, source), folder, source)


def _add_stage(
    tables: Table, asset: Asset, reader: AssetReader, mesh: TriangleMesh, source: str
) -> None:
    """Cameras and lights of a glTF file, where it has some."""
    try:
        document = Document(asset.content, Beside(asset, reader, source))
        lights = lights_of(document, _ball(mesh)[1])
        looks = looks_of(document, asset.path)
        camera = camera_of(document)
    except ValueError as error:
        raise SceneError(f"{source}: {error}. Export the file again.") from None
    thing, suns = tables["objects"][0], lights["suns"]
    thing["file"] = thing["file"].with_libraries({}, left_out(camera, len(suns), document))
    shines = any(isinstance(looks[name].table.get("emission"), tuple) for name in mesh.parts)
    if camera:
        tables["camera"], aspect = camera
        tables["render"] = _size(aspect or 1.0)
    if lights["objects"] or suns:
        tables["materials"] = lights["materials"]
        tables["objects"] += lights["objects"]
        if suns:
            tables["sun"] = suns[0]
    elif not shines:
        _add_studio(tables, mesh)


def _has_materials(asset: Asset, folder: AssetFolder, mesh: TriangleMesh) -> bool:
    """Whether a file uses materials that lie beside it."""
    paths = libraries(asset.content) if PurePosixPath(asset.path).suffix.lower() == ".obj" else []
    there = [(folder.base / name_of(path)).is_file() for path in paths]
    return bool(paths) and all(there) and bool(mesh.parts) and "" not in mesh.parts


def _ball(mesh: TriangleMesh) -> tuple[Any, float]:
    """Middle and radius of a ball around a mesh."""
    low, high = mesh.box
    return (low + high) / 2, max(float(np.linalg.norm(high - low)) / 2, 1e-9)


def _view(mesh: TriangleMesh) -> Mapping[str, Any]:
    """A camera that has all of a mesh in its picture."""
    center, radius = _ball(mesh)
    away = _FROM / np.linalg.norm(_FROM) * radius / math.sin(math.radians(FOV) / 2)
    return {"camera": {"position": center + away, "look_at": center, "fov": FOV}}


def _size(aspect: float) -> Table:
    """Of a picture whose longer edge has _EDGE pixels."""
    longest = max(aspect, 1.0)
    width, height = (max(round(_EDGE * edge / longest), 1) for edge in (aspect, 1.0))
    return {"width": width, "height": height}


def _add_studio(tables: Table, mesh: TriangleMesh) -> None:
    """Add a soft light above, on the left of the camera, and an even surrounding."""
    center, radius = _ball(mesh)
    towards = _LIGHT_FROM / np.linalg.norm(_LIGHT_FROM)
    across = np.cross([0.0, 1.0, 0.0], towards)
    across /= np.linalg.norm(across)
    along = np.cross(towards, across)
    edge = 3 * radius
    corner = center + 4 * radius * towards - edge / 2 * (across + along)
    lamp = {
        "shape": "quad",
        "corner": corner,
        "edge_u": edge * across,
        "edge_v": edge * along,
        "material": "studio light",
        "name": "studio light",
        "emission_side": "front",
    }
    tables["background"] = {"bottom": [0.3] * 3, "horizon": [0.55] * 3, "top": [0.9] * 3}
    tables["materials"]["studio light"] = {"type": "light", "emission": [5.0] * 3}
    tables["objects"].append(lamp)
