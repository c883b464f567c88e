"""The scene of a model file alone, with the file's cameras and lights or usual ones."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from glrt.core.errors import SceneError, of_content
from glrt.scene.files.assets import Asset, AssetFolder, AssetReader
from glrt.scene.files.named_meshes import MeshFile
from glrt.scene.files.path_text import text_of
from glrt.scene.loading.companions import Beside
from glrt.scene.loading.file_camera import TIME, picture_size, track_of_time
from glrt.scene.loading.file_contents import with_content
from glrt.scene.loading.scene_files import with_files
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.meshes.triangle_meshes import Poses, TriangleMesh
from glrt.scene.model_files.conversion.document import ConvertedDocument
from glrt.scene.model_files.gltf.cameras import FileCamera, camera_of, left_out
from glrt.scene.model_files.gltf.lights import is_lit, lights_of
from glrt.scene.model_files.mesh_formats import AS_GLTF, FORMATS
from glrt.scene.scene import Scene
from glrt.scene.schema.validation import validated
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.studio import LEAST_RADIUS, lights_itself, with_studio

Table = dict[str, Any]

FOV = 35.0  # degrees
_FROM = np.array([0.65, 0.45, 1.0])  # from the model to the camera: three quarters, above
MODEL = "model"  # name of the object, which a track of an animation needs
CLAY = (0.6, 0.58, 0.55)  # color of surfaces without a material


def is_model(path: Path) -> bool:
    """Return whether the name of a file is that of a model."""
    return path.suffix.lower() in FORMATS


def model_scene(path: Path, folder: AssetFolder, source: str, variant: str | None = None) -> Scene:
    """Return the scene of a model with the content of its files; messages call it `source`.

    Without a camera, the model is seen from three quarters above. It stands in a studio if the file
    has no lights and its own emission does not light it. `variant` names one of its materials'
    variants. Raises `SceneError`.
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
        "objects": [{"shape": "mesh", "file": file, "variant": variant, "smooth": "auto"}],
        **_view(file.triangles),
    }
    if poses := file.triangles.poses:
        _animate(tables, poses)
    has_lights = False
    if path.suffix.lower() in AS_GLTF:
        has_lights = _add_stage(tables, asset, reader, file.triangles, source)
    elif not file.triangles.parts:
        tables["materials"]["clay"] = Lambertian(color=CLAY)
        tables["objects"][0]["material"] = "clay"
    scene = with_files(validated(Scene, tables, source), reader, source, Lambertian(color=CLAY))
    return scene if has_lights or lights_itself(scene) else with_studio(scene, source)


def mesh_scene(mesh: Mesh, source: str) -> Scene:
    """Return the scene of a mesh of arrays, of clay in a studio, seen from three quarters above.

    Colours of its vertices multiply that of the clay. Raises `SceneError`, which begins with
    `source`.
    """
    placed = mesh.model_copy(update={"material": "clay"})
    tables: Table = {
        "materials": {"clay": Lambertian(color=CLAY)},
        "objects": [placed],
        **_view(mesh.triangles_of_file),
    }
    return with_studio(validated(Scene, tables, source), source)


def _animate(tables: Table, poses: Poses) -> None:
    """Add a track that plays the usual animation of a file, if it moves."""
    seconds = poses.seconds(poses.usual)
    if seconds > 0:
        tables["objects"][0]["name"] = MODEL
        _add_track(tables, seconds, ("objects", MODEL, "time"))


def _add_track(tables: Table, seconds: float, target: tuple[str, ...] = TIME) -> None:
    tracks = tables.get("animation", {}).get("tracks", ())
    tables["animation"] = {"tracks": (*tracks, track_of_time(seconds, target))}


def _add_camera(tables: Table, name: str, camera: FileCamera) -> None:
    """Add a camera by numbers, or by the name of its node if the file moves it."""
    tables["render"] = picture_size(camera.aspect or 1.0)
    if camera.usual is None:
        tables["camera"] = camera.view()._asdict()
    else:
        tables["camera"] = {"file": tables["objects"][0]["file"].file, "node": name}
        _add_track(tables, camera.seconds(camera.usual))


def _add_stage(
    tables: Table, asset: Asset, reader: AssetReader, mesh: TriangleMesh, source: str
) -> bool:
    """Add cameras and lights of a glTF or USD file; return whether it has lights, or says so."""
    try:
        document = Beside(asset, reader, source).document()
        lights = (
            document.lights(asset.path)
            if isinstance(document, ConvertedDocument)
            else lights_of(document, _ball(mesh)[1])
        )
        camera = camera_of(document)
        if camera:
            _add_camera(tables, *camera)
        if camera and isinstance(document, ConvertedDocument):
            tables["camera"] |= document.lens(camera[1].chain[-1][0])
    except ValueError as error:
        raise SceneError(f"{source}: {of_content(error)}. Export the file again.") from None
    thing, suns = tables["objects"][0], lights["suns"]
    thing["file"] = thing["file"].with_libraries({}, left_out(camera, len(suns), document))
    tables["materials"] |= lights["materials"]
    tables["objects"] += lights["objects"]
    if suns:
        tables["sun"] = suns[0]
    if "background" in lights:
        tables["background"] = lights["background"]
    has_lights = bool(lights["objects"] or suns or "background" in lights)
    return has_lights or is_lit(document)


def _ball(mesh: TriangleMesh) -> tuple[Any, float]:
    """Return middle and radius of a ball around a mesh."""
    low, high = mesh.box
    return (low + high) / 2, max(float(np.linalg.norm(high - low)) / 2, LEAST_RADIUS)


def _view(mesh: TriangleMesh) -> Mapping[str, Any]:
    """Return a camera that has all of a mesh in its picture."""
    center, radius = _ball(mesh)
    away = _FROM / np.linalg.norm(_FROM) * radius / math.sin(math.radians(FOV) / 2)
    return {"camera": {"position": center + away, "look_at": center, "fov": FOV}}
