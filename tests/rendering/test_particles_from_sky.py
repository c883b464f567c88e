"""Particles from the sky, alone and next to those of lamps: the same light as without them."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.packing.particles import shares_from_afar, shares_of
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.plan.particles import ball_around
from glrt.plan.plan import prepare
from glrt.rendering.schedule import rounds_for_particles
from glrt.scene.files.named_images import Pixels
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for
from tests.conftest import CallGlsl
from tests.support.builders import box, cylinder, glass, lamp, plane, scene_of, sphere
from tests.support.images import same_bits
from tests.support.numerics import directions
from tests.support.particle_starts import particle_text, starts
from tests.support.renders import assert_agree, assert_mean, rendered, rendering, whole
from tests.support.sky_images import sky64, spot, under

ON: dict[str, Any] = {"caustics": "on", "linked": 0.0}
CAMERA: dict[str, Any] = {"position": [0, 0, 0.9], "look_at": [0, -0.3, -1], "fov": 80}
BALL = sphere([0.35, -0.6, -0.3], 0.35, "glass")
TUBE = cylinder([-0.5, -1, -0.5], [-0.5, -0.4, -0.5], 0.2, "glass")
FLOOR = box([-2, -1.1, -2.5], [2, -1, 1], "m")
BULB = sphere([-0.3, 0.8, -0.9], 0.15, "bulb")
FLUX_OF_BULB = 8 * np.pi * 4 * np.pi * 0.15**2
SUN = {"direction": [0.5, 1, 0.4], "angle": 4.0, "irradiance": [1.2, 0.9, 0.6]}
DOME = {"bottom": [0.1, 0.1, 0.1], "horizon": [0.5, 0.5, 0.5], "top": [2, 1, 3]}
KINDS: dict[str, dict[str, Any]] = {
    "m": {"type": "lambertian", "color": [0.6, 0.5, 0.4]},
    "white": {"type": "lambertian", "color": [1, 1, 1]},
    "glass": glass(),
    "lamp": lamp(),
}


def sky_flux(scene: Scene, count: int = 1_000_000) -> float:
    """The integral of the red radiance of a sky over all directions."""
    picture = scene.sky
    assert picture
    assert picture.pixels is not None
    return float(4 * np.pi * sky64(picture.pixels, directions(count))[:, 0].mean())


def sun_in_an_image(*things: dict[str, Any], **more: Any) -> Scene:
    """One bright pixel in a dim sky."""
    pixels = spot(10, 1, radiance=60.0) + np.float32(0.2)
    bulb = {"bulb": lamp(8.0)}
    return under(pixels, *things, camera=CAMERA, materials=bulb, **more)


SKIES: dict[str, Scene] = {
    "gradient": scene_of([FLOOR, BALL, TUBE], KINDS, CAMERA, background=DOME),
    "image": sun_in_an_image(FLOOR, BALL),
    "image, a floor without end": sun_in_an_image(plane([0, -1, 0], [0, 1, 0], "m"), BALL, TUBE),
    "image and a lamp": sun_in_an_image(FLOOR, BALL, BULB),
    "image and the sun": sun_in_an_image(FLOOR, BALL, sun=SUN),
    "image, a lamp and the sun": sun_in_an_image(FLOOR, BALL, BULB, sun=SUN),
}


@pytest.fixture
def particle_files() -> str:
    """The text that follows particles, without a film."""
    return particle_text()


@pytest.mark.slow
@pytest.mark.parametrize("name", SKIES)
def test_particles_change_the_noise_alone(context: Context, name: str) -> None:
    size: dict[str, Any] = {"width": 32, "height": 32, "bounces": 5}
    without = rendered(SKIES[name], context, 2048, seed=1, **size)
    image = rendered(SKIES[name], context, 512, **size, **ON, particles=1.0)
    assert_agree(image, without, within=0.05)


@pytest.mark.slow
def test_a_white_furnace_stays_white(context: Context) -> None:
    """All that a constant sky surrounds has its radiance, if it absorbs nothing."""
    things = [sphere([-0.4, 0, -1.5], 0.5, "white"), sphere([0.5, 0, -1.2], 0.4, "glass")]
    sky = {"color": [0.7, 0.7, 0.7]}
    scene = scene_of(things, KINDS, {**CAMERA, "look_at": [0, 0, -1]}, background=sky)
    image = rendered(scene, context, 512, **ON, particles=2.0, bounces=60)
    assert_mean(whole(image), 0.7, within=0.005, floor=1e-5)


@pytest.mark.slow
def test_the_error_falls_where_a_small_sun_shines_through_glass(context: Context) -> None:
    """The error is measured over the floor next to the ball."""
    size: dict[str, Any] = {"width": 48, "height": 48, "sampler": "sobol", "particles": 1.0}
    errors = [
        float(np.square(rendered(SKIES["image"], context, 256, **size, **way).stderr).mean()) ** 0.5
        for way in ({}, ON)
    ]
    assert errors[1] < errors[0] / 1.3


@pytest.mark.slow
@pytest.mark.parametrize("name", ["image", "image and a lamp", "image, a lamp and the sun"])
def test_lines_from_the_sky_have_a_density(call_glsl: CallGlsl, name: str) -> None:
    """Its integral over all directions, and the area across them, is the sky's share."""
    scene = SKIES[name]
    around = ball_around(scene)
    assert around
    share = shares_from_afar(SceneFacts(scene).particles, around)["from_sky"]
    eye = np.array(scene.camera.position)
    towards = directions(400_000)
    random = np.random.default_rng(5)
    u = np.cross(towards, [0.3, 0.5, 0.8])
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    a, b = (random.uniform(-1.2, 1.2, (len(towards), 1)) * around.radius for _ in range(2))
    found = call_glsl(
        "pdf_emission(SKY_LIGHT, p, towards, NOT_AIMED) / PI",
        scene=scene,
        options={**ON, "aimed": 0.5},
        p=around.center - eye + a * u + b * np.cross(towards, u),
        towards=-towards,
    ).astype(np.float64)
    total = 4 * np.pi * (2.4 * around.radius) ** 2 * found
    assert abs(total.mean() - share) < 5 * total.std() / np.sqrt(total.size)
    assert total.std() / np.sqrt(total.size) < 0.1 * share


def test_particles_carry_the_flux_of_the_sky(call_glsl: CallGlsl, particle_files: str) -> None:
    """The flux through the ball around the scene: 4 pi times radiance times its disk's area."""
    scene = scene_of([FLOOR, BALL], KINDS, CAMERA, background={"color": [2, 2, 2]})
    around = ball_around(scene)
    assert around
    power = starts(call_glsl, particle_files, scene, "particle.power.x + 0.0 * n", "float")
    flux = 4 * np.pi * 2 * np.pi * around.radius**2
    assert abs(power.mean() - flux) < 5 * power.std() / np.sqrt(power.size) + 1e-5 * flux
    assert power.std() / np.sqrt(power.size) < 0.02 * flux


def test_each_light_sends_its_flux_in_its_share(call_glsl: CallGlsl, particle_files: str) -> None:
    """In an image, a lamp and the sun: flux through the ball around the scene, or of the lamp."""
    scene = SKIES["image, a lamp and the sun"]
    around = ball_around(scene)
    assert around
    across = np.pi * around.radius**2
    shares = shares_from_afar(SceneFacts(scene).particles, around)
    fluxes = {
        "sky": sky_flux(scene) * across,
        "sun": 1.2 * across,
        "lamp": FLUX_OF_BULB,
    }
    rest = 1 - shares["from_sun"] - shares["from_sky"]
    chances = {"sky": shares["from_sky"], "sun": shares["from_sun"], "lamp": rest}
    sent = (
        "vec3(particle.power.x, particle.light == SKY_LIGHT, particle.light == SUN_LIGHT) + 0.0 * n"
    )
    power, is_sky, is_sun = starts(call_glsl, particle_files, scene, sent, "vec3").T
    for name, chosen in {"sky": is_sky, "sun": is_sun, "lamp": 1 - is_sky - is_sun}.items():
        found = np.stack([power * chosen, chosen], axis=1)
        errors = found.std(axis=0) / np.sqrt(len(found))
        expected = [fluxes[name], chances[name]]
        assert np.all(np.abs(found.mean(axis=0) - expected) < 5 * errors), name
        assert errors[0] < 0.05 * fluxes[name]
        assert chances[name] > 0.05


@pytest.mark.slow
def test_the_sky_is_shared_by_three_ways(call_glsl: CallGlsl) -> None:
    """The light of a lamp is shared in the same way."""
    random = np.random.default_rng(9)
    kappa, rho, scattered = (10.0 ** random.uniform(-3, 3, 5000) for _ in range(3))
    weights = [
        "emission_beside_particles(ray, Hit(0.0, NO_SHAPE), SKY_LIGHT, kappa, rho)",
        "sample_beside_particles(light, scattered, rho)",
        "particle_weight(rho / pdf_emission(SKY_LIGHT, p, -ray.direction, NOT_AIMED), kappa)",
    ]
    setup = """
    vec3 p = vec3(0.1, -0.5, -1.2);
    Ray ray = Ray(p, normalized(vec3(0.3, 1.0, 0.2)), NO_SHAPE, false);
    LightSample light = LightSample(ray, FAR, kappa * scattered, vec3(0.0), 0, 0, NO_LIGHT);"""
    inputs = {"kappa": kappa, "rho": 0.01 * rho, "scattered": scattered}
    shares = [
        call_glsl(weight, scene=SKIES["image"], options=ON, setup=setup, **inputs)
        for weight in weights
    ]
    assert_allclose(np.sum(shares, axis=0), 1, rtol=2e-6)
    assert all((share > 0.5).sum() > 50 for share in shares)


@pytest.mark.parametrize(
    ("pixels", "sends"),
    [
        (spot(10, 1, radiance=60.0) + np.float32(0.2), True),
        (spot(10, 1, radiance=60.0) + np.float32(10.0), False),  # too little light
        (spot(10, 1, radiance=2.0) + np.float32(0.2), False),  # not bright enough
        (np.ones((8, 16, 3), np.float32), False),
    ],
)
def test_a_sky_with_a_bright_spot_sends_particles_next_to_a_lamp(
    pixels: Pixels, sends: bool
) -> None:
    bulb = {"bulb": lamp(8.0)}
    assert SceneFacts(under(pixels, FLOOR, BULB, materials=bulb)).particles.sky_sends == sends
    assert SceneFacts(under(pixels, FLOOR)).particles.sky_sends
    tinted = {"tinted": glass(attenuation_color=[0.5, 0.6, 0.7], attenuation_distance=1.0)}
    water = plane([0, -1.5, 0], [0, 1, 0], "tinted")
    scene = under(pixels, FLOOR, BULB, water, materials=bulb | tinted)
    assert not SceneFacts(scene).particles.sky_sends


@pytest.mark.parametrize(
    ("name", "weighed", "start"), [("image", 2, 16), ("image, a lamp and the sun", 4, 20)]
)
def test_each_kind_of_light_is_weighed_in_the_limit_of_loops(
    name: str, weighed: int, start: int
) -> None:
    """Against the spheres and the line of a particle from afar, at each vertex.

    Each particle is linked to the camera first: a lamp to choose, two searches for a target, the
    planes on its way, and a shadow.
    """
    settings = Settings(caustics="on", aimed=0.5, linked=0.0, bounces=3)
    spheres = 1 if weighed == 2 else 2
    rounds = 4 * (weighed * (1 + spheres) + 1) + start
    assert rounds_for_particles(prepare(SKIES[name], settings)) == rounds


@pytest.mark.parametrize(
    ("fluxes", "sun", "sky"),
    [
        ({"from_sky": 2.0}, 0, 1),
        ({"from_sun": 0.0}, 1, 0),
        ({"from_sun": 3.0, "lamps": 1.0}, 0.75, 0),
        ({"from_sun": 1e9, "lamps": 1.0}, 0.9, 0),
        ({"from_sky": 0.0, "lamps": 0.0}, 0, 0.5),
        ({"from_sun": 6.0, "from_sky": 3.0, "lamps": 1e-9}, 0.6, 0.3),
        ({"from_sun": 1e-9, "from_sky": 1e-9, "lamps": 5.0}, 0.1, 0.1),
        ({}, 0, 0),
    ],
)
def test_each_light_has_a_share_of_a_tenth_at_least(
    fluxes: dict[str, float], sun: float, sky: float
) -> None:
    found = shares_of(fluxes)
    assert found == pytest.approx({"from_sun": sun, "from_sky": sky})


def test_bright_spots_have_their_share_of_the_flux() -> None:
    """Rows of equal height count by the sine of their angle from the pole."""
    pixels = np.full((4, 100, 3), 0.1, np.float32)
    pixels[0, 5], pixels[1, 7] = 30, 20
    sines = np.sin(np.pi * np.array([1, 3, 5, 7]) / 8)
    bright = 30 * sines[0] + 20 * sines[1]
    total = 0.1 * (100 * sines.sum() - sines[0] - sines[1]) + bright
    particles = SceneFacts(under(pixels, FLOOR)).particles
    assert particles.bright_sky == pytest.approx(bright / total)


@pytest.mark.slow
def test_where_a_lamp_shines_a_gradient_sends_none(context: Context) -> None:
    """Pictures with particles, a lamp and a gradient therefore keep their bits."""
    things = [FLOOR, BALL, sphere([0, 1, -0.5], 0.1, "lamp")]
    films = []
    for top in ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0]):
        sky = {"bottom": [0, 0, 0.5], "top": top}
        scene = scene_of(things, KINDS, CAMERA, background=sky)
        assert needs_of(SceneFacts(scene), settings_for(scene.render, **ON)).has_particles
        with rendering(scene, context, **ON) as renderer:
            image = renderer.render(16).image()
            assert image.particles
            films.append(image.particles.mean)
    assert same_bits(*films)
