"""Random scenes by seed: rooms and open floors with shapes and lamps of many kinds and sizes.

    python -m bench.scenes SEED [-o FILE.toml]

A seed gives the same scene on every machine: random numbers are from PCG64, and numbers in scenes
have five decimal places. Lengths are in scene units; rooms are 2 to 3 units high.
"""

import argparse
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np

from bench.dice import Dice
from bench.placing import DIGITS, SMALLEST, Ball, Free, Point, Space
from bench.program import at_least, exit_code_of, parser_of
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene
from glrt.scene.scenefile.toml_writer import write_scene
from glrt.scene.schema.tables import toml_text

Table = dict[str, Any]

MOST_SHAPES, MOST_LAMPS = 60, 12
LAMP_SIZES = SMALLEST, 100 * SMALLEST  # radius or half an edge
BODY_SIZES = 0.06, 0.6
LENS_CHANCE = 1 / 3
TURNED = {"position", "look_at", "up", "center", "point", "normal", "corner", "edge_u", "edge_v"}
TURNED |= {"from", "to"}
ROUND_SHARE = 0.5  # of spheres among bodies, and among lamps
OTHERS = ("quad", "quad", "disk", "box", "box", "cylinder")  # equally likely
FLAT = ("quad", "disk")


class Builder(Free):
    """Materials and objects of a scene under construction."""

    def __init__(self, dice: Dice, space: Space, eye: Point) -> None:
        """Without materials and objects; `eye` is the position of the camera."""
        super().__init__(dice, space, eye)
        self.materials: dict[str, Table] = {}
        self.objects: list[Table] = []

    def add(self, material: str, **shape: Any) -> None:
        """Add an object."""
        self.objects.append({**shape, "material": material})


def random_scene(seed: int) -> Scene:
    """The random scene of a seed."""
    return parse_scene(random_tables(seed), f"seed {seed}")


def random_tables(seed: int) -> Table:
    """The random scene of a seed as the tables of a scene file."""
    dice = Dice(seed)
    space = Space(dice.within(1.4, 2.6), dice.within(2.0, 3.0), dice.within(1.8, 3.2))
    is_room = dice.chance(0.5)
    # The camera is just inside the front wall of a room, or outside of an open floor.
    distance = space.depth - 0.25 if is_room else space.depth + dice.within(0.5, 2.0)
    side = dice.within(-0.5, 0.5) * space.half_width
    eye = (side, dice.within(0.6, 0.75 * space.height), distance)
    builder = Builder(dice, space, eye)
    _add_palette(builder)
    _add_walls(builder, is_room)
    first = _add_subject(builder)
    _add_lamps(builder, dice.count(1, MOST_LAMPS), is_room)
    rest = MOST_SHAPES - len(builder.objects)
    for _ in range(dice.count(1, rest + 1) - 1):
        _add_body(builder)
    data = {
        "title": f"Drawn from seed {seed}",
        "camera": _camera(dice, eye, first),
        "render": {"width": 320, "height": 240, "samples": 64, "bounces": dice.count(4, 12)},
        "background": _background(dice, is_room),
        "materials": builder.materials,
        "objects": builder.objects,
    }
    turn = dice.within(0, 2 * math.pi) if dice.chance(0.5) else 0.0
    tables: Table = _rounded(_turned(data, turn))
    return tables


def _add_palette(builder: Builder) -> None:
    """Add materials for objects: one or more of each type."""
    dice, materials = builder.dice, builder.materials
    for number in range(dice.count(2, 5)):
        materials[f"matte {number + 1}"] = {"type": "lambertian", "color": _color(dice, 0.1, 0.9)}
    for number in range(dice.count(1, 3)):
        roughness = dice.one_of([0.0, dice.within(0.05, 0.3), dice.within(0.3, 1.0)])
        metal = {"type": "metal", "color": _color(dice, 0.5, 0.95), "roughness": roughness}
        materials[f"metal {number + 1}"] = metal
    for number in range(dice.count(1, 2)):
        materials[f"glass {number + 1}"] = {"type": "dielectric", "ior": dice.within(1.2, 2.4)}


def _color(dice: Dice, low: float, high: float) -> list[float]:
    return [dice.within(low, high) for _ in range(3)]


def _add_walls(builder: Builder, is_room: bool) -> None:
    """Add the six planes of a room, or a floor and sometimes a wall behind it."""
    dice, (half_width, height, depth) = builder.dice, builder.space
    for name in ("floor", "walls", "left wall", "right wall"):
        level = dice.within(0.4, 0.75)  # low saturation, as every bounce increases it
        color = _color(dice, level - 0.1, level + 0.1)
        builder.materials[name] = {"type": "lambertian", "color": color}
    if not is_room and dice.chance(0.4):
        wide, deep = half_width + 0.5, depth + 0.5
        edges = {"edge_u": [0, 0, 2 * deep], "edge_v": [2 * wide, 0, 0]}
        builder.add("floor", shape="quad", corner=[-wide, 0, -deep], **edges)
    else:
        builder.add("floor", shape="plane", point=[0, 0, 0], normal=[0, 1, 0])
    back = "metal 1" if dice.chance(0.2) else "walls"
    if is_room or dice.chance(0.3):
        builder.add(back, shape="plane", point=[0, 0, -depth], normal=[0, 0, 1])
    if is_room:
        builder.add("walls", shape="plane", point=[0, height, 0], normal=[0, -1, 0])
        builder.add("walls", shape="plane", point=[0, 0, depth], normal=[0, 0, -1])
        builder.add("left wall", shape="plane", point=[-half_width, 0, 0], normal=[1, 0, 0])
        builder.add("right wall", shape="plane", point=[half_width, 0, 0], normal=[-1, 0, 0])


def _add_subject(builder: Builder) -> Point:
    """Add a sphere in the middle, which the camera looks at; return its centre."""
    ball = builder.place(builder.dice.within(0.3, 0.5), wide=0.3)
    assert ball, "the middle is still free"
    builder.add(_any_material(builder), shape="sphere", center=ball.center, radius=ball.radius)
    return ball.center


def _any_material(builder: Builder, *excluded: str) -> str:
    names = [name for name in builder.materials if name.split()[0] in ("matte", "metal", "glass")]
    return builder.dice.one_of([name for name in names if name.split()[0] not in excluded])


def _add_body(builder: Builder) -> None:
    """Add a shape on the floor or above it, if there is space left."""
    dice = builder.dice
    height = dice.within(0.3, builder.space.height) if dice.chance(0.3) else None
    ball = builder.place(dice.decades(*BODY_SIZES), height)
    if ball:
        kind = "sphere" if dice.chance(ROUND_SHARE) else dice.one_of(OTHERS)
        shape = _shape_within(dice, ball, kind)
        has_inside = kind not in FLAT and shape.get("capped", True)
        material = _any_material(builder) if has_inside else _any_material(builder, "glass")
        builder.add(material, **shape)


def _shape_within(dice: Dice, ball: Ball, kind: str, is_level: bool = False) -> Table:
    """A shape of this kind within a sphere; a flat one horizontal or randomly oriented."""
    if kind == "sphere":
        return {"shape": kind, "center": ball.center, "radius": ball.radius}
    if kind == "quad":
        return {"shape": kind, **_panel(dice, ball, is_level)}
    if kind == "disk":
        normal = (0.0, 1.0, 0.0) if is_level else dice.direction()
        radius = ball.radius * dice.within(0.5, 0.9)
        return {"shape": kind, "center": ball.center, "normal": normal, "radius": radius}
    center = np.array(ball.center)
    if kind == "box":
        parts = np.array([dice.within(0.3, 1.0) for _ in range(3)])
        half = ball.radius * parts / np.linalg.norm(parts)
        tilt = dice.within(-40, 40) if dice.chance(0.5) else 0.0
        rotate = [tilt, dice.within(0, 90), 0.0]
        return {"shape": kind, "min": center - half, "max": center + half, "rotate": rotate}
    slimness = dice.within(0.25, 1.3)  # angle between its axis and the way to a rim
    axis = np.array(dice.direction() if dice.chance(0.5) else (0.0, 1.0, 0.0))
    end = ball.radius * math.cos(slimness) * axis
    ends = {"from": center - end, "to": center + end, "capped": dice.chance(0.75)}
    return {"shape": kind, **ends, "radius": ball.radius * math.sin(slimness)}


def _panel(dice: Dice, ball: Ball, is_level: bool = False) -> Table:
    """A rectangle or parallelogram within a sphere, horizontal or randomly oriented."""
    along, other = np.array(dice.direction()), np.array(dice.direction())
    if is_level:
        along, other = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    normal = np.cross(along, other)
    across = np.cross(normal, along) / np.linalg.norm(normal)
    slant = dice.within(-0.5, 0.5) if dice.chance(0.3) else 0.0
    u = along * ball.radius * dice.within(0.5, 0.65)
    v = (across + slant * along) * ball.radius * dice.within(0.2, 0.65) / (1 + abs(slant))
    return {"corner": np.array(ball.center) - u - v, "edge_u": 2 * u, "edge_v": 2 * v}


def _add_lamps(builder: Builder, count: int, is_room: bool) -> None:
    """Add `count` spherical and quad lamps, whose flux adds up to what lights the scene well."""
    half_width, height, depth = builder.space
    lit = 8 * (half_width * (height + 2 * depth) + height * depth) if is_room else 150.0
    irradiance = builder.dice.within(0.5, 1.0)  # direct, on average
    for number in range(count):
        flux = irradiance * lit / count * builder.dice.within(0.4, 1.6)
        _add_lamp(builder, f"lamp {number + 1}", flux)


def _add_lamp(builder: Builder, name: str, flux: float) -> None:
    """Add a lamp of this flux, if there is space left."""
    dice = builder.dice
    low, high = 0.35 * builder.space.height, builder.space.height
    ball = builder.place(dice.decades(*LAMP_SIZES), dice.within(low, high))
    if not ball:
        return
    kind = "sphere" if dice.chance(ROUND_SHARE) else dice.one_of(FLAT)
    shape = _shape_within(dice, ball, kind, dice.chance(0.4))
    tint = np.array(_color(dice, 0.6, 1.0))
    emission = tint / tint.mean() * flux / (math.pi * _bright_area(shape))
    builder.materials[name] = {"type": "light", "emission": emission}
    if dice.chance(0.3):
        builder.materials[name]["color"] = _color(dice, 0.0, 0.8)
    builder.add(name, **shape)


def _bright_area(shape: Table) -> float:
    """The area of a lamp that shines; both sides of a flat one."""
    if shape["shape"] == "quad":
        return 2 * float(np.linalg.norm(np.cross(shape["edge_u"], shape["edge_v"])))
    sides = 4 if shape["shape"] == "sphere" else 2
    return sides * math.pi * float(shape["radius"]) ** 2


def _camera(dice: Dice, eye: Point, subject: Point) -> Table:
    """A camera that looks near `subject`; a third have a lens, focused there or on `subject`."""
    target = [place + dice.within(-0.3, 0.3) for place in subject]
    camera: Table = {"position": eye, "look_at": target, "fov": dice.within(35, 70)}
    if dice.chance(0.2):
        camera["up"] = [dice.within(-0.3, 0.3), 1.0, 0.0]
    if dice.chance(LENS_CHANCE):
        camera["defocus_angle"] = dice.within(0.5, 5)
        if dice.chance(0.5):
            camera["focus_distance"] = math.dist(eye, subject)
    return camera


def _background(dice: Dice, is_room: bool) -> Table:
    """Black in closed rooms and above some floors; else a vertical gradient."""
    if is_room or dice.chance(0.35):
        return {}
    brightness = dice.decades(0.1, 1.2)
    bottom, top = (
        [brightness * part for part in _color(dice, 0.2, 1.0)] for _ in ("bottom", "top")
    )
    return {"bottom": bottom, "top": top}


def _turned(value: Any, angle: float, key: str = "") -> Any:
    """The tables with points and directions rotated about the y axis by `angle` radians."""
    if isinstance(value, dict):
        turned = {name: _turned(item, angle, name) for name, item in value.items()}
        return _turned_box(turned, angle) if value.get("shape") == "box" else turned
    if key == "objects":
        return [_turned(item, angle) for item in value]
    if key not in TURNED:
        return value
    x, y, z = value
    cos, sin = math.cos(angle), math.sin(angle)
    return [cos * x + sin * z, y, cos * z - sin * x]


def _turned_box(box: Table, angle: float) -> Table:
    """A box that is not turned about the z axis, turned about the y axis of the scene."""
    middle, half = (box["min"] + box["max"]) / 2, (box["max"] - box["min"]) / 2
    center = np.array(_turned(middle, angle, "center"))
    x, y, z = box["rotate"]
    rotate = [x, y + math.degrees(angle), z]
    return {**box, "min": center - half, "max": center + half, "rotate": rotate}


def _rounded(value: Any) -> Any:
    """The tables with plain lists, and floats rounded to DIGITS decimal places."""
    if isinstance(value, dict):
        return {name: _rounded(item) for name, item in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [_rounded(item) for item in value]
    return round(float(value), DIGITS) + 0.0 if isinstance(value, float) else value


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.scenes`; returns the exit code."""
    parser = parser_of("scenes", __doc__)
    parser.add_argument("seed", type=at_least(0), metavar="SEED", help="a whole number from 0 on")
    parser.add_argument("-o", dest="file", type=Path, metavar="FILE", help="default: print it")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _write(parsed))


def _write(parsed: argparse.Namespace) -> None:
    scene = random_scene(parsed.seed)
    if parsed.file:
        write_scene(scene, parsed.file)
    else:
        print(toml_text(scene), end="")


if __name__ == "__main__":
    sys.exit(main())
