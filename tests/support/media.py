"""Scenes with media, in a few words."""

from typing import Any

import numpy as np

from glrt.scene.scene import Scene
from tests.support.builders import lamp, scene_of, sphere

MU = np.array([0.5, 1.0, 2.0])
EVEN = {"bottom": [1.0] * 3, "top": [1.0] * 3}
FAR: dict[str, Any] = {"position": [0, 0, 5], "look_at": [0, 0, 0], "fov": 0.01}
MATERIALS = {
    "white": {"type": "lambertian", "color": [0.7, 0.7, 0.7]},
    "black": {"type": "lambertian", "color": [0.0, 0.0, 0.0]},
    "lamp": lamp(9.0),
}


def medium(scattering: Any = 0, absorption: Any = 0, emission: Any = 0, g: float = 0) -> Any:
    """A medium; a number stands for all channels."""
    given = {"scattering": scattering, "absorption": absorption, "emission": emission}
    three = {key: np.broadcast_to(value, 3).astype(float).tolist() for key, value in given.items()}
    return {**three, "anisotropy": g}


def filled(thing: dict[str, Any], name: str | None = "fog", material: str = "none") -> Any:
    return {**thing, "material": material, **({"medium": name} if name else {})}


def ball(radius: float = 1.0) -> Any:
    return filled(sphere([0, 0, 0], radius, ""))


def with_fog(things: list[Any], fog: Any, camera: Any = FAR, **more: Any) -> Scene:
    materials = {**MATERIALS, **more.pop("materials", {})}
    return scene_of(things, materials, camera, media={"fog": fog}, **more)


HAZE = medium(scattering=[1, 2, 0.5], absorption=[0.1, 0.1, 0.3])
DUSK = {"bottom": [0.2, 0.3, 0.4], "top": [0.2, 0.3, 0.4]}
