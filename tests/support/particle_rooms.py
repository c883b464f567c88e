"""Rooms in which particles from lamps bring light, and what they meet there."""

from typing import Any

import numpy as np

from glrt.scene.scene import Scene
from tests.support.builders import (
    box,
    box_of_quads,
    cylinder,
    disk,
    glass,
    lamp,
    plane,
    quad,
    scene_of,
    sphere,
)
from tests.support.meshes import icosphere, mesh

CAMERA = {"position": [0, 0, 0.9], "look_at": [0, -0.3, -1], "fov": 80}
MATERIALS: dict[str, dict[str, Any]] = {
    "matte": {"type": "lambertian", "color": [0.6, 0.5, 0.4]},
    "glass": glass(),
    "tinted": glass(attenuation_color=[0.2, 0.5, 0.9], attenuation_distance=0.3),
    "pane": glass(thin=True),
    "mirror": {"type": "metal", "color": [0.9, 0.8, 0.7], "roughness": 0},
    "gold": {"type": "metal", "preset": "gold", "roughness": 0.3},
    "tumbler": glass(priority=1, attenuation_color=[0.6, 0.9, 0.8], attenuation_distance=0.4),
    "air": glass(1.0, priority=2),
    "water": glass(1.33, priority=3),
    "ice": glass(1.31, priority=4),
    "dim": lamp(0.7),
    "plastic": {"type": "principled", "color": [0.2, 0.5, 0.8]},
    "varnish": {
        "type": "principled",
        "color": [0.2, 0.5, 0.8],
        "roughness": 0.6,
        "clearcoat": 1.0,
        "clearcoat_roughness": 0.0,
    },
    "satin": {
        "type": "principled",
        "color": [0.7, 0.6, 0.5],
        "roughness": 0.4,
        "clearcoat": 0.5,
        "clearcoat_roughness": 0.5,
    },
    "matt glass": glass(roughness=0.3),
    "frosted": glass(roughness=0.4, attenuation_color=[0.6, 0.8, 0.9], attenuation_distance=0.5),
    "jelly": {"type": "principled", "color": [0.9, 0.8, 0.7], "transmission": 0.8, "roughness": 0},
    "polished": {
        "type": "principled",
        "color": [0.95, 0.8, 0.5],
        "metallic": 0.8,
        "roughness": 0.0,
        "clearcoat": 0.5,
        "clearcoat_roughness": 0.3,
    },
    "lamp": lamp(12.0),
    "spot": lamp(60.0, cone={"axis": [0.2, -1, 0], "inner": 20, "outer": 50}),
}
BALL = sphere([0.35, -0.6, -0.3], 0.35, "glass")
LAMP = quad([-0.25, 0.9, -0.4], [0.5, 0, 0], [0, 0, 0.4], "lamp")


def room(*things: dict[str, Any], **camera: Any) -> Scene:
    """A closed matte room."""
    return scene_of([*box_of_quads("matte"), *things], MATERIALS, {**CAMERA, **camera})


SHADE = np.array([[-0.3, 0.9, -0.5], [0.2, 0.9, -0.5], [0.3, 0.8, 0], [-0.2, 0.9, 0]])
DRINK = [
    cylinder([0.3, -1, -0.4], [0.3, -0.2, -0.4], 0.35, "tumbler"),
    cylinder([0.3, -0.9, -0.4], [0.3, -0.1, -0.4], 0.3, "air"),
    cylinder([0.3, -0.95, -0.4], [0.3, -0.4, -0.4], 0.32, "water"),
    sphere([0.3, -0.45, -0.4], 0.12, "ice"),
]


def outside(*things: dict[str, Any]) -> Scene:
    """A matte floor and a far mirror under a low sun, larger than ours."""
    ground = [plane([0, -1, 0], [0, 1, 0], "matte"), plane([0, 0, 30], [0, 0, -1], "mirror")]
    wall = box([-1, -1, -2.2], [1, 0, -2], "matte")
    sun = {"direction": [0.4, 0.7, -0.3], "angle": 12.0, "irradiance": [3, 2.8, 2.4]}
    return scene_of([*ground, wall, *things], MATERIALS, CAMERA, sun=sun)


GOLD = sphere([-0.45, -0.65, -0.3], 0.35, "gold")
FROSTED = {**BALL, "material": "frosted"}
ROOMS = {
    "a ball of glass": room(LAMP, BALL),
    "a round lamp and a mirror": room(
        sphere([0, 0.6, -0.2], 0.15, "lamp"), sphere([0.3, -0.5, 0], 0.4, "mirror")
    ),
    "a lens": room(LAMP, BALL, defocus_angle=4, focus_distance=1.2),
    "tinted glass": room(LAMP, {**BALL, "material": "tinted"}),
    "a lamp in glass": room(sphere([0, 0, -0.3], 0.1, "lamp"), sphere([0, 0, -0.3], 0.3, "glass")),
    "lamps of several kinds": room(
        quad([-0.9, 0.2, -0.9], [0.3, 0, 0], [0, 0.4, 0.1], "spot"),
        disk([0.5, 0.95, -0.5], [0, -1, 0], 0.1, "lamp"),
        sphere([-0.5, 0.6, 0.3], 0.05, "lamp"),
        BALL,
    ),
    "a disk": room(disk([0.1, 0.9, -0.3], [0.2, -1, 0], 0.25, "lamp"), BALL),
    "a mesh that shines, one of glass": room(
        mesh((SHADE, np.array([[0, 1, 2], [0, 2, 3]])), "lamp", smooth=False),
        mesh(icosphere(1), "glass", translate=BALL["center"], scale=0.35, smooth=False),
    ),
    "water in a glass": room(LAMP, *DRINK),
    "the sun": outside(BALL, cylinder([-0.5, -1, -0.5], [-0.5, -0.4, -0.5], 0.2, "glass")),
    "the sun, a lamp and a drink": outside(quad([-1, 1, -2], [2, 0, 0], [0, 1, 0], "dim"), *DRINK),
    "glass in part": room(LAMP, {**BALL, "material": "jelly"}),
    "varnished walls": scene_of(
        [
            *box_of_quads("varnish"),
            *(LAMP, BALL, sphere([-0.5, -0.7, -0.2], 0.3, "matte")),
            quad([-0.6, -0.2, -0.6], [0.8, 0, 0], [0, 0, 0.8], "pane"),
        ],
        MATERIALS,
        CAMERA,
    ),
    "glossy surfaces": scene_of(
        [*box_of_quads("satin"), LAMP, sphere([0.3, 0.2, -0.3], 0.3, "glass"), FROSTED, GOLD],
        MATERIALS,
        CAMERA,
    ),
    "a lamp in frosted glass": room(
        sphere([0, 0, -0.3], 0.1, "lamp"), sphere([0, 0, -0.3], 0.3, "matt glass"), GOLD
    ),
    "the sun on glossy surfaces": outside(FROSTED, GOLD),
}
SHEET = np.array([[-0.9, -0.95, 0.6], [0.9, -0.95, 0.6], [0.9, -0.95, -0.9], [-0.9, -0.95, -0.9]])
BENT = np.array([[-1, 1, 1], [1, 1, 1], [1, 1, -1], [-1, 1, -1]]) / np.sqrt(3)
POLISHED = {
    "dented sheet": room(
        LAMP,
        mesh((SHEET, np.array([[0, 1, 2], [0, 2, 3]])), "polished", smooth=True, normals=BENT),
    ),
    "hall": scene_of([*box_of_quads("polished"), LAMP, BALL], MATERIALS, CAMERA),
    "shelf": room(
        LAMP,
        BALL,
        {**GOLD, "material": "polished"},
        mesh(icosphere(1), "varnish", translate=[0.1, -0.7, 0.2], scale=0.25, smooth=True),
        mesh(icosphere(1), "polished", translate=[0.5, 0.2, -0.6], scale=0.3, smooth=True),
    ),
}
