"""The studio of a model that has no light of its own: a soft lamp, an even sky and a ground."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.scene.camera import Camera
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.light import Light
from glrt.scene.materials.principled import Principled
from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.scene import Scene
from glrt.scene.schema.validation import validated

Table = dict[str, Any]
Vector = NDArray[np.float64]

LIGHT, GROUND = "studio light", "studio ground"  # names of objects and materials
SKY = {"bottom": [0.23] * 3, "horizon": [0.23] * 3, "top": [0.65] * 3}  # radiance

LEAST_RADIUS = 1e-9  # radius of a model, in scene units
_LEAST_EMISSION = 0.05  # least mean radiance over all surfaces of a model that lights itself
_UP = np.array([0.0, 1.0, 0.0])
_TOWARDS = np.array([-0.75, 1.0, 0.55])  # the lamp: along the camera's right, up, and back
_LEAST_DISTANCE = 3.0  # distance of the lamp from the middle, in radii of the model
_EDGE = 0.8  # edge of the lamp, over its distance
_EMISSION = (
    4.5,
    4.5,
    4.5,
)  # radiance; with SKY about 1 on a white surface that faces lamp and sky
_GROUND_COLOR = (0.45, 0.45, 0.45)
_GAP = 1e-3  # between model and ground, in radii: surfaces in one plane would hide one another


def lights_itself(scene: Scene) -> bool:
    """Return whether the meshes of a scene emit enough to be seen by their own light.

    Unlit surfaces and textures of emission do not count: they show a color and are no lamps.
    """
    area, flux = 0.0, 0.0
    for mesh in scene.meshes:
        size, material = _area(mesh.triangles), scene.materials[mesh.material]
        area += size
        if material.emits and not _shows_a_color(material):
            flux += size * sum(scene.emission_of(mesh)) / 3
    return flux >= _LEAST_EMISSION * area


def studio_note(scene: Scene) -> str:
    """Return a sentence about the studio that a scene has got; "" without one."""
    if not any(thing.name == LIGHT for thing in scene.objects):
        return ""
    emits = any(scene.materials[mesh.material].emits for mesh in scene.meshes)
    why = (
        f"its surfaces emit less than {_LEAST_EMISSION:g} on average, too little to light it"
        if emits
        else "it has no light of its own"
    )
    return (
        f"A studio was added to the model, a lamp, a sky and a ground: {why}. To leave it out, "
        "write the scene by `glrt import MODEL -o scene.toml`, and give it other lights there."
    )


def _shows_a_color(material: Material) -> bool:
    is_unlit = isinstance(material, Principled) and material.is_unlit
    return is_unlit or (isinstance(material, Opaque) and "emission" in material.textures)


def _area(mesh: TriangleMesh) -> float:
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] for corner in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2


def with_studio(scene: Scene, source: str) -> Scene:
    """Return the scene of one model in a studio, as its camera sees it.

    The lamp stands above and to the left of the camera, as far away as the camera, so that it stays
    out of the picture. The ground is left out where the camera is below it.
    """
    low, high = scene.meshes[0].triangles_of_file.box
    center, radius = (low + high) / 2, max(float(np.linalg.norm(high - low)) / 2, LEAST_RADIUS)
    eye = np.array(scene.camera.position, np.float64)
    distance = max(float(np.linalg.norm(eye - center)), _LEAST_DISTANCE * radius)
    materials: Table = {**scene.materials, LIGHT: Light(emission=_EMISSION)}
    objects: list[Any] = [*scene.objects, _lamp(center, _towards(scene.camera), distance)]
    height = low[1] - _GAP * radius
    if eye[1] > height:
        materials[GROUND] = Lambertian(color=_GROUND_COLOR)
        point = [center[0], height, center[2]]
        ground = {"shape": "plane", "point": point, "normal": _UP, "name": GROUND}
        objects.append({**ground, "material": GROUND})
    update = {"background": SKY, "materials": materials, "objects": objects}
    return validated(Scene, dict(scene) | update, source)


def _towards(camera: Camera) -> Vector:
    """Return the unit vector from the model to the lamp, (3,)."""
    forward = np.subtract(camera.look_at, camera.position)
    right = np.cross(forward, camera.up) * (1.0, 0.0, 1.0)
    length = float(np.linalg.norm(right))
    right = right / length if length > 0 else np.array([1.0, 0.0, 0.0])
    towards: Vector = _TOWARDS @ np.array([right, _UP, np.cross(right, _UP)])
    return towards / np.linalg.norm(towards)


def _lamp(center: Vector, towards: Vector, distance: float) -> Table:
    """Return a square that faces the middle: the normal of a quad is edge_u x edge_v."""
    across = np.cross(_UP, towards)
    across /= np.linalg.norm(across)
    along = np.cross(across, towards)
    edge = _EDGE * distance
    return {
        "shape": "quad",
        "corner": center + distance * towards - edge / 2 * (across + along),
        "edge_u": edge * across,
        "edge_v": edge * along,
        "material": LIGHT,
        "name": LIGHT,
        "emission_side": "front",
    }
