"""Particles: caustics of lamps, glasses, numbers of balls and cameras of any kind."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from glrt.error.estimate import relative_error
from glrt.lab.scenes import glass, lamp, matte, plane, scene_of, sphere
from glrt.lab.sweep import Lab, Sweep
from glrt.scene.scene import Scene

RADII = (0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3)
SMALL = 0.03  # radius of the lamp where something else varies
SIDE, SAMPLES, TRUE = 24, 64, 1024  # edge of the frame in pixels; samples a pixel, of the truth
SETTINGS: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": 6, "method": "mis"}
PARTICLES: dict[str, Any] = {"caustics": "on", "particles": 8.0, "aimed": 0.95, "linked": 0.0}
LINKED = {**PARTICLES, "linked": 1.0}
WAYS: dict[str, dict[str, Any]] = {"mis, particles": PARTICLES, "mis": {}}
RADIUS_OF_LAMP = "radius of the lamp; that of the glass ball is 0.5"
MOST, MOST_GROUND = 0.35, 0.5  # relative RMS errors
SEEN = 0.002  # relative error of the mean of a picture that shows one lamp
CLOSEST = 1.0  # distance of the camera from the caustic that has a guarantee
FLOOR = plane([0, 0, 0], [0, 1, 0], "floor")
BALL = sphere([0, 0.8, 0], 0.5, "glass")
CAMERA: dict[str, Any] = {"position": [0, 1.2, 3.5], "look_at": [-0.1, 0, 0.05], "fov": 6}


def focused(lab: Lab) -> Sweep:
    """Error of a caustic after 64 samples, by the radius of the lamp, whose flux stays the same.

    The truth has 16 times as many samples, and particles.
    """
    return _errors(lab, RADIUS_OF_LAMP, {radius: under_a_ball(radius) for radius in RADII})


def mirrored(lab: Lab) -> Sweep:
    """Error of a caustic in a mirror ball, by the radius of the lamp; it needs linked particles."""
    ways = {"mis, particles linked": LINKED, **WAYS}
    scenes = {radius: in_a_mirror(radius) for radius in RADII}
    return _errors(lab, RADIUS_OF_LAMP, scenes, ways, least=SAMPLES)


def in_view(lab: Lab) -> Sweep:
    """Error of a picture of one lamp that faces the camera, by its share of the picture.

    Its flux stays the same, and the truth is a closed form: that flux over the picture's area.
    """
    shares = (0.1, 0.01, 1e-3, 1e-4, 1e-6, 1e-8)
    samples = lab.count(SAMPLES, 32)
    errors: dict[str, list[float]] = {name: [] for name in WAYS}
    for share in shares:
        scene = facing(share)
        for name, way in WAYS.items():
            image = lab.render(scene, samples, **SETTINGS, **way)
            errors[name].append(abs(float(image.radiance.mean(dtype=float)) - 1))
    parameter = "area of the lamp over that of the picture"
    sweep = _sweep(parameter, shares, errors, SEEN)
    return replace(sweep, measure="relative error of the picture's mean after 64 samples")


def ground(lab: Lab) -> Sweep:
    """The error of a caustic by the roughness of the glass, from polished to ground."""
    values = (0.01, 0.03, 0.1, 0.2, 0.4, 0.7, 1.0)
    kinds = {x: {**glass(1.5), "roughness": x} for x in values}
    scenes = {x: under_a_ball(SMALL, material=kind) for x, kind in kinds.items()}
    return _errors(lab, "roughness of the glass", scenes, most=MOST_GROUND)


def refracted(lab: Lab) -> Sweep:
    """The error of a caustic by the index of refraction."""
    values = (1.05, 1.2, 1.5, 2.0, 3.0)
    scenes = {x: under_a_ball(SMALL, material=glass(x)) for x in values}
    return _errors(lab, "index of refraction of the ball", scenes)


def many(lab: Lab) -> Sweep:
    """The error under one ball of glass among many, which share the particles.

    Particles are aimed at 31 of the balls.
    """
    counts = (1.0, 4.0, 16.0, 64.0)
    scenes = {count: under_a_ball(SMALL, balls=int(count)) for count in counts}
    return replace(
        _errors(lab, "balls of glass", scenes),
        promise=f"at most {MOST:g} times the root of their number, and no light is cut",
        bound=[MOST * math.sqrt(count) for count in counts],
    )


def aperture(lab: Lab) -> Sweep:
    """The error of a caustic in focus, by the angle of the lens as seen from the caustic."""
    values = (0.1, 1.0, 5.0, 20.0)
    scenes = {x: under_a_ball(SMALL, defocus_angle=x, focus_distance=3.8) for x in values}
    return _errors(lab, "angle of the lens at the caustic, in degrees", scenes)


def near(lab: Lab) -> Sweep:
    """The error of a caustic by the distance of the camera: close up, few particles are in view."""
    distances = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0)
    places = {x: [-0.1, 0.3 * x, 0.05 + x] for x in distances}
    scenes = {x: under_a_ball(SMALL, position=place) for x, place in places.items()}
    return replace(
        _errors(lab, "distance of the camera from the caustic", scenes),
        promise=f"at most {MOST:g} from {CLOSEST:g} on, and no light is cut anywhere",
        guaranteed=[x >= CLOSEST for x in distances],
    )


def _errors(
    lab: Lab,
    parameter: str,
    scenes: Mapping[float, Scene],
    ways: Mapping[str, dict[str, Any]] = WAYS,
    least: int = 32,
    most: float = MOST,
) -> Sweep:
    """Errors of scenes by `parameter`; the first way also renders the truth, and has the bound.

    `least`: samples of a quick run.
    """
    first, *_ = ways
    errors: dict[str, list[float]] = {name: [] for name in ways}
    samples, true = lab.count(SAMPLES, least), lab.count(TRUE, 256)
    wrong = []
    for x, scene in scenes.items():
        with lab.rendering(scene, seed=1, **SETTINGS, **ways[first]) as renderer:
            truth = renderer.render(true).image().radiance
            if renderer.lost_particles.clipped:
                wrong.append(x)
        for name, way in ways.items():
            image = lab.render(scene, samples, **SETTINGS, **way)
            errors[name].append(relative_error(truth, image.radiance - truth) or 0.0)
    promise = f"at most {most:g} everywhere, and no light is cut"
    return replace(_sweep(parameter, scenes, errors, most), promise=promise, wrong=wrong)


def _sweep(
    parameter: str, x: Iterable[float], errors: Mapping[str, list[float]], most: float
) -> Sweep:
    """Errors of ways by `parameter`; those of the first way are at most `most`."""
    (first, chosen), *others = errors.items()
    return Sweep(
        parameter=parameter,
        measure="relative RMS error after 64 samples",
        x=list(x),
        chosen=(first, chosen),
        others=dict(others),
        promise=f"at most {most:g} everywhere",
        bound=[most] * len(chosen),
    )


def under_a_ball(
    radius: float, material: dict[str, Any] | None = None, balls: int = 1, **camera: Any
) -> Scene:
    """A floor under a ball of glass and a lamp; the camera sees the floor alone.

    `balls` is the number of balls; all but one are outside the view, in rows behind it.
    """
    rest = [sphere([i % 8 - 4, 0.8, -2 - i // 8], 0.3, "glass") for i in range(balls - 1)]
    materials = _materials(radius) | ({"glass": material} if material else {})
    return scene_of([FLOOR, BALL, *rest, _lamp(radius)], materials, {**CAMERA, **camera})


def facing(share: float) -> Scene:
    """A disk that fills this share of a square picture, whose mean radiance is 1."""
    wide = 2 * math.tan(math.radians(CAMERA["fov"]) / 2)
    disk = {
        "shape": "disk",
        "center": [0.1 * wide, 0.1 * wide, -1],
        "normal": [0, 0, 1],
        "radius": wide * math.sqrt(share / math.pi),
        "material": "lamp",
    }
    camera = {"position": [0, 0, 0], "look_at": [0, 0, -1], "fov": CAMERA["fov"]}
    return scene_of([disk], {"lamp": lamp(1 / share)}, camera)


def in_a_mirror(radius: float) -> Scene:
    """The floor of `under_a_ball` with a mirror ball; the camera sees the caustic in that alone."""
    ball = sphere([-1.6, 0.6, 0.4], 0.6, "mirror")
    camera = {"position": [0.4, 1.2, 3.5], "look_at": [-1.07, 0.45, 0.62], "fov": 3}
    return scene_of([FLOOR, BALL, ball, _lamp(radius)], _materials(radius), camera)


def _lamp(radius: float) -> dict[str, Any]:
    return sphere([0.4, 3, 0.2], radius, "lamp")


def _materials(radius: float) -> dict[str, dict[str, Any]]:
    found = {"floor": matte(0.7), "glass": glass(1.5), "lamp": lamp(9 / radius**2)}
    return {**found, "mirror": {"type": "metal", "color": [0.9, 0.9, 0.9]}}
