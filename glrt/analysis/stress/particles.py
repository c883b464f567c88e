"""Particles: a caustic of a lamp of any size, seen where nothing else is."""

from typing import Any

from glrt.analysis.stress.scenes import glass, lamp, matte, plane, scene_of, sphere
from glrt.analysis.stress.sweep import Lab, Sweep
from glrt.error.estimate import relative_error
from glrt.scene.scene import Scene

RADII = (0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3)
SIDE, SAMPLES, TRUE = 24, 64, 1024  # edge of the frame in pixels; samples a pixel, of the truth
SETTINGS: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": 6, "method": "mis"}
PARTICLES: dict[str, Any] = {"caustics": "on", "particles": 8.0, "aimed": 0.95}
MOST = 0.35  # relative RMS error


def focused(lab: Lab) -> Sweep:
    """Error of a caustic after 64 samples, by the radius of the lamp, whose flux stays the same.

    The truth has 16 times as many samples, and particles.
    """
    errors: dict[str, list[float]] = {"mis, particles": [], "mis": []}
    ways = {"mis, particles": PARTICLES, "mis": {}}
    samples, true = lab.count(SAMPLES, 32), lab.count(TRUE, 256)
    for radius in RADII:
        scene = under_a_ball(radius)
        truth = lab.render(scene, true, seed=1, **SETTINGS, **PARTICLES)
        for name, way in ways.items():
            image = lab.render(scene, samples, **SETTINGS, **way)
            difference = image.radiance - truth.radiance
            errors[name].append(relative_error(truth.radiance, difference) or 0.0)
    return Sweep(
        parameter="radius of the lamp; that of the glass ball is 0.5",
        measure="relative RMS error after 64 samples",
        x=RADII,
        chosen=("mis, particles", errors.pop("mis, particles")),
        others=errors,
        promise=f"at most {MOST:g} at any size of the lamp",
        bound=[MOST] * len(RADII),
    )


def under_a_ball(radius: float) -> Scene:
    """A floor under a ball of glass and a lamp; the camera sees the floor alone."""
    things = [
        plane([0, 0, 0], [0, 1, 0], "floor"),
        sphere([0, 0.8, 0], 0.5, "glass"),
        sphere([0.4, 3, 0.2], radius, "lamp"),
    ]
    materials = {"floor": matte(0.7), "glass": glass(1.5), "lamp": lamp(9 / radius**2)}
    return scene_of(
        things, materials, {"position": [0, 1.2, 3.5], "look_at": [-0.1, 0, 0.05], "fov": 6}
    )
