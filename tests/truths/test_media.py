"""Fog, milk and glowing gas against closed forms."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from tests.support.builders import box, cylinder, lamp, plane, quad, sphere
from tests.support.images import same_bits
from tests.support.media import DUSK, EVEN, FAR, HAZE, MU, ball, filled, medium, with_fog
from tests.support.meshes import box as box_of_triangles
from tests.support.meshes import icosphere, mesh
from tests.support.renders import METHODS, assert_agree, assert_mean, rendered, whole

BODIES: dict[str, dict[str, Any]] = {  # each 1 long on the axis of the camera
    "box": filled(box([-9, -9, -0.5], [9, 9, 0.5], "")),
    "sphere": ball(0.5),
    "cylinder": filled(cylinder([0, 0, -0.5], [0, 0, 0.5], 9, "")),
    "mesh": filled(mesh(box_of_triangles([-9, -9, -0.5], [9, 9, 0.5]), "")),
}


# --- without scattering: exact ---------------------------------------------------------------


@pytest.mark.slow_cases("*-nee", "*-mis")
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("shape", BODIES)
def test_a_medium_that_absorbs_leaves_what_beer_says(
    context: Context, shape: str, method: str
) -> None:
    scene = with_fog([BODIES[shape]], medium(absorption=MU), background=EVEN)
    image = rendered(scene, context, 4, method=method)
    rounding = 3e-5 if shape == "mesh" else 5e-6  # of a length of 1 among coordinates of 9
    assert_allclose(image.radiance, np.broadcast_to(np.exp(-MU), (16, 16, 3)), rtol=rounding)
    assert (image.stderr <= 1e-6).all()


def test_a_half_space_ends_at_its_plane(context: Context) -> None:
    """The camera stands in the medium, a lamp out of it."""
    things = [
        filled(plane([0, 0, 3], [0, 0, -1], "")),
        quad([-9, -9, 0], [18, 0, 0], [0, 18, 0], "lamp"),
    ]
    image = rendered(with_fog(things, medium(absorption=MU)), context, 1)
    assert_allclose(image.radiance, np.broadcast_to(9 * np.exp(-2 * MU), (16, 16, 3)), rtol=2e-6)


def test_a_ball_of_gas_shines_as_long_as_it_is_deep(context: Context) -> None:
    """Emission e and absorption a give e / a (1 - exp(-a d)); without absorption, e d."""
    absorption = np.array([0.5, 2.0, 0.0])
    scene = with_fog([ball()], medium(absorption=absorption, emission=[1, 2, 3]))
    image = rendered(scene, context, 1, bounces=0)
    truth = [2 * (1 - math.exp(-1.0)), 1 - math.exp(-4.0), 6.0]
    assert_allclose(image.radiance, np.broadcast_to(truth, (16, 16, 3)), rtol=4e-6)


def test_gas_of_almost_no_depth_keeps_its_digits(context: Context) -> None:
    scene = with_fog([ball(0.5)], medium(absorption=[1e-7, 1e-4, 2e-3], emission=1))
    image = rendered(scene, context, 1)
    truth = -np.expm1(-np.array([1e-7, 1e-4, 2e-3])) / np.array([1e-7, 1e-4, 2e-3])
    assert_allclose(image.radiance, np.broadcast_to(truth, (16, 16, 3)), rtol=2e-6)


def test_a_floor_under_a_slab_gets_the_exponential_integral(context: Context) -> None:
    """E = 2 pi E3(tau) under an even sky of radiance 1 (E3: Abramowitz and Stegun 5.1)."""
    things = [
        plane([0, 0, 0], [0, 1, 0], "white"),
        filled(box([-900, 1, -900], [900, 2, 900], "")),
    ]
    eye = {"position": [0, 0.5, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 0.01}
    scene = with_fog(things, medium(absorption=MU), eye, background=EVEN)
    image = rendered(scene, context, 4096, bounces=1, roulette=False)
    assert_mean(whole(image), 0.7 * np.array([0.443209, 0.219384, 0.060267]), 0.01)


# --- scattering ------------------------------------------------------------------------------


@pytest.mark.parametrize("depth", [0.01, 1.0, 8.0])
def test_a_slab_that_scatters_lets_through_what_beer_says(context: Context, depth: float) -> None:
    """At most 0 bounces: all that is scattered is lost. The channels differ by up to 4."""
    fog = medium(scattering=0.75 * MU * depth, absorption=0.25 * MU * depth)
    scene = with_fog([BODIES["box"]], fog, background=EVEN)
    image = rendered(scene, context, 4096, bounces=0)
    truth, within = np.exp(-MU * depth), 0.01 if depth < 8 else 0.5
    if depth == 8:  # the last channel lets 1e-7 through: too little to be seen
        image.radiance[..., 2], image.stderr[..., 2], truth[2] = 1, 1e-9, 1
    assert_mean(whole(image), truth, within)


@pytest.mark.parametrize("g", [-0.9, 0.0, 0.9])
def test_a_white_medium_under_an_even_sky_cannot_be_seen(context: Context, g: float) -> None:
    scene = with_fog(
        [ball()], medium(scattering=[0.5, 2, 5], g=g), {**FAR, "fov": 20}, background=EVEN
    )
    image = rendered(scene, context, 256, bounces=1000, roulette=False)
    assert_mean(whole(image), [1.0] * 3, 0.03)


@pytest.mark.slow_cases("naive", "nee")
@pytest.mark.parametrize("method", METHODS)
def test_a_cavity_in_equilibrium_is_even(context: Context, method: str) -> None:
    """Walls that emit what they absorb, and a medium that does the same (Kirchhoff): radiance 1."""
    wall = {"type": "light", "color": [0.5] * 3, "emission": [0.5] * 3}
    things = [
        box([-3, -3, -3], [3, 3, 3], "wall"),
        ball(1.5),
        sphere([0.2, 0, 0], 0.4, "wall"),
        sphere([0, 1.2, 0.9], 0.3, "wall"),  # across the bounds
    ]
    fog = medium(scattering=[1, 2, 0.3], absorption=[0.5, 1, 0.2], emission=[0.5, 1, 0.2], g=0.9)
    eye = {"position": [0, 0, 2.5], "fov": 60}
    scene = with_fog(things, fog, eye, materials={"wall": wall})
    image = rendered(scene, context, 256, method=method, bounces=60)
    assert_mean(whole(image), [1.0] * 3, 0.02)


# H-functions for isotropic scattering: 1 - H(mu) sqrt(1 - albedo) (Chandrasekhar, Radiative
# Transfer, 1950, section 38), by albedo and by the cosine of the view.
HALF_SPACES = {
    0.5: {1.0: 0.11523, 0.5: 0.16014, 0.1: 0.24172},
    0.9: {1.0: 0.41495, 0.5: 0.50794, 0.1: 0.62934},
}


@pytest.mark.parametrize("cosine", [1.0, 0.5, 0.1])
@pytest.mark.parametrize("albedo", HALF_SPACES)
def test_a_half_space_reflects_what_chandrasekhar_says(
    context: Context, albedo: float, cosine: float
) -> None:
    eye = [5 * math.sqrt(1 - cosine**2), 0, 5 * cosine]
    fog = medium(scattering=albedo, absorption=1 - albedo)
    half = filled(plane([0, 0, 0], [0, 0, 1], ""))
    scene = with_fog([half], fog, {**FAR, "position": eye}, background=EVEN)
    image = rendered(scene, context, 512, bounces=256, sampler="sobol")
    assert_mean(whole(image), [HALF_SPACES[albedo][cosine]] * 3, 0.02)


@pytest.mark.slow
def test_a_half_space_that_absorbs_a_hundredth_reflects_what_chandrasekhar_says(
    context: Context,
) -> None:
    half = filled(plane([0, 0, 0], [0, 0, 1], ""))
    scene = with_fog([half], medium(scattering=0.99, absorption=0.01), background=EVEN)
    image = rendered(scene, context, 8192, bounces=1000, sampler="sobol")
    assert_mean(whole(image), [0.75272] * 3, 0.005)


@pytest.mark.parametrize("g", [0.0, 0.8])
def test_a_ball_that_shines_is_as_bright_as_its_mean_chord(context: Context, g: float) -> None:
    """A medium without absorption lets out all its light: the mean chord is 4 V / S = 4 / 3."""
    eye = {**FAR, "position": [0, 0, 1000], "fov": math.degrees(2 * math.atan(1 / 1000))}
    scene = with_fog([ball()], medium(scattering=[3, 1, 0.1], emission=1, g=g), eye)
    image = rendered(scene, context, 512, bounces=300, sampler="sobol")
    assert_mean(whole(image), [4 / 3 * math.pi / 4] * 3, 0.05)


@pytest.mark.slow_cases("nee")
@pytest.mark.parametrize("method", ["nee", "mis"])
def test_a_lamp_in_thin_fog_is_scattered_once(context: Context, method: str) -> None:
    """s I / (4 pi) times the integral of exp(-m (t + r)) / r^2 along the ray, in float64."""
    radius = 1e-4
    things = [
        sphere([0, 1, -2], radius, "bulb"),
        quad([-9, -9, -4], [18, 0, 0], [0, 18, 0], "black"),
    ]
    bulb = lamp(1 / (math.pi * radius**2))
    fog = medium(scattering=0.5, absorption=0.1)
    scene = with_fog(things, fog, {"fov": 0.01}, medium="fog", materials={"bulb": bulb})
    image = rendered(scene, context, 1024, bounces=1, method=method, sampler="sobol")
    t = (np.arange(400_000) + 0.5) / 100_000
    r = np.hypot(1, t - 2)
    truth = 0.5 / (4 * math.pi) * (np.exp(-0.6 * (t + r)) / r**2).sum() / 100_000
    assert truth == pytest.approx(0.0138511, abs=1e-7)
    assert_mean(whole(image), [truth] * 3, 0.01, floor=1e-4 * truth)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["naive", "nee"])
def test_a_lamp_in_fog_is_found_alike(context: Context, method: str) -> None:
    """A large lamp in fog that scatters forward is met by scattering as often as it is sampled."""
    fog = medium(scattering=[1, 2, 0.5], absorption=[0.1, 0.1, 0.3], g=0.8)
    things = [sphere([0.7, 0.2, 0.3], 0.5, "lamp"), sphere([-0.8, -0.4, -0.4], 0.2, "lamp")]
    scene = with_fog([*things, ball(2)], fog, {**FAR, "fov": 40})
    pictures = [
        rendered(scene, context, count, method=one, bounces=4, seed=seed, sampler="sobol")
        for seed, (one, count) in enumerate(((method, 1024), ("mis", 512)))
    ]
    assert_agree(pictures[0], pictures[1], 0.07)


def test_a_ball_under_a_sun_is_scattered_once(context: Context) -> None:
    """Along the ray: s p(g) E times what is left from the sun's side and to the eye."""
    s, mu, g, turn = 0.8, 1.2, 0.5, math.radians(60)
    sun = {"direction": [math.sin(turn), 0, math.cos(turn)], "angle": 0.01, "irradiance": [1.0] * 3}
    scene = with_fog([ball()], medium(scattering=s, absorption=mu - s, g=g), sun=sun)
    image = rendered(scene, context, 2048, bounces=1, sampler="sobol")
    z = 1 - 2 * (np.arange(100_000) + 0.5) / 100_000  # from the front to the back
    along = z * math.cos(turn)
    way = -along + np.sqrt(along**2 + 1 - z**2)
    phase = (1 - g * g) / (4 * math.pi * (1 + g * g + 2 * g * math.cos(turn)) ** 1.5)
    truth = s * phase * (np.exp(-mu * (1 - z + way)) * 2 / len(z)).sum()
    assert_mean(whole(image), [truth] * 3, 0.01, floor=2e-4 * truth)


@pytest.mark.parametrize("k", [-12, 5, 20])
def test_a_scene_in_fog_scales_to_the_same_bits(context: Context, k: int) -> None:
    def scaled(by: float) -> Scene:
        things = [
            plane([0, -by, 0], [0, 1, 0], "white"),
            filled(sphere([0, 0, -3 * by], 0.9 * by, "")),
            sphere([0, 2 * by, -3 * by], 0.4 * by, "lamp"),
        ]
        thin = {
            key: (np.array(value) / by).tolist()
            for key, value in HAZE.items()
            if key != "anisotropy"
        }
        glow = {"emission": [0.1 / by, 0.2 / by, 0.0], "anisotropy": 0.5}
        return with_fog(things, {**thin, **glow}, {"fov": 50}, background=DUSK)

    first, second = (rendered(scaled(by), context, 16).radiance for by in (1.0, 2.0**k))
    assert same_bits(first, second)


def test_fog_far_from_the_origin_is_the_same_fog(context: Context) -> None:
    def at(x: float) -> Scene:
        things = [
            plane([x, -1, 0], [0, 1, 0], "white"),
            filled(sphere([x, 0, -3], 0.9, "")),
            sphere([x, 2, -3], 0.4, "lamp"),
        ]
        eye = {"position": [x, 0, 0], "look_at": [x, 0, -1], "fov": 50}
        return with_fog(things, HAZE, eye, background=DUSK)

    first, second = (rendered(at(x), context, 16).radiance for x in (0.0, 2.0**20))
    assert same_bits(first, second)


def test_the_light_of_a_medium_is_a_group_of_its_own(context: Context) -> None:
    """Dimmed to a quarter, or relit on a film with layers: a quarter of its light."""
    scene = with_fog(
        [ball(), quad([-0.5, 3, -0.5], [1, 0, 0], [0, 0, 1], "lamp")],
        medium(scattering=1, absorption=0.2, emission=[1, 2, 3]),
        {**FAR, "fov": 20},
    )
    assert [*scene.light_groups] == ["lamp", "media.fog", "background"]
    only = scene.model_copy(update={"lights": {"lamp": 0.0}})
    dim = scene.model_copy(update={"lights": {"lamp": 0.0, "media.fog": 0.25}})
    bright, dark = (rendered(it, context, 16).radiance for it in (only, dim))
    assert bright.max() > 0.5
    assert_allclose(dark, bright / 4, rtol=1e-6)


def test_an_icosahedron_of_fog_is_nearly_a_ball(context: Context) -> None:
    """A mesh of 1280 triangles: its volume is 0.7 % below that of the ball."""
    many = filled(mesh(icosphere(3), ""))
    eye = {**FAR, "fov": 24}
    scenes = [with_fog([it], medium(absorption=1, emission=1), eye) for it in (ball(), many)]
    first, second = (whole(rendered(it, context, 64)).mean for it in scenes)
    assert_allclose(second, first, rtol=0.01)
    assert (second < first).all()


@pytest.mark.slow
def test_lamps_in_fog_shine_through_sheets_by_chances_of_their_own(context: Context) -> None:
    """The eye looks through one sheet that is half there, and the lamp hangs behind another."""
    sheet = {"type": "principled", "color": [0.0] * 3, "specular": 0.0, "alpha": 0.5}
    things = [
        quad([-9, -9, -1], [18, 0, 0], [0, 18, 0], "sheet"),
        quad([-9, 1, -9], [18, 0, 0], [0, 0, 18], "sheet"),
        sphere([0, 2, -2.5], 0.7, "lamp"),
    ]
    half = filled(plane([0, 0, -1.2], [0, 0, 1], ""))
    fog, eye = medium(scattering=0.4, absorption=0.1), {"fov": 10}
    scene = with_fog([*things, half], fog, eye, materials={"sheet": sheet})
    pictures = [
        rendered(scene, context, count, method=method, bounces=1, seed=seed)
        for seed, (method, count) in enumerate((("naive", 8192), ("mis", 512)))
    ]
    assert_agree(pictures[0], pictures[1], 0.1)
