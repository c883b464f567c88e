"""A scene as the bytes of the thesis's buffers.

The numbers are those of `glrt.packing.scene_arrays`, relative to the camera: both versions read
these.
"""

from typing import Any

import numpy as np

from glrt.core.errors import SceneError
from glrt.gpu.structs import read_constants, record
from glrt.packing.scene_arrays import pack_camera
from glrt.plan.facts import SceneFacts
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.support.packed import packed
from tests.wgsl.text import read, struct

Array = np.ndarray[Any, Any]

_CONSTANTS = read_constants(read("scene").replace(": i32", "").replace("const", "const int"))
_POSITIONS = {"SPHERE": "center", "PLANE": "point", "QUAD": "corner"}


def camera_buffer(scene: Scene, settings: Settings) -> bytes:
    """Position is the origin; orientation, focus and lens as in `glrt.packing.scene_arrays`."""
    camera = pack_camera(scene.camera, settings.width / settings.height)
    return record(struct("Camera"), camera).tobytes()


def object_buffer(scene: Scene) -> bytes:
    """Every shape in a row of one kind: spheres, planes, quads, as the kernel numbers them."""
    arrays = packed(scene)
    return b"".join(
        _objects(kind, arrays[kind.capitalize()], position) for kind, position in _POSITIONS.items()
    ) or bytes(struct("Object").itemsize)


def material_buffer(scene: Scene) -> bytes:
    """The materials that some shape is made of."""
    row = struct("Material")
    return _taken(packed(scene)["Material"], row).tobytes() or bytes(row.itemsize)


def settings_buffer(scene: Scene, settings: Settings) -> bytes:
    """The buffer of values that stay the same from frame to frame."""
    kinds = [shape.shape for shape in scene.objects]
    if scene.background.horizon or not {"sphere", "plane", "quad"}.issuperset(kinds):
        raise SceneError("a horizon, or a shape: WGSL has spheres, planes and quads alone.")
    if SceneFacts(scene).mapped:
        raise SceneError("a texture: WGSL has none.")
    bottom, top = scene.background_colors
    values = {
        "background_bottom": bottom,
        "bounces": settings.bounces,
        "background_top": top,
        "zero": 0,
        "size": (settings.width, settings.height),
        **{f"{kind}_count": kinds.count(kind) for kind in ("sphere", "plane", "quad")},
    }
    return record(struct("Settings"), values).tobytes()


def _objects(kind: str, shapes: Array, position: str) -> bytes:
    rows = _taken(shapes, struct("Object"))
    rows["kind"] = _CONSTANTS[kind]
    rows["position"] = shapes[position]
    return rows.tobytes()


def _taken(rows: Array, dtype: np.dtype[Any]) -> Array:
    """The fields that both have, by name; zeros for the others."""
    taken = np.zeros(len(rows), dtype)
    for name in set(dtype.names or ()) & set(rows.dtype.names or ()):
        taken[name] = rows[name]
    return taken
