"""The lighting models before path tracing: what each sees, and what it leaves out."""

import math
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.gpu.glsl import read
from glrt.gpu.structs import read_constants
from glrt.image.sources import load
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.plan.methods import CLASSIC, METHODS
from glrt.rendering.pipelines import Tier
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.conftest import CallGlsl
from tests.support.builders import box_of_quads, disk, glass, lamp, plane, quad, scene_of, sphere
from tests.support.images import same_bits
from tests.support.renders import assert_agree, rendered

ALBEDO, RADIANCE = 0.6, 7.0
MATERIALS: dict[str, dict[str, Any]] = {
    "matte": {"type": "lambertian", "color": [ALBEDO] * 3},
    "lamp": lamp(RADIANCE),
    "mirror": {"type": "metal", "color": [0.9, 0.8, 0.7]},
    "rough": {"type": "metal", "color": [0.9, 0.8, 0.7], "roughness": 0.5},
    "glass": glass(),
}
FLOOR = plane([0, 0, 0], [0, 1, 0], "matte")
LAMPS = {
    "sphere": sphere([0.5, 2.0, 0.3], 0.2, "lamp"),
    "quad": quad([0.2, 2.0, 0.1], [0.6, 0, 0], [0, 0.3, 0.4], "lamp"),
    "disk": disk([0.4, 2.0, 0.2], [0.3, 1, 0.2], 0.3, "lamp"),
}
DOWN = {"position": [0, 1, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 0.01}
MODELS = tuple(CLASSIC)
SHADOW = quad([0.1, 1.0, 0.0], [0.3, 0, 0], [0, 0, 0.3], "matte")


def seen_from_above(objects: list[dict[str, Any]], context: Context, **settings: Any) -> float:
    """Radiance of the floor in the origin."""
    scene = scene_of(objects, MATERIALS, DOWN)
    image = rendered(scene, context, settings.pop("samples", 1), width=8, height=8, **settings)
    return float(image.radiance.mean())


def everything() -> Scene:
    """Every material, both kinds of lamps, a lens and a sky."""
    balls = [
        sphere([x, -0.5, -4], 0.5, material)
        for x, material in zip(
            (-1.5, -0.4, 0.7, 1.8), ("matte", "mirror", "rough", "glass"), strict=True
        )
    ]
    lamps = [sphere([1, 2, -4], 0.4, "lamp"), quad([-1, 2, -4], [1, 0, 0], [0, 0, 1], "lamp")]
    floor = plane([0, -1, 0], [0, 1, 0], "matte")
    sky = {"bottom": [0.1, 0.1, 0.1], "top": [0.3, 0.4, 0.6]}
    return scene_of([floor, *balls, *lamps], MATERIALS, {"defocus_angle": 1.0}, background=sky)


def test_models_have_the_same_numbers_in_python_and_glsl() -> None:
    constants = read_constants(read("integrators/classic.glsl"))
    assert all(constants[name.upper()] == METHODS[name].model for name in CLASSIC)


# --- light ---------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", LAMPS)
@pytest.mark.parametrize("method", ["phong", "blinn", "whitted"])
def test_a_lamp_lights_from_its_center_with_all_its_power(
    context: Context, kind: str, method: str
) -> None:
    """a / PI x Le x area across x cos / d^2, the lamp seen from the origin."""
    if kind == "sphere":
        to_lamp = np.array([0.5, 2.0, 0.3])
        across = math.pi * 0.2**2
    elif kind == "disk":
        to_lamp = np.array([0.4, 2.0, 0.2])
        facing = np.array([0.3, 1, 0.2]) / np.linalg.norm([0.3, 1, 0.2])
        across = math.pi * 0.3**2 * abs(facing @ to_lamp) / np.linalg.norm(to_lamp)
    else:
        to_lamp = np.array([0.5, 2.15, 0.3])
        across = abs(np.cross([0.6, 0, 0], [0, 0.3, 0.4]) @ to_lamp) / np.linalg.norm(to_lamp)
    distance = float(np.linalg.norm(to_lamp))
    irradiance = RADIANCE * across * (to_lamp[1] / distance) / distance**2
    seen = seen_from_above([FLOOR, LAMPS[kind]], context, method=method)
    assert seen == pytest.approx(ALBEDO / math.pi * irradiance, rel=1e-4)


def test_lamps_add_up(context: Context) -> None:
    alone = [seen_from_above([FLOOR, LAMPS[kind]], context, method="phong") for kind in LAMPS]
    both = seen_from_above([FLOOR, *LAMPS.values()], context, method="phong")
    assert both == pytest.approx(sum(alone), rel=1e-6)


def test_shadows_are_none_then_hard_then_soft(context: Context) -> None:
    """Half of the lamp is hidden, its centre among that."""
    objects = [FLOOR, quad([0, 2, 0], [0.4, 0, 0], [0, 0, 0.4], "lamp")]
    hidden = [*objects, quad([0.02, 1, -1], [5, 0, 0], [0, 0, 5], "matte")]
    camera = {"position": [-0.05, 0.5, 0.1], "look_at": [0, 0, 0.1], "up": [0, 0, 1], "fov": 0.01}

    def seen(things: list[dict[str, Any]], method: str) -> float:
        scene = scene_of(things, MATERIALS, camera)
        return float(rendered(scene, context, 256, method=method).radiance.mean())

    assert seen(hidden, "phong") == seen(objects, "phong") > 0
    assert seen(objects, "whitted") == seen(objects, "phong")
    assert seen(hidden, "whitted") == 0
    share = seen(hidden, "cook") / seen(objects, "cook")
    assert 0.02 < share < 0.98


@pytest.mark.slow
def test_a_ball_under_the_sky_is_lit_as_in_truth(context: Context) -> None:
    """Nothing hides the sky from it: the ambient light of the models is then exact."""
    sky = {"bottom": [0.2, 0.5, 0.1], "top": [1.0, 0.4, 3.0]}
    ball = scene_of([sphere([0, 0, -3], 1, "matte")], MATERIALS, {"fov": 36}, background=sky)
    for method in MODELS:
        model = rendered(ball, context, 64, method=method, width=32, height=32)
        truth = rendered(ball, context, 256, method="mis", seed=1, width=32, height=32)
        assert_agree(model, truth, within=0.02)


@pytest.mark.slow_cases("cook", "whitted_tree")
@pytest.mark.parametrize("method", MODELS)
def test_without_bounces_only_emitters_are_seen(context: Context, method: str) -> None:
    scene = everything()
    settings = {"bounces": 0, "width": 32, "height": 32}
    lens = scene.camera.model_copy(update={"defocus_angle": 0.0})
    sharp = scene.model_copy(update={"camera": lens})
    model = rendered(sharp, context, 2, method=method, **settings)
    assert same_bits(model.radiance, rendered(sharp, context, 2, method="mis", **settings).radiance)


# --- mirrors and glass ---------------------------------------------------------------------


def test_local_models_see_neither_mirrors_nor_glass(context: Context) -> None:
    for method in ("phong", "blinn"):
        for material in ("mirror", "glass"):
            floor = plane([0, 0, 0], [0, 1, 0], material)
            assert seen_from_above([floor, *LAMPS.values()], context, method=method) == 0


@pytest.mark.slow
@pytest.mark.parametrize("method", ["whitted", "cook"])
def test_a_mirror_shows_what_a_mirrored_camera_sees(context: Context, method: str) -> None:
    things = [sphere([0.4, 0.3, 1], 0.5, "matte"), sphere([0, 2, 2], 0.3, "lamp")]
    white = {**MATERIALS, "mirror": {"type": "metal", "color": [1, 1, 1]}}
    mirror = plane([0, 0, -2], [0, 0, 1], "mirror")
    size: dict[str, Any] = {"width": 32, "height": 32, "method": method}
    through = rendered(scene_of([*things, mirror], white), context, 512, **size)
    camera = {"position": [0, 0, -4], "look_at": [0, 0, 1]}
    direct = rendered(scene_of(things, white, camera), context, 512, seed=1, **size)
    turned = type(direct)(
        np.ascontiguousarray(direct.radiance[:, ::-1]),
        np.ascontiguousarray(direct.stderr[:, ::-1]),
        direct.samples,
    )
    assert_agree(through, turned, within=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["whitted", "cook"])
def test_glass_of_index_one_is_invisible_to_the_eye(context: Context, method: str) -> None:
    sky = {"bottom": [0.2, 0.5, 0.1], "top": [1.0, 0.4, 3.0]}
    clear = {**MATERIALS, "glass": glass(1.0)}
    ball = sphere([0, 0, -5], 1, "matte")
    scenes = [
        scene_of(things, clear, background=sky)
        for things in ([ball], [ball, sphere([0.3, 0, -2], 0.4, "glass")])
    ]
    with_glass, without = (
        rendered(s, context, 1, method=method, width=32, height=32).radiance for s in scenes
    )
    close = np.isclose(with_glass, without, rtol=1e-3).all(axis=2)
    assert close.mean() > 0.99, "all but rays that meet the rim of the ball behind"


@pytest.mark.slow
def test_glass_throws_a_shadow_and_no_caustic(context: Context) -> None:
    pane = sphere([0.25, 1.0, 0.15], 0.2, "glass")
    for method in ("whitted", "cook"):
        seen = seen_from_above([FLOOR, LAMPS["sphere"], pane], context, method=method, samples=64)
        assert seen == 0, "the ball hides all of the lamp"


# --- cook is what it is made of --------------------------------------------------------------


@pytest.mark.slow
def test_cook_is_one_bounce_of_light_sampling_on_matte_surfaces(context: Context) -> None:
    scene = scene_of([*box_of_quads("matte", 3), *LAMPS.values(), SHADOW], MATERIALS)
    settings: dict[str, Any] = {"bounces": 1, "width": 32, "height": 32}
    cook = rendered(scene, context, 4, method="cook", **settings)
    nee = rendered(scene, context, 4, method="nee", **settings)
    assert same_bits(cook.radiance, nee.radiance)


@pytest.mark.slow
def test_cook_is_path_tracing_on_metal(context: Context) -> None:
    things = [sphere([-0.5, 0, -3], 0.5, "rough"), sphere([0.6, 0, -3], 0.5, "mirror")]
    scene = scene_of([*things, sphere([0, 2, -2], 0.8, "lamp")], MATERIALS, {"defocus_angle": 2.0})
    cook = rendered(scene, context, 4, method="cook", width=32, height=32)
    naive = rendered(scene, context, 4, method="naive", width=32, height=32)
    assert same_bits(cook.radiance, naive.radiance)


# --- the kernel ----------------------------------------------------------------------------


@pytest.mark.parametrize("method", MODELS)
def test_a_kernel_has_nothing_that_its_model_cannot_see(method: str) -> None:
    scene = everything()
    needs = needs_of(SceneFacts(scene), settings_for(scene.render, method=method))
    local = method in ("phong", "blinn")
    assert needs.model == METHODS[method].model
    assert ("dielectric" in needs.materials, needs.has_mirror) == (not local,) * 2
    assert needs.roulette == (method in ("whitted", "cook"))
    assert needs.has_lens == (method == "cook")
    assert needs.has_rough_metal == METHODS[method].has_rough
    assert needs.lamps == {"sphere", "quad"}
    assert not needs.sample_lights
    assert not needs.weight_both


@pytest.mark.slow_cases("blinn", "cook", "whitted_tree")
@pytest.mark.parametrize("method", MODELS)
def test_models_give_the_same_bits_in_every_tier(context: Context, method: str) -> None:
    scene = everything()
    tiers: tuple[Tier, ...] = ("generic", "complete")
    pictures = [
        rendered(scene, context, 4, method=method, width=32, height=32, tier=tier).radiance
        for tier in tiers
    ]
    assert same_bits(pictures[0], pictures[1])
    assert pictures[0].mean() > 0.05


@pytest.mark.slow_cases("blinn", "whitted", "cook", "whitted_tree")
@pytest.mark.parametrize("method", MODELS)
def test_models_render_the_scenes_that_come_with_glrt(context: Context, method: str) -> None:
    for name in ("cornell", "metals", "lens"):
        picture = rendered(load(name), context, 4, method=method, width=24, height=16)
        assert picture.radiance.mean() > 0.05


@pytest.mark.slow
@pytest.mark.parametrize("model", [1, 2])
def test_a_loop_that_a_driver_cuts_is_noticed(
    call_glsl: CallGlsl, context: Context, model: int
) -> None:
    """The loop over a model's lamps, or the one of the power in it: the path ends there."""
    if not context.is_software:
        pytest.skip("this machine renders on hardware")
    lamps = [sphere([0.1 * i, 2, 0], 0.01, "lamp") for i in range(20)]
    scene = scene_of(lamps, {"lamp": lamp(1.0)})
    shaded = """
        Ray from = Ray(vec3(0.0, 0.1 * float(x & 1u), 0.0), vec3(0.0, -1.0, 0.0), NO_SHAPE, false);
        mat3 around = frame_around(vec3(0.0, 1.0, 0.0));
        Vertex vertex = vertex_of(around, vec3(0.0, 0.0, 1.0), material_at(0), true);
        Sampler rng = make_sampler(x);
        Path path = start_path(from);
        shade(path, vertex, from, rng);"""
    used_up = "for (int k = 0; k < 100000; ++k) x = pcg_hash(x + uint(k));"
    power = "float p = whole_power(0.5, 9 + int(x & 1u));"
    for body, value in ((shaded, "path.radiance.x"), (power, "p")):
        for before, is_cut in (("", 0.0), (used_up, 1.0)):
            found = call_glsl(
                f"vec2({value}, loop_was_cut ? 1.0 : 0.0)",
                "vec2",
                setup=f"loop_was_cut = false; uint x = 7u; {before} {body}",
                scene=scene,
                constants={"MODEL": model, "HAS_SPHERE_LIGHT": True, "LAMP_KINDS": 1},
            )[0]
            assert found[1] == is_cut
