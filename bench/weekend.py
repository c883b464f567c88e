"""Writes scenes/weekend.toml: the picture on the cover of "Ray Tracing in One Weekend".

Three large spheres, of glass, matte brown and metal, are in a row among some 480 small ones on grey
ground under a pale sky. The picture is described in Peter Shirley, Trevor David Black, Steve
Hollasch, "Ray Tracing in One Weekend", https://raytracing.github.io; the positions and colours are
chosen here. Equal seeds give equal files.

    python -m bench.weekend
"""

import math
import random
from collections.abc import Iterator

from glrt.core.resources import folder

SEED = 35
GRID = range(-11, 11)  # cells of edge 1 in x and z, with at most one small sphere each
SMALL, LARGE = 0.2, 1.0  # radii
GAP = 0.02  # least distance between two spheres

MATTE = {
    "coral": (0.82, 0.27, 0.21),
    "brick": (0.48, 0.12, 0.09),
    "amber": (0.88, 0.52, 0.10),
    "straw": (0.83, 0.72, 0.38),
    "olive": (0.32, 0.36, 0.10),
    "leaf": (0.18, 0.45, 0.16),
    "mint": (0.47, 0.75, 0.60),
    "teal": (0.06, 0.36, 0.38),
    "azure": (0.14, 0.42, 0.75),
    "navy": (0.06, 0.11, 0.34),
    "violet": (0.33, 0.19, 0.52),
    "plum": (0.36, 0.08, 0.25),
    "rose": (0.83, 0.45, 0.50),
    "cream": (0.86, 0.81, 0.72),
    "slate": (0.19, 0.22, 0.26),
}
METALS = {  # reflectance and roughness
    "silver": ((0.88, 0.88, 0.87), 0.0),
    "copper": ((0.86, 0.55, 0.42), 0.3),
    "brass": ((0.82, 0.68, 0.38), 0.2),
    "pewter": ((0.60, 0.62, 0.66), 0.5),
    "rosy": ((0.84, 0.66, 0.68), 0.4),
    "blued": ((0.56, 0.66, 0.82), 0.25),
}
LARGE_BALLS = {  # name: material, x; at y = 1 and z = 0
    "glass ball": ("glass", 0.0),
    "matte ball": ("brown", -4.0),
    "metal ball": ("steel", 4.0),
}

HEAD = """\
# Written by bench/weekend.py, which says what it shows; change that, not this.
title = "The cover of Ray Tracing in One Weekend: some 480 balls on the ground"

camera = {{ position = [13.0, 2.0, 3.0], look_at = [0.0, 0.0, 0.0], fov = 20.0, \
focus_distance = 10.0, defocus_angle = 0.6 }}
# No lamp: there is nothing to aim at, so the method is naive.
render = {{ width = 600, height = 400, samples = {samples}, bounces = 10, method = "naive" }}
background = {{ bottom = [1.25, 1.25, 1.25], top = [0.6, 0.85, 1.25] }}
"""
SAMPLES = 64

Point = tuple[float, float]  # x, z on the ground


def small_balls(rng: random.Random) -> Iterator[tuple[Point, str]]:
    """Position and material of each small sphere; cells without enough space stay empty."""
    placed: list[Point] = []
    for a in GRID:
        for b in GRID:
            point = _free_point(rng, a, b, placed)
            if point:
                placed.append(point)
                yield point, _material(rng)


def _free_point(rng: random.Random, a: int, b: int, placed: list[Point]) -> Point | None:
    """A point in cell (a, b), rounded as in the file, away from all spheres; None if none fits."""
    for _ in range(20):
        point = (round(a + rng.random(), 3), round(b + rng.random(), 3))
        if _is_free(point, placed):
            return point
    return None


def _is_free(point: Point, placed: list[Point]) -> bool:
    # Two spheres on the ground touch if their points of contact with it are 2 sqrt(r1 r2) apart.
    of_large = 2 * math.sqrt(SMALL * LARGE) + GAP
    large = all(math.dist(point, (x, 0.0)) > of_large for _, x in LARGE_BALLS.values())
    return large and all(math.dist(point, other) > 2 * SMALL + GAP for other in placed)


def _material(rng: random.Random) -> str:
    kind = rng.random()
    if kind < 0.78:
        return rng.choice(list(MATTE))
    return rng.choice(list(METALS)) if kind < 0.94 else "glass"


def _vector(numbers: tuple[float, ...]) -> str:
    return "[" + ", ".join(map(repr, numbers)) + "]"


def _materials() -> Iterator[str]:
    yield 'materials.ground = { type = "lambertian", color = [0.5, 0.5, 0.5] }'
    yield 'materials.brown = { type = "lambertian", color = [0.4, 0.2, 0.1] }'
    yield 'materials.steel = { type = "metal", color = [0.7, 0.6, 0.5] }'
    yield 'materials.glass = { type = "dielectric", ior = 1.5 }'
    for name, color in MATTE.items():
        yield f'materials.{name} = {{ type = "lambertian", color = {_vector(color)} }}'
    for name, (color, roughness) in METALS.items():
        finish = f"color = {_vector(color)}, roughness = {roughness}"
        yield f'materials.{name} = {{ type = "metal", {finish} }}'


def _ball(x: float, z: float, radius: float, material: str, name: str = "") -> str:
    label = f'name = "{name}", ' if name else ""
    place = f"center = {_vector((x, radius, z))}, radius = {radius}"
    return f'  {{ {label}shape = "sphere", {place}, material = "{material}" }},'


def _objects(rng: random.Random) -> Iterator[str]:
    ground = "point = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0]"
    yield f'  {{ name = "ground", shape = "plane", {ground}, material = "ground" }},'
    for name, (material, x) in LARGE_BALLS.items():
        yield _ball(x, 0.0, LARGE, material, name)
    for (x, z), material in small_balls(rng):
        yield _ball(x, z, SMALL, material)


def scene_text(seed: int = SEED) -> str:
    """The scene file as text; the same seed gives the same text."""
    head = HEAD.format(samples=SAMPLES)
    objects = ["objects = [", *_objects(random.Random(seed)), "]"]
    return "\n".join([head, *_materials(), "", *objects, ""])


if __name__ == "__main__":
    file = folder("scenes") / "weekend.toml"
    file.write_text(scene_text(), encoding="utf-8", newline="\n")
