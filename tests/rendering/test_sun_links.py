"""The sun and bright spots of the sky, linked to the camera straight and through single spheres."""

import math
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, glass, scene_of, sphere
from tests.support.renders import assert_agree, rendered
from tests.support.sky_images import spot, under

ON: dict[str, Any] = {"caustics": "on", "particles": 1.0, "linked": 1.0}
SIZE: dict[str, Any] = {"width": 16, "height": 16, "bounces": 4}
CAMERA: dict[str, Any] = {"position": [0, 0, 0], "look_at": [0, 0, -1], "fov": 60}
AHEAD, BEHIND = [0.2, 0.3, -1.0], [0.3, 0.5, 0.7]
IRRADIANCE = [3.0, 2.0, 1.0]
KINDS: dict[str, dict[str, Any]] = {
    "m": MATTE,
    "glass": glass(),
    "mirror": {"type": "metal", "color": [0.9, 0.7, 0.5], "roughness": 0},
    "lamp": {"type": "light", "emission": [8, 4, 2]},
}
BELOW = sphere([0, -1, -2], 0.5, "m")
BALL = sphere([0, 0, -2], 0.5, "mirror")


def lit(towards: list[float], *things: dict[str, Any], angle: float = 3.0, **camera: Any) -> Scene:
    sun = {"direction": towards, "angle": angle, "irradiance": IRRADIANCE}
    return scene_of([*things], KINDS, {**CAMERA, **camera}, sun=sun)


@pytest.mark.slow
@pytest.mark.parametrize("lens", [0.0, 3.0])
def test_a_tiny_sun_in_view_has_its_flux(context: Context, lens: float) -> None:
    """The mean of the picture is E / (4 tan^2 cos^3) of half the field of view and the direction.

    The sun is 0.05 degrees wide. Hardly any of 16,384 rays from the camera meets it.
    """
    scene = lit(AHEAD, BELOW, angle=0.05, defocus_angle=lens, focus_distance=2.0)
    image = rendered(scene, context, 64, width=16, height=16, bounces=0, sampler="sobol", **ON)
    cosine = 1 / math.hypot(*AHEAD)
    area = 4 * math.tan(math.radians(30)) ** 2
    truth = np.array(IRRADIANCE) / (area * cosine**3)
    np.testing.assert_allclose(image.radiance.mean(axis=(0, 1)), truth, rtol=1e-3)


PLACES: dict[str, Scene] = {
    "in view": lit(AHEAD, BELOW),
    "in a mirror ball": lit(BEHIND, BALL, angle=8.0),
    "half hidden, in a mirror ball": lit(BEHIND, BALL, sphere([0.15, 0.27, -1.5], 0.15, "m")),
    "in a ball of glass": lit(AHEAD, sphere([0.3, 0.4, -2], 0.5, "glass")),
    "of a lens, with a lamp": lit(
        AHEAD, BALL, sphere([0.8, 0.8, -2], 0.05, "lamp"), defocus_angle=2.0, focus_distance=2.0
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", PLACES)
def test_links_of_the_sun_change_the_noise_alone(context: Context, name: str) -> None:
    without = rendered(PLACES[name], context, 32768, seed=1, **SIZE)
    assert_agree(rendered(PLACES[name], context, 2048, **SIZE, **ON), without, within=0.12)


@pytest.mark.slow
def test_links_of_a_sky_change_the_noise_alone(context: Context) -> None:
    """The bright pixel of its image is in view, and the mirror ball shows it, too."""
    scene = under(spot(9, 2, radiance=50.0), BALL, BELOW, camera=CAMERA)
    without = rendered(scene, context, 16384, seed=1, **SIZE)
    assert_agree(rendered(scene, context, 4096, **SIZE, **ON), without, within=0.12)


def error_of(image: Image) -> float:
    return float(np.square(image.stderr, dtype=float).mean() ** 0.5)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["in view", "in a mirror ball", "in a ball of glass"])
def test_the_sun_that_is_seen_is_smooth(context: Context, name: str) -> None:
    """Its error falls to less than a tenth."""
    size = {**SIZE, "sampler": "sobol", "bounces": 2}
    plain, linked = (rendered(PLACES[name], context, 4096, **size, **way) for way in ({}, ON))
    assert error_of(linked) < 0.1 * error_of(plain)
