"""Lamps: small ones, many of them, one just below a ceiling."""

import math
from itertools import pairwise, product
from typing import Any

import numpy as np

from glrt.lab.scenes import lamp as emitter
from glrt.lab.scenes import matte, plane, quad, scene_of
from glrt.lab.sweep import SIGMAS, Array, Lab, Sweep, mean_of
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.rendering.shader_functions import World
from glrt.scene.scene import Scene
from glrt.scene.shapes.quad import Quad
from glrt.settings import Method

# Points on quads uniform in area; `nee` otherwise samples quads by solid angle.
BY_AREA = Variant({"QUADS_BY_AREA": True})


def lamp(lab: Lab) -> Sweep:
    """Error of 1 - cos of the half angle of the cone in which a spherical lamp is sampled."""
    x = np.logspace(-6, 0, 25)
    rows = lab.count(1 << 10)
    random = np.random.default_rng(2)
    distance = 10 ** random.uniform(-2, 2, (len(x), rows))
    radius = (0.999 * distance * x[:, None]).astype(np.float32).ravel()
    center = np.zeros((len(radius), 3), np.float32)
    center[:, 1] = distance.ravel()
    s2 = (radius / center[:, 1].astype(np.float64)) ** 2
    truth = s2 / (1 + np.sqrt(1 - s2))
    naive = "1.0 - sqrt(1.0 - radius * radius / dot(center, center))"
    found = [
        lab.path(what, {"center": center, "radius": radius})
        for what in ("cone_of_sphere(center, radius)", naive)
    ]
    ours, textbook = (np.abs(f / truth - 1).reshape(len(x), -1).max(axis=1) for f in found)
    return Sweep(
        parameter="radius of the lamp over its distance",
        measure="relative error of the light received\n(largest)",
        x=x.tolist(),
        chosen=("glrt: s² / (1 + sqrt(1 - s²))", ours.tolist()),
        others={"textbook: 1 - sqrt(1 - s²)": textbook.tolist()},
        promise="at most 1e-5, down to a radius of 1e-6 of the distance",
        bound=[1e-5] * len(x),
    )


FROM_FLOOR = "Ray ray = Ray(vec3(0.0), vec3(0.0, 1.0, 0.0), NO_SHAPE, false);"
CHOSEN = f"""
    Sampler rng = make_sampler(pcg_hash(uint(x)));
    {FROM_FLOOR}
    LightSample light = sample_light(ray, total_weight(ray), rng);"""
EVENLY = f"""
    Sampler rng = make_sampler(pcg_hash(uint(x)));
    {FROM_FLOOR}
    float choice = next_1d(rng);
    vec2 u = next_2d(rng);
    int index = min(int(choice * float(light_count())), light_count() - 1);
    float total = total_weight(ray);
    LightSample light = sample_lamp(ray, index, u, total);
    light.pdf /= choice_pdf(index, ray, total) * float(light_count());"""
RECEIVED = "light.pdf > 0.0 ? light.radiance.x * light.ray.direction.y / light.pdf : 0.0"


def lamps(lab: Lab) -> Sweep:
    """Noise of one sample with one bright lamp among a growing number of dim ones."""
    x = [1 << power for power in range(11)]
    rows = np.arange(lab.count(1 << 15))
    noise: list[list[float]] = [[], []]
    wrong = []
    for count in x:
        scene = _many_lamps(count)
        for found, setup in zip(noise, (CHOSEN, EVENLY), strict=True):
            light = lab.path(RECEIVED, {"x": rows}, World(scene), setup=setup).astype(np.float64)
            found.append(float(light.std() / light.mean()))
            if setup == CHOSEN and abs(light.mean() / _flux(scene) - 1) > tolerance(light):
                wrong.append(count)
    return Sweep(
        parameter="lamps, one of them bright",
        measure="relative noise of one sample",
        x=x,
        chosen=("glrt: half by power, half uniform", noise[0]),
        others={"uniform": noise[1]},
        promise="at most 1.5; the mean within 5.3 standard errors",
        bound=[1.5] * len(x),
        wrong=wrong,
    )


def tolerance(light: Array) -> float:
    """SIGMAS relative standard errors of the mean of `light`."""
    return float(SIGMAS * light.std() / light.mean() / math.sqrt(len(light)))


def _many_lamps(count: int) -> Scene:
    """A bright square lamp directly above the origin, and count - 1 dim ones around it."""
    ring = np.random.default_rng(7).uniform(-1, 1, (count - 1, 2))
    corners = [(-0.05, -0.05), *ring.tolist()]
    squares = [
        quad([u, 1, v], [0.1, 0, 0], [0, 0, 0.1], "dim" if k else "bright")
        for k, (u, v) in enumerate(corners)
    ]
    return scene_of(squares, {"bright": emitter(1000), "dim": emitter(1000 * 1e-6)})


def _flux(scene: Scene) -> float:
    """Irradiance at the origin, facing up: the sum of pi times form factor times radiance."""
    total = 0.0
    for square in scene.objects:
        assert isinstance(square, Quad)
        x, _, z = square.corner
        u, v = np.array([x, x + 0.1]), np.array([z, z + 0.1])
        parts = _corner(u[:, None], v[None, :])
        share = parts[1, 1] - parts[0, 1] - parts[1, 0] + parts[0, 0]
        total += math.pi * share * scene.emission_of(square)[0]
    return float(total)


def _corner(a: Array, b: Array) -> Array:
    """Form factor of a parallel rectangle a x b at distance 1, with one corner straight above."""
    p, q = np.sqrt(1 + a * a), np.sqrt(1 + b * b)
    factor: Array = (a / p * np.arctan(b / p) + b / q * np.arctan(a / q)) / (2 * np.pi)
    return factor


RIM = 0.1  # edge of the square of ceiling in view, next to the lamp


def ceiling(lab: Lab) -> Sweep:
    """Error of the light that a lamp just below a ceiling sends through the gap at its edge."""
    x = [0.0003, 0.001, 0.003, 0.01, 0.03, 0.1]
    samples = lab.count(1024, 64)
    kinds: dict[str, tuple[Method, Variant]] = {
        "nee, by solid angle": ("nee", PLAIN),
        "nee, by area": ("nee", BY_AREA),
        "mis": ("mis", PLAIN),
        "naive": ("naive", PLAIN),
    }
    errors: dict[str, list[float]] = {name: [] for name in kinds}
    tolerances: list[float] = []
    wrong = []
    for gap, (name, (method, variant)) in product(x, kinds.items()):
        truth = _rim_light(gap)
        size: dict[str, Any] = {"width": 32, "height": 32, "bounces": 1, "method": method}
        mean, stderr = mean_of(lab.render(_gap_scene(gap), samples, variant, **size))
        errors[name].append(abs(mean / truth - 1))
        if variant is PLAIN and not abs(mean - truth) <= SIGMAS * stderr:
            wrong.append(gap)
        if name == "nee, by solid angle":
            tolerances.append(SIGMAS * stderr / truth)
    first, *others = errors.items()
    return Sweep(
        parameter="gap to the ceiling, in widths of the lamp",
        measure=f"relative error next to the lamp\nafter {1024 * samples:,} samples",
        x=x,
        chosen=first,
        others=dict(others),
        promise="every method within 5.3 standard errors of the closed form",
        bound=tolerances,
        wrong=sorted(set(wrong)),
    )


def _gap_scene(gap: float) -> Scene:
    """Ceiling at y = 0, lamp below it at x from -1 to 0; the camera looks up at x from 0 to RIM."""
    eye = {"position": [RIM / 2, -1, 0], "look_at": [RIM / 2, 0, 0], "up": [0, 0, 1]}
    fov = 2 * math.degrees(math.atan(RIM / 2))
    shapes = [
        plane([0, 0, 0], [0, -1, 0], "white"),
        quad([-1, -gap, -0.5], [1, 0, 0], [0, 0, 1], "lamp"),
    ]
    materials = {"white": matte(0.8), "lamp": emitter(1)}
    return scene_of(shapes, materials, {**eye, "fov": fov})


def _rim_light(gap: float) -> float:
    """Mean radiance of the square of ceiling: 0.8 times the mean form factor of the lamp.

    Gauss-Legendre quadrature over z, and over x in panels whose ends double with the distance from
    the lamp.
    """
    nodes, weights = np.polynomial.legendre.leggauss(16)
    z, z_weight = RIM / 2 * nodes, weights / 2
    edges = np.array([0.0, *np.minimum(gap * 2.0 ** np.arange(-6, 14), RIM)])
    total = 0.0
    for low, high in pairwise(edges):
        x = (low + high) / 2 + (high - low) / 2 * nodes
        factor = _facing_lamp(x[:, None] / gap, z[None, :] / gap, 1 / gap)
        total += (high - low) / 2 * float(weights @ factor @ z_weight)
    return 0.8 * total / RIM


def _facing_lamp(x: Array, z: Array, size: float) -> Array:
    """Form factor of a square lamp whose edge is at a distance `x` aside; lengths in gaps."""
    low, high = size / 2 - z, size / 2 + z
    far = _corner(x + size, low) + _corner(x + size, high)
    near: Array = far - _corner(x, low) - _corner(x, high)
    return near
