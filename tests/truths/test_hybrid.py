"""The method hybrid: closed forms of each effect, and the methods that it is with some of them."""

from typing import Any

import numpy as np
import pytest

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.plan.case import Case
from glrt.plan.combinations import check_render
from glrt.plan.facts import SceneFacts
from glrt.plan.methods import EFFECT_BITS, effect_bits, traits_of
from glrt.plan.omissions import left_out, omissions
from glrt.scene.scene import Scene
from glrt.settings import EFFECTS, Settings, settings_for
from tests.support.builders import glass, lamp, plane, quad, scene_of, sphere
from tests.support.images import same_bits
from tests.support.renders import rendered
from tests.support.sky_images import random_sky, under

NARROW: dict[str, Any] = {"fov": 1e-3}  # degrees: all rays are one
SMALL: dict[str, Any] = {"width": 8, "height": 8, "bounces": 6, "method": "hybrid"}
ALBEDO, EMISSION, SKY = 0.6, 20.0, 0.25
MATERIALS: dict[str, dict[str, Any]] = {
    "matte": {"type": "lambertian", "color": [ALBEDO] * 3},
    "black": {"type": "lambertian", "color": [0.0] * 3},
    "mirror": {"type": "metal", "color": [0.8] * 3},
    "brass": {"type": "metal", "color": [0.8] * 3, "roughness": 0.5},
    "glass": glass(1.5),
    "lamp": lamp(EMISSION),
}


def seen(scene: Scene, context: Context, effects: tuple[str, ...], samples: int = 256) -> float:
    image = rendered(scene, context, samples, effects=effects, **SMALL)
    return float(image.radiance.mean(dtype=np.float64))


# --- closed forms ------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("effects", [(), ("shadows",)])
@pytest.mark.parametrize("is_hidden", [False, True])
def test_a_lamp_lights_a_floor_as_its_form_factor_says(
    context: Context, effects: tuple[str, ...], is_hidden: bool
) -> None:
    """Irradiance of a sphere is PI L (r / d)^2 cos; without shadows nothing hides it."""
    at, radius = np.array([1.0, 2.0, 0.0]), 0.2
    objects = [plane([0, 0, 0], [0, 1, 0], "matte"), sphere(at, radius, "lamp")]
    if is_hidden:
        objects.append(sphere(at / 2, 0.3, "black"))
    camera = {"position": [-3, 2, 0], "look_at": [0, 0, 0], **NARROW}
    away = np.linalg.norm(at)
    truth = ALBEDO * EMISSION * (radius / away) ** 2 * at[1] / away
    if is_hidden and effects:
        truth = 0.0
    found = seen(scene_of(objects, MATERIALS, camera), context, effects, 4096)
    assert found == pytest.approx(truth, rel=2e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("material", "effects", "truth"),
    [
        ("mirror", (), 0.0),
        ("mirror", ("refractions",), 0.0),
        ("mirror", ("reflections",), 0.8 * SKY),
        ("glass", (), 0.0),
        ("glass", ("reflections",), 0.04 * SKY),  # at its front; its back is within
        ("glass", ("refractions",), 0.96 * 0.96 * SKY),
    ],
)
def test_mirrors_and_glass_show_what_their_effects_say(
    context: Context, material: str, effects: tuple[str, ...], truth: float
) -> None:
    """A ball seen in its middle, under an even sky: reflectance is ((n - 1) / (n + 1))^2."""
    camera = {"position": [0, 0, 3], "look_at": [0, 0, 0], **NARROW}
    sky = {"color": [SKY] * 3}
    scene = scene_of([sphere([0, 0, 0], 1, material)], MATERIALS, camera, background=sky)
    samples, close = (1 << 14, 5e-3) if material == "glass" and effects else (64, 1e-5)
    assert seen(scene, context, effects, samples) == pytest.approx(truth, rel=close, abs=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("is_closed", [False, True])
@pytest.mark.parametrize("effects", [(), ("ambient_occlusion",), ("shadows",)])
def test_the_background_is_hidden_by_its_own_effect(
    context: Context, effects: tuple[str, ...], is_closed: bool
) -> None:
    """A floor under an even sky, alone or in a ball that is black."""
    floor = quad([-1, 0, -1], [0, 0, 2], [2, 0, 0], "matte")
    ball = [sphere([0, 0, 0], 3, "black")] if is_closed else []
    camera = {"position": [0, 1, 0.1], "look_at": [0, 0, 0], **NARROW}
    scene = scene_of([*ball, floor], MATERIALS, camera, background={"color": [SKY] * 3})
    share = 0.0 if is_closed and "ambient_occlusion" in effects else 1.0
    assert seen(scene, context, effects) == pytest.approx(share * ALBEDO * SKY, rel=1e-5)


# --- the methods that it is ----------------------------------------------------------------------


def matte_room(camera: dict[str, Any] | None = None, **more: Any) -> Scene:
    """Matte things and a lamp, where shadows of all of them meet."""
    objects = [
        plane([0, -1, 0], [0, 1, 0], "matte"),
        sphere([-0.7, -0.4, -3], 0.6, "matte"),
        quad([0.2, -1, -3.4], [1, 0, 0.4], [0, 1.4, 0], "matte"),
        quad([-0.5, 1.5, -3], [1, 0, 0], [0, 0, 1], "lamp"),
    ]
    return scene_of(objects, MATERIALS, camera or {}, **more)


SUN = {"direction": [0.4, 0.7, 0.3], "angle": 12.0, "irradiance": [2.0, 1.9, 1.7]}
GRADIENT = {"bottom": [0.1, 0.1, 0.2], "horizon": [0.5, 0.4, 0.3], "top": [0.3, 0.4, 0.6]}
LIT = {
    "lamps": matte_room(),
    "sun and sky": matte_room(sun=SUN, background=GRADIENT),
    "image of the sky": under(
        random_sky(16, 8), sphere([-0.3, 0, -3], 1, "m"), plane([0, -1, 0], [0, 1, 0], "m")
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", LIT)
def test_direct_light_of_matte_surfaces_is_that_of_mis(context: Context, name: str) -> None:
    """With all that is hidden by rays, to the bit."""
    size: dict[str, Any] = {"width": 32, "height": 24, "sampler": "sobol"}
    effects = ("shadows", "ambient_occlusion")
    found = rendered(LIT[name], context, 32, **{**SMALL, **size}, effects=effects)
    truth = rendered(LIT[name], context, 32, **size, method="mis", bounces=1)
    assert same_bits(found.radiance, truth.radiance)
    assert same_bits(found.stderr, truth.stderr)


@pytest.mark.slow
def test_shadows_alone_are_the_direct_light_of_mis_without_a_sky(context: Context) -> None:
    size: dict[str, Any] = {"width": 32, "height": 24, "sampler": "sobol"}
    found = rendered(LIT["lamps"], context, 32, **{**SMALL, **size}, effects=("shadows",))
    truth = rendered(LIT["lamps"], context, 32, **size, method="mis", bounces=1)
    assert same_bits(found.radiance, truth.radiance)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["cornell", "spot", "painted", "courtyard", "frosted", "stage"])
def test_all_effects_are_ddgi(context: Context, name: str) -> None:
    """The first surface of a raster, and all that is traced, to the bit."""
    size: dict[str, Any] = {"width": 32, "height": 24, "bounces": 4, "sampler": "sobol"}
    found, truth = (
        rendered(load(name), context, 16, probes=2, method=method, **size)
        for method in ("hybrid", "ddgi")
    )
    assert same_bits(found.radiance, truth.radiance)
    assert found.radiance.mean() > 0.001


@pytest.mark.slow
def test_each_effect_changes_the_picture(context: Context) -> None:
    size: dict[str, Any] = {"width": 32, "height": 24, "bounces": 4, "sampler": "sobol"}
    sky = matte_room(background=GRADIENT).background
    scene = load("cornell").model_copy(update={"background": sky})
    whole = rendered(scene, context, 16, probes=2, method="hybrid", **size).radiance
    for effect in EFFECTS:
        rest = tuple(other for other in EFFECTS if other != effect)
        part = rendered(scene, context, 16, probes=2, method="hybrid", effects=rest, **size)
        assert not same_bits(part.radiance, whole), effect
        assert np.isfinite(part.radiance).all()


# --- plans, refusals and words -----------------------------------------------------------------


def test_effects_are_bits_of_one_number() -> None:
    every = Settings(method="hybrid")
    assert every.effects == EFFECTS
    assert effect_bits(every) == 63
    assert effect_bits(Settings(method="hybrid", effects=())) == EFFECT_BITS["BY_CHOICE"] == 32
    assert effect_bits(Settings(method="mis")) == 0
    wanted = settings_for(Settings(), method="hybrid", effects=("gi", "shadows"))
    assert wanted.effects == ("shadows", "gi")
    assert effect_bits(wanted) == 32 + EFFECT_BITS["SHADOWS"] + EFFECT_BITS["GI"]


@pytest.mark.parametrize(
    ("given", "effects"),
    [("all", EFFECTS), ("none", ()), (("none",), ()), (["gi"], ("gi",)), (("all",), EFFECTS)],
)
def test_all_and_none_are_names_of_effects(given: Any, effects: tuple[str, ...]) -> None:
    assert settings_for(Settings(), effects=given).effects == effects


def test_an_unknown_effect_is_refused_by_name() -> None:
    with pytest.raises(UsageError, match=r"effects must be 'shadows', .*got 'fog'"):
        settings_for(Settings(), effects=("shadows", "fog"))


def test_probes_and_weights_follow_the_effects() -> None:
    def traits(*effects: str) -> Any:
        return traits_of(settings_for(Settings(), method="hybrid", effects=effects))

    assert traits("gi").has_probes
    assert not traits("shadows").has_probes
    assert traits("shadows").weights_both
    assert not traits("gi").weights_both
    assert not traits("shadows").weighs_particles
    assert traits_of(Settings(method="mis", effects=("gi",))).has_probes is False


def test_a_lens_and_shared_places_are_traced() -> None:
    def rasters(scene: Scene, method: str = "hybrid") -> bool:
        return Case(SceneFacts(scene), settings_for(Settings(), method=method)).rasters

    lens = matte_room(camera={"defocus_angle": 1.0})
    shared = quad([-0.5, 1.5, -3], [1, 0, 0], [0, 0, 2], "matte")
    ceiling = scene_of([quad([-0.5, 1.5, -3], [1, 0, 0], [0, 0, 1], "lamp"), shared], MATERIALS)
    assert rasters(matte_room())
    assert not rasters(matte_room(), "ddgi")
    assert not rasters(lens)
    assert not rasters(ceiling)


def test_media_are_refused_by_name() -> None:
    settings = settings_for(load("fog").render, method="hybrid", effects=())
    with pytest.raises(UsageError, match=r"hybrid does not go with media \(.*a raster finds surf"):
        check_render(SceneFacts(load("fog")), settings, "none", False, False)


@pytest.mark.parametrize(
    ("effect", "told"),
    [
        ("shadows", "no shadows"),
        ("reflections", "mirrors and glass reflect nothing"),
        ("refractions", "glass shows nothing behind it"),
        ("ambient_occlusion", "nothing hides the sky"),
        ("gi", "no indirect light on matte surfaces"),
    ],
)
def test_what_an_effect_would_add_is_told(effect: str, told: str) -> None:
    objects = [sphere([0, 0, -3], 1, "matte"), sphere([2, 0, -3], 1, "glass")]
    objects += [sphere([0, 3, -3], 1, "lamp"), sphere([-3, 0, -3], 1, "mirror")]
    facts = SceneFacts(scene_of(objects, MATERIALS, background={"color": [SKY] * 3}))
    rest = tuple(other for other in EFFECTS if other != effect)
    whole = settings_for(Settings(), method="hybrid")
    part = settings_for(whole, effects=rest)
    assert told in omissions(facts, part)
    assert told not in omissions(facts, whole)
    assert "leaves light out" in left_out(part, [told])
    assert "blurs light" in left_out(whole, [told])
