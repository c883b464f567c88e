"""Kernel data for particles from lamps: frame fields, targets, and the sides that they leave."""

import math
from typing import Any

import numpy as np

from glrt.gpu.struct_arrays import Arrays
from glrt.packing.kernel_structs import STRUCTS
from glrt.packing.shapes import in_order
from glrt.plan.lamp_sides import front_shares
from glrt.plan.particles import (
    Ball,
    ParticleFacts,
    linked_groups,
    particle_groups,
    particles_a_sample,
)
from glrt.plan.plan import Plan
from glrt.scene.scene import Scene

Array = np.ndarray[Any, Any]

UNIT_BITS = 40  # bits of the brightest lamp's radiance, in the unit of a particle's splat
LEAST_SHARE = 0.1  # least share of particles from the sun, the sky and the lamps, next to others
NOWHERE = Ball(np.zeros(3), 0.0)
FROM_AFAR = ("from_sun", "from_sky")
_OFF = ("particles", "aimed", "splat_unit", "linked", "linked_groups", "bounds_radius", *FROM_AFAR)


def particle_fields(plan: Plan) -> dict[str, object]:
    """Return the fields of the frame that particles read; all are 0 with caustics off.

    `splat_unit`, in which particles add to pixels, lies UNIT_BITS bits below the brightest lamp.
    """
    scene, settings, particles = plan.scene, plan.settings, plan.facts.particles
    if settings.caustics == "off":
        return {**dict.fromkeys(_OFF, 0), "bounds_center": (0.0, 0.0, 0.0)}
    brightest = max([max(scene.emission_of(lamp)) for lamp in particles.lamps], default=0.0)
    ball = plan.bounds or NOWHERE
    return {
        "particles": particles_a_sample(settings),
        "aimed": settings.aimed,
        "splat_unit": _unit(max(brightest, _from_the_sun(scene), _from_the_sky(particles))),
        "linked": linked_groups(settings) / particle_groups(settings),
        "linked_groups": linked_groups(settings),
        "bounds_center": ball.center - np.array(scene.camera.position, np.float64),
        "bounds_radius": ball.radius,
        **shares_from_afar(particles, ball),
    }


def _unit(brightest: float) -> float:
    return float(2.0 ** (math.frexp(brightest)[1] - UNIT_BITS)) if brightest else 1.0


def _from_the_sun(scene: Scene) -> float:
    """Return the irradiance of a surface that faces the sun, in its brightest channel.

    The radiance of a small sun may be huge, so it does not set the unit.
    """
    if not scene.sun:
        return 0.0
    return max(scene.sun_radiance) * 2 * math.pi * scene.sun.versine


def _from_the_sky(particles: ParticleFacts) -> float:
    """Return the mean radiance of a sky image, or a gradient's largest; 0 without particles."""
    if not particles.sky_sends:
        return 0.0
    scene = particles.scene
    pixels = scene.sky.pixels if scene.sky else None
    mean = 1.0 if pixels is None else float(pixels[..., :3].mean(dtype=np.float64))
    return mean * max(map(max, scene.background_colors))


def shares_from_afar(particles: ParticleFacts, bounds: Ball) -> dict[str, float]:
    """Return the shares of the particles that leave the sun and the sky, as fields of the frame.

    They follow the flux through the ball around the scene; of the sky, bright spots count alone.
    """
    scene, lamps = particles.scene, particles.lamps
    area = math.pi * bounds.radius**2
    fluxes: dict[str, float] = {}
    if particles.sun_sends and scene.sun:
        solid_angle = 2 * math.pi * scene.sun.versine
        fluxes["from_sun"] = sum(scene.sun_radiance) * solid_angle * area
    if particles.sky_sends:
        bright = particles.bright_sky * _from_the_sky(particles)
        fluxes["from_sky"] = 3 * bright * 4 * math.pi * area
    if lamps:
        each = (sum(scene.emission_of(lamp)) * math.pi * 4 * lamp.reach**2 for lamp in lamps)
        fluxes["lamps"] = sum(each)
    return shares_of(fluxes)


def shares_of(fluxes: dict[str, float]) -> dict[str, float]:
    """Return the shares of the sun and the sky, by the fluxes of all senders.

    A smaller share becomes LEAST_SHARE, and the others divide the rest. Lamps have what is left.
    """
    total = sum(fluxes.values())
    even = 1 / len(fluxes) if fluxes else 0.0
    shares = {name: it / total if total > 0 else even for name, it in fluxes.items()}
    rare = {name for name, share in shares.items() if share < LEAST_SHARE and len(shares) > 1}
    left = (1 - LEAST_SHARE * len(rare)) / (1 - sum(shares[name] for name in rare)) if rare else 1.0
    found = {name: LEAST_SHARE if name in rare else left * it for name, it in shares.items()}
    return {name: found.get(name, 0.0) for name in FROM_AFAR}


def with_particles(arrays: Arrays, plan: Plan) -> dict[str, Array]:
    """Return the arrays of a scene with the rows that particles read; none with caustics off.

    These are the rows of the structs Target and Sides; Sides has one for each row of Light.
    """
    if plan.settings.caustics == "off":  # `arrays` may be of the same scene with particles
        return {**arrays, **{name: np.zeros(0, STRUCTS[name]) for name in ("Target", "Sides")}}
    scene, balls = plan.scene, plan.facts.particles.targets
    eye = np.array(scene.camera.position, np.float64)
    targets = np.zeros(len(balls), STRUCTS["Target"])
    for row, ball in zip(targets, balls, strict=True):
        row["center"], row["radius"] = ball.center - eye, ball.radius
    shapes, numbers = in_order(scene), arrays["Light"]["shape"]
    sides = np.zeros(len(numbers), STRUCTS["Sides"])
    sides["front"] = 0.5
    is_shape = numbers < len(shapes)  # other lamps are triangles
    sides["front"][is_shape] = front_shares(scene, [shapes[it] for it in numbers[is_shape]])
    sides["back"] = 1 - sides["front"]
    return {**arrays, "Target": targets, "Sides": sides}
