"""Lamps from which particles start, and functions of the path tracer that start them."""

from typing import Any

import numpy as np

from glrt.gpu.glsl import read
from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.support.builders import (
    MATTE,
    disk,
    glass,
    lamp,
    quad,
    scene_of,
    sphere,
)
from tests.support.meshes import mesh
from tests.support.numerics import Array

FILES = (
    "integrators/particle_start.glsl",
    "integrators/camera_links.glsl",
    "integrators/light_links.glsl",
)
ON: dict[str, Any] = {"caustics": "on", "linked": 0.0}
MATERIALS = {"glass": glass(), "lamp": lamp(2.0), "matte": MATTE}
FLAT = quad([-0.5, 1, -3.5], [1, 0, 0], [0, 0, 0.8], "lamp")
ROUND = sphere([0.2, 1, -3], 0.3, "lamp")
BALL = sphere([0.1, -0.5, -3.2], 0.4, "glass")
FAR_BALL = sphere([-0.6, 0.1, -2.6], 0.2, "glass")
DISK = disk([0.1, 1, -3], [0, -1, 0], 0.4, "lamp")
CORNERS = np.array([[-0.5, 1, -3.4], [0.6, 1, -3.3], [0, 1, -2.7]])
TRIANGLE = mesh((CORNERS, np.array([[0, 1, 2]])), "lamp", smooth=False)
LAMPS = {"quad": FLAT, "sphere": ROUND, "disk": DISK, "triangle": TRIANGLE}
PLACE = {
    "quad": [0.1, 1.0, -3.1],
    "sphere": [0.2, 0.7, -3.0],
    "disk": [0.2, 1.0, -2.9],
    "triangle": [0.0, 1.0, -3.1],
}
AREA = {  # of one side
    "quad": 0.8,
    "sphere": 4 * np.pi * 0.3**2,
    "disk": np.pi * 0.4**2,
    "triangle": (1.1 * 0.7 - 0.1 * 0.5) / 2,
}
SIDES = {"quad": 2, "sphere": 1, "disk": 2, "triangle": 2}


def particle_text() -> str:
    """The text that follows particles, without a film."""
    film = "void splat(vec2 place, vec3 radiance, int layer) {}\n"
    return film + "".join(map(read, FILES))


def scene(kind: str, *more: dict[str, Any]) -> Scene:
    """A lamp, a far matte ball, and more."""
    return scene_of([LAMPS[kind], sphere([0, 0, -9], 1, "matte"), *more], MATERIALS)


def starts(call_glsl: CallGlsl, files: str, place: Scene, what: str, kind: str) -> Array:
    """An expression of 200,000 particles at their start."""
    return call_glsl(
        what,
        returns=kind,
        functions=files,
        scene=place,
        options={**ON, "aimed": 0.5},
        setup="""
    Sampler rng = make_sampler(uint(i) * 9781u + 7u);
    Particle particle = start_particle(rng);""",
        n=np.zeros(200_000),
    )
