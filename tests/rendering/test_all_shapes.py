"""Disks, boxes and cylinders, in every pipeline, tier and method."""

from typing import Any, get_args

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.rendering.passes import Resolved
from glrt.rendering.pipelines import Tier
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, box, cylinder, disk, glass, lamp, plane, scene_of
from tests.support.renders import assert_agree, rendered

MATERIALS: dict[str, dict[str, Any]] = {
    "white": MATTE,
    "brass": {"type": "metal", "color": [0.9, 0.7, 0.3], "roughness": 0.4},
    "glass": glass(),
    "lamp": lamp(6.0),
    "dim": lamp(0.5, 0.3),
}
SKY = {"bottom": [0.1, 0.1, 0.2], "horizon": [0.5, 0.4, 0.3], "top": [0.3, 0.4, 0.6]}
THINGS = {
    "disk": disk([0, 0, -3], [0.3, 1, 0.5], 0.8, "white"),
    "box": box([-0.6, -0.5, -3.5], [0.5, 0.4, -2.6], "white", [20, 30, 0]),
    "cylinder": cylinder([-0.5, -0.4, -3], [0.4, 0.5, -2.8], 0.5, "white"),
}


def everything() -> Scene:
    """Disks, boxes and cylinders of several materials over a plane, and a round lamp."""
    objects = [
        plane([0, -1, 0], [0, 1, 0], "white"),
        disk([0.2, 1.1, -3], [0.1, 1, 0], 0.5, "lamp"),
        disk([0.9, -0.3, -3.4], [-1, 0.2, 0.7], 0.5, "brass"),
        box([-1, -0.9, -3.6], [-0.4, 0.1, -3], "glass", [0, 25, 5]),
        box([0.5, -0.9, -2.6], [0.8, -0.6, -2.3], "dim"),
        cylinder([-0.1, -0.9, -2.4], [-0.1, -0.4, -2.4], 0.25, "glass"),
        cylinder([0.1, -0.9, -4], [0.3, 0.2, -4], 0.3, "brass", capped=False),
    ]
    return scene_of(objects, MATERIALS, {"defocus_angle": 1.0}, background=SKY)


@pytest.mark.slow_cases("baked")
@pytest.mark.parametrize("tier", get_args(Tier))
def test_every_pipeline_and_tier_has_the_same_bits(context: Context, tier: Tier) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    assert bits(context, "compute", tier) == bits(context, "compute", "complete")
    assert bits(context, "fragment", tier) == bits(context, "compute", "complete")


def bits(context: Context, pipeline: Resolved, tier: Tier) -> bytes:
    """Mean and error after an observation and a sample."""
    size: dict[str, Any] = {"width": 19, "height": 13, "bounces": 6}
    renderer = Renderer(everything(), context=context, pipeline=pipeline, tier=tier, **size)
    image = renderer.render(renderer.settings.block + 1).image()
    renderer.release()
    assert image.radiance.std() > 0.1
    return image.radiance.tobytes() + image.stderr.tobytes()


@pytest.mark.parametrize("shape", THINGS)
@pytest.mark.parametrize("method", ["nee", "phong", "cook"])
def test_methods_agree_on_what_the_sky_lights(context: Context, method: str, shape: str) -> None:
    """Nothing convex hides the sky from itself: the models are exact, too."""
    scene = scene_of([THINGS[shape]], MATERIALS, {"fov": 36}, background=SKY)
    model = rendered(scene, context, 16, method=method, width=32, height=32, bounces=1)
    truth = rendered(scene, context, 32, method="mis", seed=1, width=32, height=32, bounces=1)
    assert_agree(model, truth, within=0.02)


def test_cook_lights_a_floor_by_a_round_lamp_as_in_truth(context: Context) -> None:
    things = [plane([0, -1, 0], [0, 1, 0], "white"), disk([0.2, 1, -3], [0.5, 1, 0], 0.5, "lamp")]
    scene = scene_of([*things, THINGS["box"]], MATERIALS)
    size: dict[str, Any] = {"width": 32, "height": 32, "bounces": 1}
    model = rendered(scene, context, 64, method="cook", **size)
    truth = rendered(scene, context, 64, method="mis", seed=1, **size)
    assert_agree(model, truth, within=0.06)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["phong", "whitted"])
def test_models_see_the_same_surfaces(context: Context, method: str) -> None:
    scene = everything()
    sharp = scene.model_copy(
        update={"camera": scene.camera.model_copy(update={"defocus_angle": 0.0})}
    )
    size: dict[str, Any] = {"width": 24, "height": 24, "bounces": 0}
    seen, truth = (rendered(sharp, context, 2, method=m, **size) for m in (method, "mis"))
    assert (seen.radiance == truth.radiance).all()


@pytest.mark.slow
@pytest.mark.parametrize("material", ["white", "mirror", "glass"])
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("shape", ["box", "cylinder"])
def test_nothing_leaks_out_of_tens_of_millions_of_segments(
    context: Context, shape: str, seed: int, material: str
) -> None:
    """A room around the camera; from a room of glass, light comes as from all around."""
    draw = np.random.default_rng(seed)
    high = draw.uniform(0.3, 3, 3)
    low = -0.9 * high
    room = box(low, high, material, draw.uniform(-180, 180, 3))
    if shape == "cylinder":
        room = cylinder(0.1 * low, 0.1 * low + high, 4.0, material)
        room["from"] = list(0.1 * low - high)
    materials = {
        "white": {"type": "lambertian", "color": [1, 1, 1]},
        "mirror": {"type": "metal", "color": [1, 1, 1]},
        "glass": glass(),
    }
    sky = {"color": [1e6] * 3}
    scene = scene_of([room], materials, {"fov": 120}, background=sky)
    image = rendered(scene, context, 64, bounces=100, roulette=False, width=64, height=64)
    if material == "glass":
        assert image.radiance.max() <= 2.25e6 * (1 + 1e-4)
    else:
        assert image.radiance.max() == 0
