"""One scene with every shape, material and light at once, seen through a lens."""

from typing import Any

from glrt.scene.scene import Scene
from tests.support.builders import glass, lamp, plane, quad, scene_of, sphere

EYE = {"position": [0.1, 0.2, 3.0], "look_at": [0, 0, 0], "defocus_angle": 2.0}
MATERIALS: dict[str, dict[str, Any]] = {
    "white": {"type": "lambertian", "color": [0.8, 0.7, 0.6]},
    "red": {"type": "lambertian", "color": [0.8, 0.1, 0.1]},
    "glass": glass(1.5),
    "brass": {"type": "metal", "color": [0.9, 0.7, 0.3], "roughness": 0.4},
    "lamp": lamp(6.0),
}
OBJECTS = [
    plane([0, -1, 0], [0, 1, 0], "white"),
    sphere([-0.6, -0.4, 0], 0.6, "glass"),
    sphere([0.8, -0.5, 0.3], 0.5, "brass"),
    sphere([0.2, 0.9, 0.2], 0.2, "lamp"),
    quad([-2, 2, -2], [4, 0, 0], [0, 0, 2], "lamp"),
]
SKY = {"bottom": [0.1, 0.1, 0.2], "top": [0.3, 0.4, 0.6]}


def everything(
    objects: list[dict[str, Any]] = OBJECTS,
    camera: dict[str, Any] = EYE,
    materials: dict[str, dict[str, Any]] = MATERIALS,
    background: dict[str, Any] = SKY,
) -> Scene:
    """The scene, or a variation of it."""
    return scene_of(objects, materials, camera, background=background)
