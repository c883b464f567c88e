"""Scenes on which light sampling and scattering have a hard time to agree."""

from typing import Any, NamedTuple

from glrt.scene.scene import Scene
from tests.support.builders import (
    box,
    cylinder,
    disk,
    glass,
    lamp,
    plane,
    quad,
    room_of_planes,
    scene_of,
    sphere,
)

Table = dict[str, Any]

FLOOR = plane([0, -1, 0], [0, 1, 0], "white")
MATERIALS: dict[str, Table] = {
    "white": {"type": "lambertian", "color": [0.8, 0.7, 0.6]},
    "glass": glass(1.5),
    "mirror": {"type": "metal", "color": [0.9, 0.9, 0.9]},
    "polished": {"type": "metal", "color": [0.9, 0.8, 0.5], "roughness": 0.15},
    "rough": {"type": "metal", "color": [0.6, 0.7, 0.9], "roughness": 0.8},
    "warm": {"type": "light", "emission": [9, 6, 3]},
    "cold": {"type": "light", "emission": [1, 2, 4]},
    "dim": lamp(0.3),
    "shining": lamp(2.0, 0.6),
    "off": lamp(5.0),
}
BALL = sphere([0.1, -0.6, -3], 0.4, "white")
CEILING = quad([-0.7, 1.2, -3.5], [1.4, 0, 0], [0, 0, 1.2], "warm")
BULB = sphere([0.9, 0.0, -2.8], 0.25, "warm")
MANY = [
    sphere([0.4 * (i % 8) - 1.4, 0.35 * (i // 8) - 0.5, -4.5], 0.08, f"lamp {i}") for i in range(40)
]
POWERS = {f"lamp {i}": lamp(0.3 * 1.3 ** (i * 7 % 40 / 2)) for i in range(40)}


class Samples(NamedTuple):
    """How many samples each method takes, in the order of METHODS."""

    naive: int = 512
    nee: int = 128
    mis: int = 128

    def times(self, factor: int) -> "Samples":
        return Samples(*(factor * count for count in self))


HARD: dict[str, tuple[list[Table], Samples]] = {
    "lamps of three shapes": (
        [FLOOR, BALL, CEILING, BULB, plane([0, 4, 0], [0.3, -1, 0], "dim")],
        Samples(),
    ),
    "a lamp that rests on the floor": (
        [FLOOR, BALL, sphere([0.8, -0.7, -3], 0.3, "warm")],
        Samples(),
    ),
    "a lamp around everything": ([BALL, BULB, FLOOR, sphere([0, 0, 0], 9, "cold")], Samples()),
    "lamps that reflect": (
        [
            FLOOR,
            BALL,
            sphere([0.8, 0, -3], 0.4, "shining"),
            quad([-2, -1, -4], [2, 0, 0], [0, 2, 0], "shining"),
        ],
        Samples(),
    ),
    "glass before a lamp": ([FLOOR, CEILING, sphere([0, 0, -2.9], 0.5, "glass")], Samples()),
    "a lamp in glass": (
        [FLOOR, sphere([0, 0, -3], 0.6, "glass"), sphere([0.1, 0, -3], 0.3, "cold")],
        Samples(),
    ),
    "polished metal": (
        [FLOOR, CEILING, BULB, sphere([0, -0.4, -3], 0.6, "polished")],
        Samples(nee=4096),
    ),
    "rough metal": ([FLOOR, CEILING, BULB, sphere([0, -0.4, -3], 0.6, "rough")], Samples()),
    "a mirror": ([FLOOR, CEILING, BULB, sphere([0, -0.4, -3], 0.6, "mirror")], Samples()),
    "a floor of metal": ([plane([0, -1, 0], [0, 1, 0], "rough"), BALL, CEILING], Samples()),
    "a lamp without end and one with": (
        [FLOOR, BALL, CEILING, plane([0, 0, -9], [0, 0, 1], "cold")],
        Samples(),
    ),
    "a lamp half below the floor": (
        [FLOOR, BALL, sphere([0.9, -1.1, -2.6], 0.4, "warm")],
        Samples(),
    ),
    "a lamp on its edge": (
        [FLOOR, BALL, quad([-0.8, -1, -4], [1.5, 0, 0], [0, 1.5, 0.2], "cold")],
        Samples(),
    ),
    "a round lamp over a ball": (
        [FLOOR, BALL, disk([-0.2, 1.2, -3], [0.2, 1, 0.1], 0.6, "warm")],
        Samples(),
    ),
    "round lamps among others": (
        [FLOOR, BULB, CEILING, BALL, disk([-1, -0.4, -3.5], [1, 0.5, 0], 0.4, "shining")],
        Samples(),
    ),
    "boxes of matte, glass and light": (
        [
            FLOOR,
            CEILING,
            box([-1, -1, -3.6], [-0.3, -0.2, -2.9], "white", [0, 25, 0]),
            box([0.1, -0.9, -3], [0.6, 0.1, -2.6], "glass", [10, 40, 5]),
            box([0.9, -0.8, -4], [1.2, -0.5, -3.7], "cold"),
        ],
        Samples(),
    ),
    "cylinders of matte, glass and light": (
        [
            FLOOR,
            CEILING,
            cylinder([-0.8, -1, -3.4], [-0.6, 0.2, -3], 0.3, "white", capped=False),
            cylinder([0.3, -0.9, -2.8], [0.3, -0.2, -2.8], 0.3, "glass"),
            cylinder([0.9, -0.8, -4], [1.2, -0.5, -3.7], 0.2, "cold"),
        ],
        Samples(),
    ),
    "forty lamps of many powers": ([FLOOR, BALL, *MANY], Samples(2048, 512, 512)),
    "lamps along a corridor": (
        [
            *(plane([0, y, 0], [0, -y, 0], "white") for y in (-1, 1)),
            *(plane([x, 0, 0], [-x, 0, 0], "white") for x in (-1, 1)),
            *(sphere([0, 0.7, -2 - 2 * i], 0.2, "warm") for i in range(6)),
        ],
        Samples(naive=1024),
    ),
    "a lamp that is off": ([FLOOR, BALL, CEILING, sphere([-0.8, 0, -3], 0.3, "off")], Samples()),
    "a closed room": ([*room_of_planes("white", 4.0), BALL, CEILING, BULB], Samples(naive=1024)),
}


def hard_scene(name: str) -> Scene:
    """A scene of HARD, with five bounces."""
    materials = MATERIALS | POWERS
    return scene_of(HARD[name][0], materials, lights={"off": 0.0}, render={"bounces": 5})
