"""A camera that a glTF file gives: what a reload of the scene shows, and what a save writes."""

from collections.abc import Iterator
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from glrt.core.errors import GlrtError
from glrt.scene.camera import OF_FILE, Camera
from glrt.scene.files.assets import AssetFolder, AssetReader
from glrt.scene.files.named_cameras import CameraFile, Cameras
from glrt.scene.files.path_text import text_of
from glrt.scene.loading.file_camera import TIME
from glrt.scene.loading.file_contents import with_content
from glrt.scene.loading.scene_files import named_files
from glrt.scene.model_files.mesh_formats import AS_GLTF
from glrt.scene.scene import Scene
from glrt.view.controls import made, replaced

_KEPT = 8  # files whose cameras are kept

LOOKS = (*OF_FILE, "focus_distance", "defocus_angle")
PLACE = ("position", "look_at", "up")


def seen_as_before(found: Scene, camera: Camera) -> Scene:
    """Return a scene that was read again, seen by the camera of the window.

    Where that follows a file, the camera is that of the file as it is now.
    """
    looks = {name: value for name, value in camera if name in LOOKS}
    return replaced(found, camera=replaced(found.camera, **looks))


def to_be_saved(scene: Scene, opened: Camera) -> Scene:
    """Return the scene that a save writes; `opened` is the camera of the scene as it was opened.

    A camera that its file moves keeps the place that it was opened with: a place of its own, to
    which the user moved it in the window, would hold it there in a film.
    """
    camera = scene.camera
    if TIME not in (track.keys for track in (scene.animation.tracks if scene.animation else ())):
        return scene
    fields: dict[str, Any] = {name: value for name, value in camera if name not in PLACE}
    fields |= {name: value for name, value in opened if name in PLACE}
    return replaced(scene, camera=Camera.model_validate(fields))


def cameras_of(scene: Scene) -> dict[str, Camera]:
    """Return the cameras of the glTF and USD files that a scene names, by the name of their node.

    Where there are several files, their names stand before. Cameras stand as in the pose without
    animation. A file or a camera that cannot be read is left out.
    """
    files = dict(_gltf_files(scene))
    found = dict[str, Camera]()
    for path, (origin, sha256) in files.items():
        for node, camera in _cameras_in(origin, sha256).items():
            found[f"{path}: {node}" if len(files) > 1 else node] = camera
    return found


def _gltf_files(scene: Scene) -> Iterator[tuple[str, tuple[str, str | None]]]:
    """Yield paths of glTF files, with the place where each was read, and its SHA-256."""
    for _, named in named_files(scene):
        if named.origin and named.path.lower().endswith(AS_GLTF):
            yield named.path, (str(named.origin), named.sha256)


@lru_cache(_KEPT)
def _cameras_in(origin: str, _sha256: str | None) -> dict[str, Camera]:
    file = Path(origin)
    found = dict[str, Camera]()
    with suppress(GlrtError):
        reader = AssetReader(AssetFolder(file.parent))
        named = with_content(made(CameraFile, {"file": text_of(file.name)}), reader, origin)
        assert isinstance(named, CameraFile)
        assert named.cameras
        for name in named.cameras.names:
            with suppress(ValueError, GlrtError):
                found[name] = _camera(named.cameras, name)
    return found


def _camera(cameras: Cameras, name: str) -> Camera:
    """Return a camera of a file by numbers, which no animation moves."""
    view = cameras.find(name).view()
    fields = {key: tuple(map(float, getattr(view, key))) for key in PLACE}
    return made(Camera, {**fields, "fov": view.fov})
