"""Particles at surfaces whose normals for shading are not their own.

Flux arrives by the true normal, and light is scattered by the other one: particles carry the ratio.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from tests.support import particle_rooms
from tests.support.builders import box_of_quads, quad, scene_of, sphere
from tests.support.meshes import icosphere, mesh, quads
from tests.support.particle_rooms import CAMERA, LAMP, room
from tests.support.renders import assert_agree, assert_mean, rendered, whole
from tests.support.textures import with_images

ON: dict[str, Any] = {"caustics": "on", "linked": 0.0, "particles": 4.0, "aimed": 0.0}
IRRADIANCE, ALBEDO, REFLECTANCE = 3.0, 0.6, 0.9
MATERIALS: dict[str, dict[str, Any]] = {
    "matte": {"type": "lambertian", "color": [ALBEDO] * 3},
    "mirror": {"type": "metal", "color": [REFLECTANCE] * 3, "roughness": 0},
    "pane": {"type": "dielectric", "ior": 1.5, "thin": True},
}
TOWARDS_SUN = np.array([0.8, 0.6, 0.0])
UP = np.array([0.0, 1.0, 0.0])
TILTED = np.array([-0.3, 0.9, 0.2]) / np.linalg.norm([-0.3, 0.9, 0.2])


def leaf(size: float, material: str, normal: Any) -> dict[str, Any]:
    """A square in the plane y = 0, with another normal for shading."""
    square = quads([[-size, 0, -size], [0, 0, 2 * size], [2 * size, 0, 0]])
    return mesh(square, material, normals=np.tile(normal, (4, 1)))


def under_the_sun(camera: dict[str, Any], *things: dict[str, Any], angle: float = 1.0) -> Scene:
    sun = {"direction": TOWARDS_SUN.tolist(), "angle": angle, "irradiance": [IRRADIANCE] * 3}
    return scene_of(list(things), MATERIALS, camera, sun=sun)


def passed_by_a_pane(cosine: float, ior: float = 1.5) -> float:
    """Fresnel's share that is not reflected by either face, over all reflections within."""
    inside = np.sqrt(1 - (1 - cosine**2) / ior**2)
    across = (cosine - ior * inside) / (cosine + ior * inside)
    along = (ior * cosine - inside) / (ior * cosine + inside)
    reflected = (across**2 + along**2) / 2
    return float((1 - reflected) / (1 + reflected))


AWAY = np.array([-0.3, np.sqrt(1 - 0.09), 0.0])  # from the mirror to the ceiling
HALF = (AWAY + TOWARDS_SUN) / np.linalg.norm(AWAY + TOWARDS_SUN)
FLOOR = {"position": [0, 0.4, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 40}
CEILING = {"position": [0, 0.5, 0], "look_at": [0, 1, 0], "up": [0, 0, 1], "fov": 38}
SHEET = quad([-0.3, 0.5, -0.3], [1.3, 0, 0], [0, 0, 0.6], "pane")
PLACES: dict[str, tuple[dict[str, Any], list[dict[str, Any]]]] = {
    "matte": (FLOOR, [leaf(0.2, "matte", TILTED)]),
    "matte under a pane": (FLOOR, [leaf(0.2, "matte", TILTED), SHEET]),
    "mirror": (
        CEILING,
        [leaf(0.5, "mirror", HALF), quad([-0.2, 1, -0.2], [0.4, 0, 0], [0, 0, 0.4], "matte")],
    ),
}


@pytest.mark.slow
def test_a_matte_surface_takes_light_by_its_shading_normal(context: Context) -> None:
    """A pane keeps lamps from being sampled; the true normal would give twice as much light."""
    camera, things = PLACES["matte under a pane"]
    image = rendered(under_the_sun(camera, *things), context, 1024, **ON, bounces=2)
    irradiance = IRRADIANCE * passed_by_a_pane(0.6) * (TILTED @ TOWARDS_SUN)
    assert_mean(whole(image), ALBEDO / np.pi * irradiance, within=0.04)


@pytest.mark.slow
def test_a_mirror_reflects_by_its_shading_normal(context: Context) -> None:
    """Onto a ceiling: the light that its points see in the mirror is that of the sun, unchanged."""
    camera, things = PLACES["mirror"]
    image = rendered(under_the_sun(camera, *things), context, 1024, **ON, bounces=2)
    irradiance = IRRADIANCE * REFLECTANCE * (AWAY @ UP)
    assert_mean(whole(image), ALBEDO / np.pi * irradiance, within=0.04)


@pytest.mark.slow
@pytest.mark.parametrize("place", PLACES)
def test_the_ways_share_light_where_normals_differ(context: Context, place: str) -> None:
    """The sun is so large that scattering finds it as often as particles come."""
    camera, things = PLACES[place]
    scene = under_the_sun(camera, *things, angle=40.0)
    size: dict[str, Any] = {"width": 32, "height": 32, "bounces": 2}
    without = rendered(scene, context, 2048, seed=1, **size)
    image = rendered(scene, context, 1024, **size, **{**ON, "particles": 2.0})
    assert_agree(image, without, within=0.03)


BALLS = [([-0.5, -0.6, -0.5], 0.4), ([0.35, -0.6, -0.3], 0.35), ([-0.1, -0.75, 0], 0.2)]


@pytest.mark.slow
@pytest.mark.parametrize(
    "kinds",
    [
        ("matte", "glass", "mirror"),
        pytest.param(("satin", "frosted", "gold"), marks=pytest.mark.slow),
    ],
    ids=", ".join,
)
def test_smooth_meshes_change_the_noise_alone(context: Context, kinds: Sequence[str]) -> None:
    """The meshes have 20 triangles each, so that both normals are far apart."""
    balls = zip(kinds, BALLS, strict=True)
    things = [mesh(icosphere(0), kind, translate=at, scale=r) for kind, (at, r) in balls]
    size: dict[str, Any] = {"width": 32, "height": 32, "bounces": 6}
    without = rendered(room(LAMP, *things), context, 4096, seed=1, **size)
    image = rendered(room(LAMP, *things), context, 1024, **size, **{**ON, "aimed": 0.5})
    assert_agree(image, without, within=0.05)


@pytest.mark.slow
def test_an_image_of_normals_changes_the_noise_alone(context: Context) -> None:
    """The image bends the normals of a ball of glass."""
    texels = np.random.default_rng(1).uniform(0.25, 0.75, (8, 8, 4))
    texels[..., 2] = 0.9
    glass = {"type": "principled", "transmission": 1.0, "roughness": 0.0}
    kinds = {**particle_rooms.MATERIALS, "bumpy": {**glass, "normal": {"image": "n.png"}}}
    ball = sphere([0.1, -0.5, -0.3], 0.5, "bumpy")
    plain = scene_of([*box_of_quads("matte"), LAMP, ball], kinds, CAMERA)
    scene = with_images(plain, {"n.png": texels})
    size: dict[str, Any] = {"width": 32, "height": 32, "bounces": 6}
    without = rendered(scene, context, 4096, seed=1, **size)
    image = rendered(scene, context, 1024, **size, **{**ON, "aimed": 0.5})
    assert_agree(image, without, within=0.05)
