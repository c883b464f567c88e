"""Random scenes by seed whose estimated error is likely to be wrong: light that few samples find.

Five kinds: rims of small suns, small suns over mirrors, glass under small lamps, lamps near
surfaces, rough metals by `nee`. Random numbers are from PCG64; lengths are in scene units.
"""

from collections.abc import Callable
from typing import Any

from bench.dice import Dice
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene
from glrt.settings import Method

Table = dict[str, Any]

CAMERA = {"position": [0.0, 1.2, 4.0], "look_at": [0.0, 0.7, 0.0], "fov": 45.0}
FLOOR = {"shape": "plane", "point": [0, 0, 0], "normal": [0, 1, 0], "material": "floor"}
SUN_POWER = 20.0  # emission of a sun times the square of its radius


def metal_balls(roughest: float) -> Scene:
    """Four metal balls, of roughness 0.1 to `roughest`, on a matte floor under two quad lamps."""
    balls = {f"metal {k}": 0.1 + k / 3 * (roughest - 0.1) for k in range(4)}
    metals = {
        name: {"type": "metal", "color": [0.9, 0.85, 0.8], "roughness": roughness}
        for name, roughness in balls.items()
    }
    lamp = {"shape": "quad", "edge_u": [0.5, 0, 0], "edge_v": [0, 0, 0.5], "material": "lamp"}
    return parse_scene(
        {
            "camera": {"position": [0.0, 1.6, 4.5], "look_at": [0.0, 0.4, 0.0], "fov": 40.0},
            "materials": {
                "floor": {"type": "lambertian", "color": [0.7, 0.7, 0.7]},
                "lamp": {"type": "light", "emission": [12.0, 12.0, 12.0]},
                **metals,
            },
            "objects": [
                {"shape": "plane", "point": [0, 0, 0], "normal": [0, 1, 0], "material": "floor"},
                *(
                    {"shape": "sphere", "center": [k - 1.5, 0.45, 0], "radius": 0.45, "material": m}
                    for k, m in enumerate(balls)
                ),
                *({**lamp, "corner": [left, 2.5, -0.3]} for left in (-1.2, 0.8)),
            ],
        },
        "metal balls",
    )


def _scene(kind: str, dice: Dice, materials: Table, objects: list[Table]) -> Scene:
    """With a floor, sometimes a wall, and a sky that is sometimes black."""
    grey = dice.within(0.3, 0.8)
    walls = {"shape": "plane", "point": [0, 0, -2.0], "normal": [0, 0, 1], "material": "floor"}
    sky = dice.within(0.2, 1.0) if dice.chance(0.7) else 0.0
    tables: Table = {
        "title": f"Made to fool the estimate: {kind}",
        "camera": CAMERA,
        "render": {"width": 320, "height": 240, "samples": 64, "bounces": 6},
        "background": {"bottom": [0.6 * sky] * 3, "top": [0.7 * sky, 0.8 * sky, sky]},
        "materials": {"floor": {"type": "lambertian", "color": [grey] * 3}, **materials},
        "objects": [FLOOR, *([walls] if dice.chance(0.4) else []), *objects],
    }
    return parse_scene(tables, kind)


def _lamp(emission: float) -> Table:
    return {"type": "light", "emission": [emission, 0.9 * emission, 0.75 * emission]}


def _ball(dice: Dice, x: float, material: str) -> Table:
    radius = dice.within(0.25, 0.55)
    center = [x, radius, dice.within(-0.6, 0.6)]
    return {"shape": "sphere", "center": center, "radius": radius, "material": material}


def _sun(dice: Dice, radius: float, height: float) -> Table:
    center = [dice.within(-0.9, 0.9), height, dice.within(-1.0, 0.0)]
    return {"shape": "sphere", "center": center, "radius": radius, "material": "sun"}


def rims(dice: Dice) -> Scene:
    """A small, very bright ball in view, whose rim some pixels hardly see."""
    radius = dice.decades(0.01, 0.2)
    sun = _sun(dice, radius, dice.within(1.0, 1.9))
    materials = {"sun": _lamp(SUN_POWER * dice.decades(0.2, 2.0) / radius**2)}
    materials["matte"] = {"type": "lambertian", "color": [0.6, 0.4, 0.3]}
    return _scene("rims", dice, materials, [sun, _ball(dice, dice.within(-0.8, 0.8), "matte")])


def small_suns(dice: Dice) -> Scene:
    """A small, very bright ball out of view over metal balls, some of them mirrors."""
    radius = dice.decades(0.01, 0.1)
    materials: Table = {"sun": _lamp(SUN_POWER * dice.decades(0.2, 2.0) / radius**2)}
    balls = []
    for number, x in enumerate((-1.0, 0.0, 1.0)):
        roughness = dice.one_of([0.0, dice.within(0.05, 0.3), dice.within(0.3, 0.8)])
        metal = {"type": "metal", "color": [0.9, 0.85, 0.8], "roughness": roughness}
        materials[f"metal {number}"] = metal
        balls.append(_ball(dice, x, f"metal {number}"))
    return _scene("small suns", dice, materials, [_sun(dice, radius, 3.5), *balls])


def glass(dice: Dice) -> Scene:
    """Glass balls under a small lamp."""
    radius = dice.decades(0.02, 0.3)
    materials: Table = {"sun": _lamp(SUN_POWER * dice.decades(0.2, 1.0) / radius**2)}
    materials["glass"] = {"type": "dielectric", "ior": dice.within(1.2, 2.0)}
    balls = [_ball(dice, x, "glass") for x in (-0.7, 0.7)[: dice.count(1, 2)]]
    return _scene("glass", dice, materials, [_sun(dice, radius, 3.0), *balls])


def near_lamps(dice: Dice) -> Scene:
    """Lamps that nearly touch the floor, next to a ball."""
    objects, materials = [_ball(dice, 0.0, "matte")], {}
    materials["matte"] = {"type": "lambertian", "color": [0.6, 0.4, 0.3]}
    for number, x in enumerate((-1.0, 1.0)):
        size, name = dice.decades(0.05, 0.4), f"lamp {number}"
        gap = size * dice.decades(1e-3, 0.3)
        materials[name] = _lamp(dice.decades(1.0, 10.0) / size**2)
        if dice.chance(0.5):
            shape: Table = {"shape": "sphere", "center": [x, size + gap, 0.3], "radius": size}
        else:
            shape = {"shape": "quad", "corner": [x - size, gap, 0.3 - size]}
            shape |= {"edge_u": [2 * size, 0, 0], "edge_v": [0, 0, 2 * size]}
        objects.append({**shape, "material": name})
    return _scene("near lamps", dice, materials, objects)


def rough_metals(dice: Dice) -> Scene:
    """Metal balls under two quad lamps, which `nee` finds in reflections by luck."""
    materials: Table = {"lamp": _lamp(dice.within(6.0, 20.0))}
    objects = []
    for number, x in enumerate((-1.2, 0.0, 1.2)):
        roughness = dice.decades(0.08, 0.6)
        metal = {"type": "metal", "color": [0.9, 0.85, 0.8], "roughness": roughness}
        materials[f"metal {number}"] = metal
        objects.append(_ball(dice, x, f"metal {number}"))
    edge = dice.within(0.2, 0.8)
    sides = {"edge_u": [edge, 0, 0], "edge_v": [0, 0, edge], "material": "lamp"}
    height = dice.within(2.2, 3.0)
    objects += [{"shape": "quad", "corner": [x, height, -0.3], **sides} for x in (-1.2, 0.8)]
    return _scene("rough metals", dice, materials, objects)


KINDS: dict[str, tuple[Callable[[Dice], Scene], Method]] = {
    "rims of small suns": (rims, "mis"),
    "small suns": (small_suns, "mis"),
    "glass": (glass, "mis"),
    "near lamps": (near_lamps, "mis"),
    "rough metals": (rough_metals, "nee"),
}


def fooling_scene(kind: str, seed: int) -> tuple[Scene, Method]:
    """The scene of a kind and a seed, and the method that it is made for."""
    make, method = KINDS[kind]
    return make(Dice(seed)), method
