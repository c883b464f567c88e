"""Scenes of some cases whose mean radiance is known in closed form, for any renderer."""

import math
from typing import Any, NamedTuple

from glrt.lab.glass import bulb_light, bulb_room
from glrt.lab.scenes import Table
from glrt.lab.sums import glowing_room, sum_of_bounces
from glrt.lab.textures import ALPHA, thin_layers
from glrt.lab.volumes.media import equilibrium, sight_into_fog
from glrt.scene.scene import Scene

_ALBEDO, _BOUNCES = 0.9, 1000  # of the room
_RADIUS, _DEPTH, _LAYERS, _ANGLE = 0.16, 2.0, 10, 0.1
_HALF_SPACE: Table = {"shape": "box", "min": [-9, -9, -9], "max": [9, 0, 9], "material": "none"}


class Truth(NamedTuple):
    """A scene and the mean radiance of its picture."""

    name: str  # of a case, with what distinguishes it
    scene: Scene
    settings: dict[str, Any]  # of the picture for which it holds
    radiance: float  # in each channel, mean over all pixels
    formula: str  # for readers


def truths() -> list[Truth]:
    """Return all of them."""
    small = {"width": 32, "height": 32}
    one = {"width": 1, "height": 1, "bounces": 0}
    radius = f"lamp radius r = {_RADIUS:g}, albedo a = 0.5, room radius 1"
    return [
        Truth(
            "albedo",
            glowing_room(_ALBEDO),
            {**small, "bounces": _BOUNCES},
            sum_of_bounces(_ALBEDO, _BOUNCES),
            f"1 + a + ... + a^{_BOUNCES}, albedo a = {_ALBEDO:g}, rounded to float32",
        ),
        Truth(
            "bulb",
            bulb_room(_RADIUS, True),
            {**small, "bounces": 2},
            bulb_light(_RADIUS, True),
            f"2 a / n^2 times the integral of b T(b) from 0 to n r; index n = 1.5, Fresnel's "
            f"transmittance T at impact parameter b; {radius}",
        ),
        Truth(
            "bulb-bare",
            bulb_room(_RADIUS, False),
            {**small, "bounces": 2},
            bulb_light(_RADIUS, False),
            f"a r^2 (1 + a (1 - r^2)); {radius}",
        ),
        Truth(
            "depth",
            equilibrium(_DEPTH),
            {**small, "bounces": 60},
            1.0,
            "1: gas, lamp and sky emit what they absorb; 0.5^60 is left beyond 60 bounces",
        ),
        Truth(
            "skim",
            sight_into_fog(_HALF_SPACE, _ANGLE),
            one,
            math.exp(-1.5),
            "exp(-1.5): fog of extinction 1, 1.5 deep",
        ),
        Truth(
            "layers",
            thin_layers(_LAYERS),
            {**small, "bounces": 0},
            (1 - ALPHA) ** _LAYERS,
            f"(1 - {ALPHA:g})^{_LAYERS}: layers in front of a wall that emits 1",
        ),
    ]
