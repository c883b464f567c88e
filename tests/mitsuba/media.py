"""Scenes with fog, smoke and milk, which Mitsuba renders by `volpathmis`."""

from collections.abc import Callable
from typing import Any

import numpy as np

from glrt.scene.density import Density
from glrt.scene.scene import Scene
from tests.support.builders import box, cylinder, glass, lamp, plane, quad, scene_of, sphere
from tests.support.media import filled, medium

MATERIALS = {
    "white": {"type": "lambertian", "color": [0.7, 0.6, 0.5]},
    "lamp": lamp(9.0),
    "glass": glass(1.5),
    "milky": glass(1.33 / 1.5),  # inside over outside
}
SKY = {"bottom": [0.5, 0.3, 0.1], "top": [0.1, 0.3, 0.6]}
EYE = {"position": [0.3, 1.3, 4.0], "look_at": [0.0, 0.9, 0.0], "fov": 45}
ABOVE = quad([-0.8, 3, -0.8], [1.6, 0, 0], [0, 0, 1.6], "lamp")
FLOOR = plane([0, 0, 0], [0, 1, 0], "white")


def room(fog: Any) -> Scene:
    """A room in fog: the camera and a lamp stand in it, walls and a ball, too."""
    things = [
        filled(box([-6, -0.5, -6], [6, 5, 6], "")),
        FLOOR,
        ABOVE,
        sphere([0, 0.6, 0], 0.6, "white"),
    ]
    return scene_of(things, MATERIALS, EYE, media={"fog": fog}, background=SKY)


def coloured(fog: Any) -> Scene:
    """A ball of coloured fog on a floor, with a ball of white in it and vacuum in that fog."""
    things = [
        filled(sphere([0, 1, 0], 0.95, "")),
        filled(sphere([-0.4, 1.2, 0.2], 0.3, ""), None),
        sphere([0.4, 0.9, 0], 0.3, "white"),
        FLOOR,
        ABOVE,
    ]
    return scene_of(things, MATERIALS, EYE, media={"fog": fog}, background=SKY)


def glass_of_milk(milk: Any) -> Scene:
    """A glass with milk in it, under a sky alone: lamps are not found through glass."""
    things = [
        cylinder([0, 0.01, 0], [0, 1.6, 0], 0.7, "glass"),
        filled(cylinder([0, 0.1, 0], [0, 1.5, 0], 0.6, ""), "fog", "milky"),
        FLOOR,
    ]
    return scene_of(things, MATERIALS, EYE, media={"fog": milk}, background=SKY)


def smoky(fog: Any) -> Scene:
    """A turned box of smoke on a floor, with a white ball in it; its density varies."""
    draw = np.random.default_rng(4)
    values = draw.uniform(0, 2, (9, 14, 11)).astype(np.float32) ** 3
    smoke = {**fog, "density": Density(values)}
    things = [
        {**filled(box([-0.9, 0.3, -0.7], [0.8, 1.9, 0.9], "")), "rotate": [10, 30, 20]},
        sphere([0.2, 1.0, 0.1], 0.3, "white"),
        FLOOR,
        ABOVE,
    ]
    return scene_of(things, MATERIALS, EYE, media={"fog": smoke}, background=SKY)


SCENES: dict[str, tuple[Callable[[Any], Scene], Any, int]] = {  # and the limit of bounces
    "a room in fog": (room, medium([0.2, 0.3, 0.4], 0.05, g=0.5), 4),
    "a ball of coloured fog": (coloured, medium([4, 2, 0.5], [0.1, 0.5, 2], g=-0.4), 8),
    "smoke of a grid": (smoky, medium([2, 1, 0.5], [0.1, 0.2, 0.8], g=0.3), 8),
    "a glass of milk": (glass_of_milk, medium([4, 3.5, 3], [0.01, 0.03, 0.1], g=0.7), 24),
}
