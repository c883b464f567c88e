"""Particles that are aimed at solids, and those from the sun: their densities and their flux."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.plan.facts import SceneFacts
from glrt.plan.particles import ball_around
from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.support.builders import (
    box,
    cylinder,
    glass,
    plane,
    scene_of,
    sphere,
)
from tests.support.meshes import mesh
from tests.support.numerics import directions
from tests.support.particle_starts import (
    BALL,
    CORNERS,
    FAR_BALL,
    FLAT,
    MATERIALS,
    ON,
    PLACE,
    particle_text,
    starts,
)

SUN: dict[str, Any] = {"direction": [0.3, 1, 0.2], "angle": 4.0, "irradiance": [2, 2, 2]}


@pytest.fixture
def particle_files() -> str:
    """The text that follows particles, without a film."""
    return particle_text()


# --- solids that are aimed at ----------------------------------------------------------------


SOLIDS = {
    "a box": box([-0.3, -0.8, -3.4], [0.2, -0.3, -2.9], "glass"),
    "a cylinder": cylinder([0, -0.8, -3], [0.1, -0.2, -3.1], 0.3, "glass"),
    "a mesh": mesh((0.3 * CORNERS, np.array([[0, 1, 2]])), "glass", translate=[0, -0.8, -2]),
}


@pytest.mark.slow
@pytest.mark.parametrize("solid", SOLIDS)
def test_directions_towards_a_ball_around_a_solid_have_a_density(
    call_glsl: CallGlsl, particle_files: str, solid: str
) -> None:
    """It integrates to 1, and what is aimed carries the flux of its lamp."""
    if solid == "a mesh":
        kinds = {**MATERIALS, "glass": {"type": "metal", "color": [1, 1, 1], "roughness": 0}}
    else:
        kinds = MATERIALS
    place = scene_of([FLAT, SOLIDS[solid], FAR_BALL], kinds)
    towards = directions(400_000)
    found = call_glsl(
        "pdf_aimed(p, direction, NOT_AIMED)",
        scene=place,
        options={**ON, "aimed": 0.5},
        direction=towards,
        p=np.array([PLACE["quad"]]),
    ).astype(np.float64)
    total = 4 * np.pi * found
    assert len(SceneFacts(place).particles.targets) == 1
    assert abs(total.mean() - 1) < 5 * total.std() / np.sqrt(total.size)
    power = starts(call_glsl, particle_files, place, "particle.power.x + 0.0 * n", "float")
    flux = np.pi * 2.0 * 2 * 0.8
    assert abs(power.mean() - flux) < 5 * power.std() / np.sqrt(power.size)


def test_of_solids_within_each_other_the_outermost_is_aimed_at() -> None:
    glasses = [
        cylinder([0, 0, 0], [0, 1, 0], 0.5, "glass"),
        cylinder([0, 0.1, 0], [0, 0.9, 0], 0.4, "glass"),
        box([3, 0, 0], [4, 1, 1], "glass"),
        box([3, 0, 8], [4, 1, 9], "matte"),
    ]
    found = SceneFacts(scene_of(glasses, MATERIALS)).particles.targets
    assert [ball.center.tolist() for ball in found] == [[3.5, 0.5, 0.5], [0, 0.5, 0]]


METAL: dict[str, Any] = {"type": "metal", "color": [1, 1, 1]}
PRINCIPLED: dict[str, Any] = {"type": "principled", "color": [1, 1, 1]}
KINDS = [
    (True, glass(roughness=1.0)),
    (True, glass(thin=True)),
    (True, {**METAL, "roughness": 0.0}),
    (True, {**METAL, "roughness": 0.4}),
    (False, {**METAL, "roughness": 0.41}),
    (True, {**PRINCIPLED, "transmission": 0.1, "roughness": 0.9}),
    (True, {**PRINCIPLED, "metallic": 1.0, "roughness": 0.4}),
    (False, {**PRINCIPLED, "metallic": 1.0, "roughness": 0.41}),
    (True, {**PRINCIPLED, "metallic": 1.0, "roughness": 0.0}),
    (False, {**PRINCIPLED, "metallic": 0.5, "roughness": 0.1}),
    (False, {"type": "lambertian", "color": [1, 1, 1]}),
]


@pytest.mark.parametrize(("is_one", "kind"), KINDS)
def test_aimed_at_are_glass_and_polished_metal(is_one: bool, kind: dict[str, Any]) -> None:
    things = [sphere([0, 0, 0], 1, "it"), box([2, 0, 0], [3, 1, 1], "it")]
    place = scene_of(things, {"it": kind})
    assert SceneFacts(place).particles.casters == is_one
    assert len(SceneFacts(place).particles.targets) == is_one


# --- the sun ---------------------------------------------------------------------------------


def under_the_sun(*things: dict[str, Any]) -> Scene:
    return scene_of([sphere([0, 0, -3], 1, "matte"), *things], MATERIALS, sun=SUN)


def test_lines_from_the_sun_have_a_density(call_glsl: CallGlsl) -> None:
    """Its integral over the area across them and the solid angle of the sun is 1."""
    place = under_the_sun(BALL, FAR_BALL, SOLIDS["a box"])
    around = ball_around(place)
    assert around
    random = np.random.default_rng(5)
    towards = np.array([0.3, 1, 0.2]) / np.linalg.norm([0.3, 1, 0.2])
    across = np.column_stack([random.uniform(-2, 2, 400_000) * around.radius for _ in range(2)])
    u = np.cross(towards, [1.0, 0, 0]) / np.linalg.norm(np.cross(towards, [1.0, 0, 0]))
    points = around.center + across[:, :1] * u + across[:, 1:] * np.cross(towards, u)
    found = call_glsl(
        "pdf_emission(SUN_LIGHT, p, towards, NOT_AIMED) / (PI * pdf_sun())",
        scene=place,
        options={**ON, "aimed": 0.5},
        p=points,
        towards=np.array([-towards]),
    ).astype(np.float64)
    total = (4 * around.radius) ** 2 * found
    assert abs(total.mean() - 1) < 5 * total.std() / np.sqrt(total.size)
    assert total.std() / np.sqrt(total.size) < 0.02


def test_particles_carry_the_flux_of_the_sun(call_glsl: CallGlsl, particle_files: str) -> None:
    """It passes the disk that the scene's ball fills across the sun: irradiance times area."""
    place = under_the_sun(BALL, FAR_BALL)
    around = ball_around(place)
    assert around
    power = starts(call_glsl, particle_files, place, "particle.power.x + 0.0 * n", "float")
    flux = 2 * np.pi * around.radius**2
    assert abs(power.mean() - flux) < 5 * power.std() / np.sqrt(power.size) + 1e-5 * flux
    assert power.std() / np.sqrt(power.size) < 0.02 * flux


@pytest.mark.slow
def test_lamps_and_the_sun_share_the_particles(call_glsl: CallGlsl, particle_files: str) -> None:
    """Each carries its own flux in total, whatever its share of the particles is."""
    place = under_the_sun(BALL, FLAT)
    around = ball_around(place)
    assert around
    what = "particle.power.x * float(particle.light == SUN_LIGHT) + 0.0 * n"
    sun = starts(call_glsl, particle_files, place, what, "float")
    every = starts(call_glsl, particle_files, place, "particle.power.x + 0.0 * n", "float")
    assert 0.1 < (sun > 0).mean() < 0.95
    fluxes = {0: (2 * np.pi * around.radius**2, sun), 1: (np.pi * 2 * 2 * 0.8, every - sun)}
    for flux, found in fluxes.values():
        assert abs(found.mean() - flux) < 5 * found.std() / np.sqrt(found.size) + 1e-5 * flux


@pytest.mark.slow
def test_particles_come_from_beyond_the_planes(call_glsl: CallGlsl, particle_files: str) -> None:
    """However far along the line of sight one meets it: a low sun over a floor, and a wall."""
    floor = plane([0, -1, 0], [0, 1, 0], "matte")
    wall = plane([0, 0, 60], [0, 0, -1], "matte")
    low = {**SUN, "direction": [0, 0.05, 1]}
    place = scene_of([sphere([0, 0, -3], 1, "matte"), floor, wall], MATERIALS, sun=low)
    heights = starts(
        call_glsl, particle_files, place, "particle.path.ray.origin.y + 0.0 * n", "float"
    )
    ways = starts(call_glsl, particle_files, place, "particle.path.ray.origin.z + 0.0 * n", "float")
    assert heights.min() > -1
    assert ways.min() > 60


@pytest.mark.slow
def test_the_sun_is_shared_by_three_ways(call_glsl: CallGlsl) -> None:
    """The light of a lamp is shared in the same way."""
    random = np.random.default_rng(9)
    kappa, rho, scattered = (10.0 ** random.uniform(-3, 3, 5000) for _ in range(3))
    weights = [
        "emission_beside_particles(ray, Hit(0.0, NO_SHAPE), SUN_LIGHT, kappa, rho)",
        "sample_beside_particles(light, scattered, rho)",
        "particle_weight(rho / pdf_emission(SUN_LIGHT, p, -ray.direction, NOT_AIMED), kappa)",
    ]
    setup = """
    vec3 p = vec3(0.1, -0.2, -3.1);
    Ray ray = Ray(p, frame.sun_direction, NO_SHAPE, false);
    LightSample light = LightSample(ray, FAR, kappa * scattered, vec3(0.0), 0, 0, SUN_LIGHT);"""
    inputs = {"kappa": kappa, "rho": 500 * rho, "scattered": scattered}
    shares = [
        call_glsl(weight, scene=under_the_sun(BALL), options=ON, setup=setup, **inputs)
        for weight in weights
    ]
    assert_allclose(np.sum(shares, axis=0), 1, rtol=2e-6)
    assert all((share > 0.5).sum() > 100 for share in shares)
