"""Scenes for experiments on noise: little noise, rare bright samples, hardly any hits."""

from dataclasses import dataclass, replace
from typing import Any

from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene


@dataclass(frozen=True)
class Case:
    """A scene with the settings of its renders."""

    scene: Scene
    method: str
    bounces: int = 6
    sampler: str = "independent"


def room(ball: str, lamp: dict[str, Any], emission: float) -> Scene:
    """A floor, a wall, a matte sphere, a sphere of the material `ball`, and a spherical lamp.

    `lamp` holds its centre and radius; `emission` is that of its red channel.
    """
    return parse_scene(
        {
            "camera": {"position": [0.0, 1.2, 4.0], "look_at": [0.0, 0.6, 0.0], "fov": 40.0},
            "materials": {
                "white": {"type": "lambertian", "color": [0.8, 0.75, 0.7]},
                "red": {"type": "lambertian", "color": [0.6, 0.1, 0.1]},
                "glass": {"type": "dielectric", "ior": 1.5},
                "lamp": {"type": "light", "emission": [emission, 0.9 * emission, 0.7 * emission]},
            },
            "objects": [
                {"shape": "plane", "point": [0, 0, 0], "normal": [0, 1, 0], "material": "white"},
                {"shape": "plane", "point": [0, 0, -1.5], "normal": [0, 0, 1], "material": "red"},
                {"shape": "sphere", "center": [-0.6, 0.5, 0], "radius": 0.5, "material": "white"},
                {"shape": "sphere", "center": [0.5, 0.55, 0.4], "radius": 0.5, "material": ball},
                {"shape": "sphere", "material": "lamp", **lamp},
            ],
        },
        "noisy_scenes",
    )


def diffuse(shift: float = 0.0) -> Scene:
    """Only matte surfaces, with the lamp partly in view.

    Here and below, `shift` moves the lamp to the right, in scene units.
    """
    return room("red", {"center": [0.5 + shift, 2.2, 1.0], "radius": 0.4}, 8.0)


def caustic(shift: float = 0.0) -> Scene:
    """A glass sphere under a small lamp: few paths carry the light that it focuses on the floor."""
    return room("glass", {"center": [0.9 + shift, 2.4, 0.6], "radius": 0.1}, 130.0)


def small_lamp(shift: float = 0.0) -> Scene:
    """A lamp so small that about one path in 2,500 hits it by scattering alone."""
    return room("red", {"center": [0.5 + shift, 2.0, 0.6], "radius": 0.05}, 500.0)


CASES = {
    "diffuse": Case(diffuse(), "mis"),
    "caustic": Case(caustic(), "mis"),
    "small lamp": Case(small_lamp(), "naive"),
}
OTHERS = {
    "diffuse": replace(CASES["diffuse"], method="naive"),
    "caustic": replace(CASES["caustic"], method="nee"),
    "small lamp": replace(CASES["small lamp"], method="mis"),
}
SOBOL = {name: replace(CASES[name], sampler="sobol") for name in ("diffuse", "caustic")}
FOUND = {**CASES, "small lamp, mis": OTHERS["small lamp"]}
_MOVED = {"diffuse": diffuse, "caustic": caustic, "small lamp": small_lamp}
PLANTED = {
    "shadow moved": {
        name: replace(case, scene=_MOVED[name.removesuffix(", mis")](0.05))
        for name, case in FOUND.items()
    },
    "5 bounces instead of 6": {name: replace(case, bounces=5) for name, case in FOUND.items()},
}
