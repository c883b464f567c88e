"""Changes of a scene under which its picture keeps every bit, or changes in a known way."""

from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.plan.methods import CLASSIC
from glrt.scene.scene import Scene, with_lights
from tests.support.builders import box, cylinder, disk, lamp, plane, quad, scene_of, sphere
from tests.support.images import same_bits
from tests.support.mixed_scene import MATERIALS, SKY
from tests.support.renders import METHODS, rendered, same

SMALL = {"width": 24, "height": 24}


def mixture(scale: float = 1.0, offset: tuple[float, float, float] = (0, 0, 0)) -> Scene:
    """Every shape and material, with coordinates that float64 holds exactly, scaled and moved."""

    def at(*point: float) -> list[float]:
        return [scale * (c + o) for c, o in zip(point, offset, strict=True)]

    def along(*edge: float) -> list[float]:
        return [scale * c for c in edge]

    objects = [
        plane(at(0, -1, 0), [0, 1, 0], "white"),
        plane(at(0, 0, -3), [0.25, 0.125, 1], "red"),
        sphere(at(-0.625, -0.375, 0), scale * 0.625, "glass"),
        sphere(at(0.75, -0.5, 0.25), scale * 0.5, "brass"),
        sphere(at(0.25, 0.875, 0.25), scale * 0.1875, "lamp"),
        quad(at(-2, 2, -2), along(4, 0, 0), along(0, 0.25, 2), "lamp"),
        disk(at(1.25, 0.5, -0.5), [0.5, 0.25, 1], scale * 0.375, "lamp"),
        box(at(-1.5, -0.875, -1.5), at(-1, 0.5, -0.75), "glass", [0, 30, 10]),
        box(at(1, -0.875, -2), at(1.5, 0.25, -1.5), "brass"),
        cylinder(at(-0.25, -0.875, 0.75), at(0, -0.5, 1), scale * 0.25, "glass"),
        cylinder(at(1.5, 0, 0), at(1.75, 1, 0), scale * 0.25, "red", capped=False),
    ]
    eye = {"position": at(0.125, 0.25, 3.0), "look_at": at(0, 0, 0.125)}
    lens = {"defocus_angle": 3.0, "focus_distance": scale * 2.5}
    return scene_of(objects, MATERIALS, {**eye, **lens}, background=SKY)


@pytest.mark.slow
@pytest.mark.parametrize("method", [*METHODS, *CLASSIC])
def test_scene_scaled_by_a_power_of_two_keeps_its_bits(context: Context, method: str) -> None:
    expected = rendered(mixture(), context, 4, method=method, **SMALL)
    for power in range(-10, 11):
        image = rendered(mixture(2.0**power), context, 4, method=method, **SMALL)
        assert same(image, expected), power


@pytest.mark.parametrize("method", METHODS)
def test_scene_far_from_the_origin_keeps_its_bits(context: Context, method: str) -> None:
    expected = rendered(mixture(), context, 4, method=method, **SMALL)
    for offset in [(2.0**20, 0, 0), (-(2.0**20), 2.0**19, 2.0**20), (0, 3.0**12, -(2.0**30))]:
        image = rendered(mixture(1.0, offset), context, 4, method=method, **SMALL)
        assert same(image, expected), offset


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("factor", [2.0, 0.25, 1024.0])
def test_lamp_of_twice_the_light_doubles_every_pixel(
    context: Context, factor: float, method: str
) -> None:
    scene = load("cornell")
    single = rendered(scene, context, 8, method=method, **SMALL)
    relit = rendered(with_lights(scene, {"lamp": factor}), context, 8, method=method, **SMALL)
    assert same_bits(relit.radiance, single.radiance * np.float32(factor))
    assert same_bits(relit.stderr, single.stderr * np.float32(factor))


def test_emission_and_intensity_are_one_factor(context: Context) -> None:
    """Two lamps of one group, and a sky dimmed alike: their shares stay as they are."""
    objects = [plane([0, -1, 0], [0, 1, 0], "white"), sphere([0, 1, -3], 0.3, "lamp")]
    objects += [quad([-1, 2, -4], [2, 0, 0], [0, 0, 1], "lamp")]
    sky = {"bottom": [0.25, 0.5, 1.0], "top": [1.0, 1.0, 0.5]}
    doubled_sky = {key: [2 * c for c in color] for key, color in sky.items()}
    white = MATERIALS["white"]
    once = scene_of(objects, {"white": white, "lamp": lamp(3.0)}, background=sky)
    twice = scene_of(objects, {"white": white, "lamp": lamp(6.0)}, background=doubled_sky)
    dimmed = with_lights(once, {"lamp": 2.0, "background": 2.0})
    single = rendered(once, context, 4)
    for scene in (twice, dimmed):
        assert same_bits(rendered(scene, context, 4).radiance, 2 * single.radiance)


@pytest.mark.parametrize("method", METHODS)
def test_grey_scene_is_grey_to_the_last_bit(context: Context, method: str) -> None:
    grey = {name: _with_channels(m, [0, 0, 0]) for name, m in MATERIALS.items()}
    sky = {key: [color[0]] * 3 for key, color in SKY.items()}
    scene = recolored(mixture(), grey, sky)
    image = rendered(scene, context, 8, method=method, **SMALL)
    for channel in (1, 2):
        assert np.array_equal(image.radiance[..., channel], image.radiance[..., 0])
    assert image.radiance.std() > 0.1


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("order", [[1, 2, 0], [2, 1, 0]])
def test_channels_change_places_with_those_of_the_materials(
    context: Context, order: list[int], method: str
) -> None:
    colors = {**MATERIALS, "lamp": {"type": "light", "emission": [4, 6, 8]}}
    permuted = {name: _with_channels(m, order) for name, m in colors.items()}
    sky = {key: [color[i] for i in order] for key, color in SKY.items()}
    plain = rendered(recolored(mixture(), colors, SKY), context, 8, method=method, **SMALL)
    image = rendered(recolored(mixture(), permuted, sky), context, 8, method=method, **SMALL)
    assert np.array_equal(image.radiance, plain.radiance[..., order])
    assert not np.array_equal(image.radiance, plain.radiance)


def recolored(scene: Scene, materials: dict[str, Any], sky: dict[str, Any]) -> Scene:
    table = scene.model_dump(mode="json", exclude_none=True)
    table["camera"].pop("up")
    objects, camera = table["objects"], table["camera"]
    return scene_of(objects, materials, camera, background=sky)


def _with_channels(material: dict[str, Any], order: list[int]) -> dict[str, Any]:
    vectors = {key: value for key, value in material.items() if isinstance(value, list)}
    return {**material, **{key: [value[i] for i in order] for key, value in vectors.items()}}


def test_order_of_objects_changes_numbers_but_no_light(context: Context) -> None:
    """No two are hit at the same distance, and without light sampling no lamp is drawn."""
    scene = mixture()
    turned = scene.model_copy(update={"objects": tuple(reversed(scene.objects))})
    a, b = (rendered(s, context, 8, method="naive", **SMALL) for s in (scene, turned))
    assert same(a, b)
