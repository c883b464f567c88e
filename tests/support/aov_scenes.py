"""Scenes for AOVs."""

from typing import Any

from glrt.scene.scene import Scene
from tests.support.builders import MATTE, glass, lamp, plane, quad, scene_of, sphere

PAINT = [0.25, 0.3, 0.75]
MATERIALS: dict[str, dict[str, Any]] = {
    "paint": {"type": "lambertian", "color": PAINT},
    "glass": glass(1.5),
    "steel": {"type": "metal", "color": [0.7, 0.6, 0.5], "roughness": 0.3},
    "mirror": {"type": "metal", "color": [0.9, 0.8, 0.1]},
    "lamp": lamp(50.0),
    "painted lamp": lamp(50.0, albedo=0.5),
}
# Every kind of shape and material: so all worlds have one kernel, which is compiled once.
_BEHIND = [
    plane([0, 0, 90], [0, 0, 1], "paint"),
    quad([0, 0, 80], [1, 0, 0], [0, 1, 0], "paint"),
    *(sphere([3 * n, 0, 70], 1, name) for n, name in enumerate(MATERIALS)),
]


def world(*objects: dict[str, Any], **camera: Any) -> Scene:
    """Objects in front of a camera that looks along -z from about the origin; and sky."""
    sky = {"color": [0.25, 0.5, 1.0]}
    return scene_of([*objects, *_BEHIND], MATERIALS, {"fov": 90.0, **camera}, background=sky)


def heap(scale: float = 1.0, offset: tuple[float, float, float] = (0, 0, 0)) -> Scene:
    """Every kind of shape in mixed order, glass, lamps, and sky between them, scaled and moved.

    Its coordinates are exact in float64.
    """

    def at(*point: float) -> list[float]:
        return [scale * (c + o) for c, o in zip(point, offset, strict=True)]

    def along(*edge: float) -> list[float]:
        return [scale * c for c in edge]

    objects = [
        quad(at(-2, 0.25, -2), along(1.5, 0, 0), along(0, 1.5, 0.25), "matte"),
        sphere(at(0.75, 0.5, -1), scale * 0.75, "glass"),
        plane(at(0, -1, 0), [0, 1, 0], "matte"),
        sphere(at(-0.75, -0.5, 0), scale * 0.5, "matte"),
        quad(at(0.25, -1, 0.5), along(0.75, 0, 0.25), along(0, 0.75, 0), "lamp"),
        sphere(at(1.75, 1.25, -2), scale * 0.375, "lamp"),
    ]
    eye = {"position": at(0.125, 0.25, 3.0), "look_at": at(0, 0.125, 0)}
    materials = {"matte": MATTE, "glass": glass(1.5), "lamp": lamp(2.0, albedo=0.25)}
    return scene_of(objects, materials, eye, background={"color": [0.25, 0.5, 1.0]})
