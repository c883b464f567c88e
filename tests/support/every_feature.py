"""Renders that together use every feature of the kernel, and the settings that ask for them.

tests/rendering/test_equal_bits.py renders each in every way, and fails if a feature is in none.
"""

from typing import Any

import numpy as np

from glrt.scene.density import Density
from glrt.scene.probes import Probes
from glrt.scene.scene import Scene
from tests.support.builders import box, cylinder, disk, lamp, plane, quad, scene_of, sphere
from tests.support.meshes import icosphere, mesh
from tests.support.particle_rooms import DRINK, MATERIALS, SHADE, room
from tests.support.sky_images import random_sky, spot, under
from tests.support.textures import random_image, with_images

FLOOR = plane([0, -1, 0], [0, 1, 0], "matte")
SUN = {"direction": [0.4, 0.7, 0.3], "angle": 12.0, "irradiance": [2.0, 1.9, 1.7]}
STILL_LIFE = {
    **MATERIALS,
    "mirror": {"type": "metal", "color": [0.9, 0.8, 0.7]},
    "prism": {"type": "dielectric", "dispersion": 2.0},
    "bathroom": {"type": "dielectric", "thin": True, "roughness": 0.4},
    "brass": {"type": "metal", "color": [0.9, 0.7, 0.3], "roughness": 0.4},
    "brushed": {
        "type": "principled",
        "metallic": 0.8,
        "anisotropy": 0.7,
        "iridescence": 0.8,
        "sheen": [0.5, 0.2, 0.3],
        "diffuse_transmission": 0.5,
    },
}
CONSTANTS = {"ambient": 0.1, "diffuse": 0.8, "specular": 0.5, "exponent": 20}
CHECKER = {"checker": [0.25, 0.75]}
MAPPED: dict[str, dict[str, Any]] = {
    "even": {"type": "lambertian", "color": [0.6, 0.5, 0.4]},
    "matte": {"type": "lambertian", "color": {"image": "paint.png"}},
    "glowing": {"type": "principled", "emission": CHECKER, "roughness": CHECKER},
    "bumpy": {"type": "principled", "normal": {"image": "bumps.png"}, "clearcoat": 0.5},
    "torn": {"type": "principled", "alpha": CHECKER},
    "label": {"type": "principled", "transmission": CHECKER, "roughness": 0.0},
    "lamp": lamp(6.0),
}
IMAGES = {"paint.png": random_image(8, 8), "bumps.png": random_image(16, 16, 2)}


def still_life() -> Scene:
    """Every solid and material that is no image, through a lens, under a gradient."""
    things = [
        sphere([-0.6, -0.5, -2.4], 0.5, "tinted"),
        sphere([0.5, -0.6, -2.2], 0.4, "mirror"),
        box([-1.6, -1, -3.4], [-0.8, 0.2, -2.8], "brass", rotate=(0, 25, 0)),
        cylinder([1.3, -1, -2.6], [1.1, 0.2, -2.9], 0.3, "gold"),
        disk([0, 0.3, -3.5], [0.3, 0.2, 1], 0.6, "brushed"),
        quad([-0.4, -0.9, -1.6], [0.8, 0, 0], [0, 0.7, -0.2], "pane"),
        quad([0.7, -0.9, -1.7], [0.5, 0, 0.1], [0, 0.6, 0], "bathroom"),
        sphere([0.1, -0.8, -1.8], 0.2, "frosted"),
        sphere([-0.25, -0.85, -1.75], 0.13, "prism"),
        sphere([1.1, 1.4, -2.0], 0.3, "lamp"),
        disk([-1.2, 1.6, -2.0], [0.3, -1, 0.2], 0.4, "lamp"),
    ]
    sky = {"bottom": [0.1, 0.1, 0.2], "horizon": [0.5, 0.4, 0.3], "top": [0.3, 0.4, 0.6]}
    return scene_of([FLOOR, *things], STILL_LIFE, {"defocus_angle": 2.0, "fov": 60}, background=sky)


def mapped() -> Scene:
    """Images on surfaces, meshes that are smooth, coloured or lamps, and the sun."""
    points, faces = icosphere(1)
    ball: dict[str, Any] = {"uv": points[:, :2], "smooth": True}
    things = [
        mesh((points, faces), "matte", translate=[-0.6, -0.4, -2.4], scale=0.5, **ball),
        mesh(
            (points, faces), "bumpy", translate=[0.6, -0.4, -2.4], scale=0.5, normals=points, **ball
        ),
        mesh((points, faces), "even", translate=[0, 0.5, -3], scale=0.4, colors=np.abs(points)),
        quad([-1.5, -0.9, -3.2], [1, 0, 0], [0, 1.5, 0], "torn"),
        sphere([0, -0.7, -1.8], 0.25, "label"),
        quad([0.6, -0.9, -3.2], [1, 0, 0], [0, 1.5, 0], "glowing"),
        mesh((SHADE, np.array([[0, 1, 2], [0, 2, 3]])), "lamp", translate=[0, 0.6, -1.5]),
    ]
    return with_images(
        scene_of(
            [FLOOR | {"material": "even"}, *things],
            MAPPED,
            {"fov": 60},
            sun=SUN,
            background={"color": [0.2] * 3},
        ),
        IMAGES,
    )


def crowd() -> Scene:
    """Trees over spheres, over other shapes and in meshes that are repeated, and many lamps."""
    grid = [(x, z) for x in range(-3, 4) for z in range(-7, -1)]
    things = [sphere([0.5 * x, -0.8 + 0.03 * (x * z % 5), 0.6 * z], 0.15, "matte") for x, z in grid]
    things += [
        box([0.5 * x + 0.1, -1, 0.6 * z + 0.2], [0.5 * x + 0.3, -0.7, 0.6 * z + 0.4], "brass")
        for x, z in grid
    ]
    things += [
        disk([0.45 * x, 0.9 + 0.02 * z, 0.6 * z], [0, -1, 0.1], 0.05, "lamp") for x, z in grid
    ]
    heap, flat = icosphere(2), {"smooth": False, "backfaces": "hidden"}
    things += [
        mesh(heap, "matte", translate=[0.9 * k - 1.35, 0.1, -3], scale=0.3, **flat)
        for k in range(4)
    ]
    return scene_of([FLOOR, *things], STILL_LIFE, {"fov": 70})


def caustics() -> Scene:
    """Particles aimed at glass, linked through spheres, of lamps with cones and of a small sun."""
    indoors = room(
        {**quad([-0.25, 0.9, -0.4], [0.5, 0, 0], [0, 0, 0.4], "lamp"), "emission_side": "front"},
        disk([0.5, 0.95, -0.5], [0, -1, 0], 0.1, "spot"),
        sphere([-0.1, -0.75, 0.15], 0.2, "glass"),
        mesh(icosphere(1), "glass", translate=[-0.5, -0.6, -0.6], scale=0.3, smooth=False),
        *DRINK,
    )
    sky = under(spot(10, 1) + np.float32(0.001)).background
    return indoors.model_copy(update={"background": sky})


def shared_places() -> Scene:
    """A lamp in the plane of a wall, in a closed room whose live probes take turns."""
    whole = room(
        quad([-0.4, 1, -0.4], [0.8, 0, 0], [0, 0, 0.8], "lamp"),
        sphere([0.3, -0.5, 0], 0.4, "mirror"),
    )
    return whole.model_copy(update={"probes": Probes(per_update=0.5)})


def pictured() -> Scene:
    """The scene under an image of the sky."""
    return under(
        random_sky(16, 8),
        FLOOR | {"material": "m"},
        sphere([-0.5, -0.5, -2], 0.5, "mirror"),
        sphere([0.6, -0.5, -2], 0.5, "glass"),
    )


OVERLAPPING = [  # glass, and a hole, that take the place of the glass with milk
    {**box([-0.2, -0.9, -4.6], [0.5, 0.2, -3.6], "glass"), "priority": 1},
    {**sphere([0.9, 0.1, -3.9], 0.4, "none"), "priority": 2},
]


def hazy(*more: dict[str, Any]) -> Scene:
    """Three media, one of them in glass, in another, under a lamp, a sun and a sky."""
    white, grey = {"type": "dielectric", "ior": 1.4}, {"type": "lambertian", "color": [0.5] * 3}
    fog = {"scattering": [0.4, 0.5, 0.7], "absorption": [0.1, 0.0, 0.2], "anisotropy": 0.4}
    milk: dict[str, Any] = {
        "scattering": [3, 2, 1],
        "emission": [0.1, 0.2, 0.1],
        "anisotropy": -0.3,
    }
    milk["density"] = Density(np.linspace(0.5, 1, 12, dtype=np.float32).reshape(2, 3, 2))
    shown = {"values": [0.2, 0.6, 1], "colors": [[1, 0, 0], [0, 0, 1], [1, 1, 1]]}
    shown |= {"opacities": [0, 0.5, 0.1], "length": 0.3}
    scan = {"density": milk["density"], "transfer": shown}
    return scene_of(
        [
            plane([0, -1, 0], [0, 1, 0], "grey"),
            {**box([-1.5, -0.5, -5], [-0.7, 0.5, -4], "none"), "medium": "scan"},
            {**box([-2, -1.5, -6], [2, 1.5, -2], "none"), "medium": "fog"},
            {**sphere([0.4, 0, -4], 0.6, "glass"), "medium": "milk"},
            quad([-0.5, 1, -4], [1, 0, 0], [0, 0, 1], "lamp"),
            *more,
        ],
        {"glass": white, "grey": grey, "lamp": lamp(5.0)},
        {"fov": 50},
        media={"fog": fog, "scan": scan, "milk": milk},
        sun=SUN,
        background={"bottom": [0.1, 0.1, 0.1], "top": [0.2, 0.3, 0.5]},
    )


TRACED = ("shadows", "reflections", "refractions", "ambient_occlusion")  # not light by probes
RENDERS: dict[str, tuple[Scene, dict[str, Any]]] = {
    "still life": (still_life(), {"method": "mis"}),
    "still life by a model": (still_life(), {"method": "whitted"}),
    "by constants": (still_life(), {"method": "blinn", "phong": CONSTANTS}),
    "mapped": (mapped(), {"method": "nee", "sampler": "independent"}),
    "crowd": (crowd(), {"method": "mis", "sampler": "independent"}),
    "caustics": (caustics(), {"caustics": "on", "linked": 0.5, "aimed": 0.5}),
    "shared places": (shared_places(), {"method": "resampled", "reuse": "both", "probes": 2}),
    "pictured": (pictured(), {"method": "mis", "roulette": False}),
    "hazy": (hazy(), {"method": "mis"}),
    "hazy by ranks": (hazy(*OVERLAPPING), {"method": "mis"}),
    "hazy by steps": (hazy(), {"method": "march", "march_step": 0.1}),
    "drawn": (mapped(), {"method": "hybrid", "effects": TRACED}),
    "by own counts": (still_life(), {"method": "mis", "adaptive": "on"}),
    "by long blocks": (still_life(), {"method": "mis", "sampler": "sobol1024"}),
    "by shared numbers": (still_life(), {"method": "mis", "sampler": "shared"}),
}
