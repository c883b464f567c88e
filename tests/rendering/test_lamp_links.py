"""Lamps that are linked to the camera where particles leave them: tiny lamps without noise."""

import math
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, disk, glass, lamp, quad, scene_of, sphere
from tests.support.meshes import mesh
from tests.support.numerics import Array
from tests.support.particle_starts import AREA, PLACE, scene
from tests.support.pixel_paths import replayed
from tests.support.renders import assert_agree, rendered

ON: dict[str, Any] = {"caustics": "on", "particles": 1.0, "linked": 1.0}
SIZE: dict[str, Any] = {"width": 16, "height": 16, "sampler": "sobol"}
AHEAD: dict[str, Any] = {"position": [0, 0, 0], "look_at": [0, 0, -1], "fov": 90}
FRAME = 4 * 2.0**2  # area of the picture at a distance of 2
KINDS: dict[str, dict[str, Any]] = {
    "lamp": {"type": "light", "emission": [8, 4, 2]},
    "spot": lamp(8.0, cone={"axis": [-0.1, -0.5, 1], "inner": 20, "outer": 70}),
    "beam": lamp(5.0, cone={"axis": [0, 0, 1], "inner": 10, "outer": 12}),
    "m": MATTE,
    "dark": {"type": "lambertian", "color": [0, 0, 0]},
    "glass": glass(),
    "tinted": glass(attenuation_color=[0.3, 0.6, 0.9], attenuation_distance=0.2),
    "mirror": {"type": "metal", "color": [0.9, 0.7, 0.5], "roughness": 0},
}
EDGE = 0.01
CORNERS = np.array([[0.1, 0.2, -2.0], [0.1 + EDGE, 0.2, -2.0], [0.1, 0.2 + EDGE, -2.0]])
TINY: dict[str, tuple[dict[str, Any], float]] = {  # and the areas that face the camera
    "quad": (quad([0.1, 0.2, -2], [EDGE, 0, 0], [0, EDGE, 0], "lamp"), EDGE**2),
    "disk": (disk([0.1, 0.2, -2], [0, 0, 1], EDGE, "lamp"), math.pi * EDGE**2),
    "triangle": (mesh((CORNERS, np.array([[0, 1, 2]])), "lamp", smooth=False), EDGE**2 / 2),
    "sphere": (sphere([0, 0, -2], EDGE, "lamp"), 4 * math.pi * math.tan(math.asin(EDGE / 2)) ** 2),
}


def alone(*things: dict[str, Any], **camera: Any) -> Scene:
    return scene_of([*things], KINDS, {**AHEAD, **camera})


@pytest.mark.parametrize(
    ("kind", "angle"),
    [
        ("quad", 0.0),
        *(pytest.param(kind, 0.0, marks=pytest.mark.slow) for kind in TINY if kind != "quad"),
        pytest.param("quad", 3.0, marks=pytest.mark.slow),
    ],
)
def test_a_tiny_lamp_is_as_bright_as_its_area(context: Context, kind: str, angle: float) -> None:
    """Its share of the picture is below 1e-4: of 16,384 rays from the camera, hardly one meets it.

    Balls send half of their particles away from the camera.
    """
    thing, area = TINY[kind]
    lens = {"defocus_angle": angle, "focus_distance": 3.0}
    image = rendered(alone(thing, **lens), context, 64, **SIZE, **ON)
    truth = np.array([8.0, 4.0, 2.0]) * area / FRAME
    exact = 0.02 if kind == "sphere" else 1e-3
    np.testing.assert_allclose(image.radiance.mean(axis=(0, 1)), truth, rtol=exact)


@pytest.mark.slow
@pytest.mark.parametrize("kind", PLACE)
def test_points_on_a_lamp_have_a_density(call_glsl: CallGlsl, kind: str) -> None:
    """Its integral over the side that faces the camera, or over a ball, is 1."""
    found = call_glsl(
        "density_on_lamp(0, p, towards)",
        scene=scene(kind),
        options=ON,
        p=np.array([PLACE[kind]] * 2),
        towards=np.array([[0, 1.0, 0], [0, -1.0, 0]]),
    )
    assert found[1] * AREA[kind] == pytest.approx(1)
    assert found[0] == (0 if kind == "sphere" else found[1])


def hidden_by(*things: dict[str, Any]) -> Scene:
    """A lamp of a quarter of a pixel, with things before it.

    No surface scatters light: without particles, few samples meet caustics of tiny lamps.
    """
    return alone(quad([0.0, 0.05, -2], [0.06, 0, 0], [0, 0.04, 0], "lamp"), *things, fov=40)


NEAR_A_BALL = sphere([0.3, -0.2, -1.8], 0.2, "mirror")
PLACES: dict[str, Scene] = {
    "seen": hidden_by(),
    "half hidden": hidden_by(sphere([0.115, 0.035, -1], 0.1, "dark")),
    "of several": hidden_by(
        sphere([-0.3, 0.2, -2.2], 0.02, "lamp"),
        disk([0.4, 0.3, -2.5], [-0.1, -0.5, 1], 0.02, "spot"),
        {**quad([-0.4, -0.3, -2], [0.02, 0, 0], [0, 0.02, 0], "lamp"), "emission_side": "front"},
    ),
    "in a mirror ball": hidden_by(NEAR_A_BALL),
    "in balls of glass": hidden_by(
        sphere([0.3, -0.2, -1.8], 0.2, "glass"), sphere([-0.35, -0.2, -1.7], 0.2, "tinted")
    ),
    "behind a ball of glass": hidden_by(sphere([0.0, 0.05, -1.2], 0.2, "glass")),
    "two in one place": hidden_by(quad([0.01, 0.04, -2], [0.04, 0, 0], [0, 0.06, 0], "lamp")),
    "a large one": alone(quad([-0.4, -0.3, -2], [0.9, 0, 0], [0, 0.7, 0.2], "lamp"), fov=40),
    "around the camera": alone(sphere([0, 0, 0], 3, "lamp"), sphere([0.2, 0, -1], 0.2, "m")),
}


CASES = [
    *((name, 1.0) for name in PLACES),
    *((name, linked) for name in PLACES for linked in (0.0, 0.5) if "ball" in name),
]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "linked"), CASES)
def test_links_of_lamps_change_the_noise_alone(context: Context, name: str, linked: float) -> None:
    """All lamps are also linked through spheres, or half of them, or none."""
    size: dict[str, Any] = {"width": 16, "height": 16, "bounces": 4}
    without = rendered(PLACES[name], context, 32768, seed=1, **size)
    image = rendered(PLACES[name], context, 8192, **size, **{**ON, "linked": linked})
    assert_agree(image, without, within=0.12)


def error_of(image: Image) -> float:
    return float(np.square(image.stderr, dtype=float).mean() ** 0.5)


@pytest.mark.slow
def test_a_large_lamp_stays_smooth(context: Context) -> None:
    """Links of a lamp that fills an eighth of the picture add a thirtieth to its error at most."""
    place = PLACES["a large one"]
    size: dict[str, Any] = {"width": 32, "height": 32, "sampler": "independent"}
    plain = rendered(place, context, 256, **size)
    linked = rendered(place, context, 256, **size, **{**ON, "particles": 0.25})
    assert error_of(linked) < 1.03 * error_of(plain)


@pytest.mark.slow
def test_a_lamp_in_a_mirror_ball_is_smooth(context: Context) -> None:
    """The error of the picture falls to less than a tenth, as all of it is from that lamp."""
    size: dict[str, Any] = {"width": 32, "height": 32, "sampler": "sobol", "bounces": 1}
    place = PLACES["in a mirror ball"]
    plain = rendered(place, context, 1024, **size)
    assert error_of(rendered(place, context, 1024, **size, **ON)) < 0.1 * error_of(plain)


@pytest.mark.slow
def test_links_of_lamps_are_as_long_as_their_paths(context: Context) -> None:
    """A ball of glass shows a lamp behind the camera by one event, or by three through the ball."""
    place = alone(
        quad([0.2, 0.3, 1], [0.8, 0, 0], [0, 0.6, 0], "lamp"),
        sphere([0, 0, -1.5], 0.5, "glass"),
        fov=40,
    )
    size: dict[str, Any] = {"width": 16, "height": 16}
    renderer = Renderer(place, context=context, layering="lengths", bounces=4, **size, **ON)
    renderer.render(2048)
    images = []
    for bounces in (0, 1, 4):
        renderer.update(bounces=bounces)
        images.append(renderer.image())
    renderer.release()
    assert not images[0].radiance.any()
    for image, bounces in zip(images[1:], (1, 4), strict=True):
        without = rendered(place, context, 65536, seed=1, bounces=bounces, **size)
        assert_agree(image, without, within=0.12)
    assert images[2].radiance.mean() > 1.2 * images[1].radiance.mean()


@pytest.mark.slow
@pytest.mark.parametrize("material", ["lamp", "beam"])
def test_a_recorded_particle_shows_the_lamp_that_is_seen(context: Context, material: str) -> None:
    """Most particles of a beam leave outside of it and carry nothing, but the camera is in it."""
    thing, area = TINY["quad"]
    scene = alone({**thing, "material": material})
    found = replayed(scene, (8, 7), context, samples=8, **ON)
    assert found.particles
    emission = np.array(scene.emission_of(scene.visible[0]))
    radiance = np.array(found.particles.mean)
    np.testing.assert_allclose(radiance, emission * area / FRAME * 256, rtol=0.02)
    for path in found.particles.paths:
        light = path.contributions[0]
        assert light.vertex == 0
        assert light.radiance == pytest.approx(tuple(emission))
        assert light.weight == pytest.approx(1, abs=1e-3)


def shares(call_glsl: CallGlsl, over: Array) -> Array:
    weights = "vec2(weight_of_light_link(over), weight_beside_links(over))"
    return call_glsl(weights, returns="vec2", scene=scene("quad"), options=ON, over=over)


@pytest.mark.slow
def test_both_ways_share_the_light_of_a_lamp(call_glsl: CallGlsl) -> None:
    """A ray counts as 32 particles."""
    over = 10.0 ** np.random.default_rng(5).uniform(-6, 6, 2000)
    found = shares(call_glsl, over)
    np.testing.assert_allclose(found.sum(axis=1), 1, rtol=2e-6)
    np.testing.assert_allclose(found[:, 0], 1 / (1 + (32 * over) ** 2), rtol=1e-5)
