"""Particles: a caustic of a lamp of any size, seen where nothing else is, and in a mirror."""

from collections.abc import Callable
from typing import Any

from glrt.analysis.stress.scenes import glass, lamp, matte, plane, scene_of, sphere
from glrt.analysis.stress.sweep import Lab, Sweep
from glrt.error.estimate import relative_error
from glrt.scene.scene import Scene

RADII = (0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3)
SIDE, SAMPLES, TRUE = 24, 64, 1024  # edge of the frame in pixels; samples a pixel, of the truth
SETTINGS: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": 6, "method": "mis"}
PARTICLES: dict[str, Any] = {"caustics": "on", "particles": 8.0, "aimed": 0.95, "linked": 0.0}
LINKED = {**PARTICLES, "linked": 1.0}
MOST, MOST_MIRRORED = 0.35, 0.35  # relative RMS errors
FLOOR = [plane([0, 0, 0], [0, 1, 0], "floor"), sphere([0, 0.8, 0], 0.5, "glass")]


def focused(lab: Lab) -> Sweep:
    """Error of a caustic after 64 samples, by the radius of the lamp, whose flux stays the same.

    The truth has 16 times as many samples, and particles.
    """
    ways = {"mis, particles": PARTICLES, "mis": {}}
    return _errors(lab, under_a_ball, ways, MOST)


def mirrored(lab: Lab) -> Sweep:
    """The same where a mirror ball shows it; what particles are not linked through, they lack."""
    ways = {"mis, particles linked": LINKED, "mis, particles": PARTICLES, "mis": {}}
    return _errors(lab, in_a_mirror, ways, MOST_MIRRORED, least=SAMPLES)


def _errors(
    lab: Lab,
    scene_at: Callable[[float], Scene],
    ways: dict[str, dict[str, Any]],
    most: float,
    least: int = 32,
) -> Sweep:
    """By the radius of the lamp; the first of the ways, which renders the truth, keeps a bound.

    `least`: samples of a quick run.
    """
    first, *_ = ways
    errors: dict[str, list[float]] = {name: [] for name in ways}
    samples, true = lab.count(SAMPLES, least), lab.count(TRUE, 256)
    for radius in RADII:
        scene = scene_at(radius)
        truth = lab.render(scene, true, seed=1, **SETTINGS, **ways[first])
        for name, way in ways.items():
            image = lab.render(scene, samples, **SETTINGS, **way)
            difference = image.radiance - truth.radiance
            errors[name].append(relative_error(truth.radiance, difference) or 0.0)
    return Sweep(
        parameter="radius of the lamp; that of the glass ball is 0.5",
        measure="relative RMS error after 64 samples",
        x=RADII,
        chosen=(first, errors.pop(first)),
        others=errors,
        promise=f"at most {most:g} at any size of the lamp",
        bound=[most] * len(RADII),
    )


def under_a_ball(radius: float) -> Scene:
    """A floor under a ball of glass and a lamp; the camera sees the floor alone."""
    camera = {"position": [0, 1.2, 3.5], "look_at": [-0.1, 0, 0.05], "fov": 6}
    return scene_of([*FLOOR, _lamp(radius)], _materials(radius), camera)


def in_a_mirror(radius: float) -> Scene:
    """The same beside a mirror ball; the camera sees the caustic in it alone."""
    ball = sphere([-1.6, 0.6, 0.4], 0.6, "mirror")
    camera = {"position": [0.4, 1.2, 3.5], "look_at": [-1.07, 0.45, 0.62], "fov": 3}
    return scene_of([*FLOOR, ball, _lamp(radius)], _materials(radius), camera)


def _lamp(radius: float) -> dict[str, Any]:
    return sphere([0.4, 3, 0.2], radius, "lamp")


def _materials(radius: float) -> dict[str, dict[str, Any]]:
    found = {"floor": matte(0.7), "glass": glass(1.5), "lamp": lamp(9 / radius**2)}
    return {**found, "mirror": {"type": "metal", "color": [0.9, 0.9, 0.9]}}
