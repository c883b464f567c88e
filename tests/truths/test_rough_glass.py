"""Rough glass in pictures: furnaces, methods that agree, and the smooth glass that it tends to."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.materials.facets import pane_loss
from tests.shaders.test_dielectric import fresnel64
from tests.support.builders import MATTE, box, glass, lamp, plane, quad, scene_of, sphere
from tests.support.renders import METHODS, assert_agree, assert_mean, rendered, whole

BALL = sphere([0, 0, 0], 1, "glass")
CAMERA = {"position": [0, 0, 4], "look_at": [0, 0, 0], "fov": 25}
SKY = {"color": [1.0] * 3}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("roughness", "ior"), [(0.2, 1.5), (0.6, 1.33), (1.0, 1.5), (0.7, 0.7)])
def test_a_ball_under_an_even_sky_cannot_be_seen(
    context: Context, method: str, roughness: float, ior: float
) -> None:
    """The furnace: what one surface loses, a path of 60 bounces loses again and again."""
    materials = {"glass": glass(ior, roughness=roughness)}
    scene = scene_of([BALL], materials, CAMERA, background=SKY)
    image = rendered(scene, context, 512, method=method, bounces=60)
    assert_mean(whole(image), 1, within=0.02, floor=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("roughness", "ior"), [(0.2, 1.5), (1.0, 2.4)])
def test_rough_panes_under_an_even_sky_cannot_be_seen(
    context: Context, method: str, roughness: float, ior: float
) -> None:
    """Two of them, between which light goes back and forth."""
    things = [quad([-1, -1, z], [2, 0, 0], [0, 2, 0], "pane") for z in (0, 1)]
    camera = {"position": [1, 1, 4], "look_at": [0, 0, 0], "fov": 40}
    materials = {"pane": glass(ior, roughness=roughness, thin=True)}
    scene = scene_of(things, materials, camera, background=SKY)
    image = rendered(scene, context, 512, method=method, bounces=60)
    assert_mean(whole(image), 1, within=0.01, floor=1e-3)


@pytest.mark.slow_cases("thin pane")
@pytest.mark.parametrize("things", ["slab", "thin pane", "ball around a lamp", "box beside a lamp"])
def test_methods_agree_on_light_through_rough_glass(context: Context, things: str) -> None:
    frosted = glass(1.5, roughness=0.5)
    materials = {"glass": frosted, "lamp": lamp(6.0), "floor": MATTE}
    materials["thin"] = {**frosted, "thin": True}
    floor = plane([0, -1.2, 0], [0, 1, 0], "floor")
    around = {
        "slab": [box([-1, -1, 0.5], [1, 1, 0.7], "glass"), sphere([0.3, 0.2, -0.5], 0.4, "lamp")],
        "thin pane": [
            quad([-1, -1, 0.6], [2, 0, 0], [0, 2, 0], "thin"),
            sphere([0.3, 0.2, -0.5], 0.4, "lamp"),
        ],
        "ball around a lamp": [BALL, sphere([0.1, 0.2, 0], 0.3, "lamp")],
        "box beside a lamp": [
            box([-0.8, -1.1, -0.8], [0.8, 0.6, 0.8], "glass"),
            quad([-1, 1.5, -1], [2, 0, 0], [0, 0, 2], "lamp"),
        ],
    }[things]
    scene = scene_of([floor, *around], materials, {**CAMERA, "fov": 40}, background=SKY)
    naive, nee, mis = (
        rendered(scene, context, 1024, method=method, bounces=5, seed=seed)
        for seed, method in enumerate(METHODS)
    )
    for other in (nee, mis):
        assert_agree(other, naive, within=0.05)


def test_nearly_smooth_glass_looks_smooth(context: Context) -> None:
    """At roughness 0.001 the lobe is far narrower than a pixel; at 1e-5 it is a delta."""
    pictures = [
        rendered(
            scene_of(
                [BALL, plane([0, -1, 0], [0, 1, 0], "floor")],
                {"glass": glass(1.5, roughness=roughness), "floor": MATTE},
                CAMERA,
                background={"bottom": [0.1] * 3, "top": [1.0] * 3},
            ),
            context, 256, bounces=6,
        ).radiance
        for roughness in (0.0, 1e-5, 1e-3)
    ]  # fmt: skip
    smooth, delta, narrow = pictures
    assert np.array_equal(smooth, delta)
    assert_allclose(narrow.mean(axis=(0, 1)), smooth.mean(axis=(0, 1)), rtol=4e-3)


@pytest.mark.slow
def test_a_nearly_smooth_pane_shows_what_a_smooth_one_shows(context: Context) -> None:
    sky = {"bottom": [0.1] * 3, "top": [1.0] * 3}
    things = [quad([-1, -1, 0], [2, 0, 0], [0, 2, 0], "pane"), plane([0, -1, 0], [0, 1, 0], "f")]
    smooth, delta, narrow = (
        rendered(
            scene_of(
                things,
                {"pane": glass(1.5, roughness=roughness, thin=True), "f": MATTE},
                {**CAMERA, "position": [1, 0.5, 4]},
                background=sky,
            ),
            context, 256, bounces=6,
        ).radiance
        for roughness in (0.0, 1e-5, 1e-3)
    )  # fmt: skip
    assert np.array_equal(smooth, delta)
    assert_allclose(narrow.mean(axis=(0, 1)), smooth.mean(axis=(0, 1)), rtol=4e-3)


def test_the_sun_shines_through_a_rough_pane(context: Context) -> None:
    """The camera sees the far side of a pane of alpha 0.64: (1 - R) D G2 / (4 cos) E.

    R is 2 F / (1 + F) at the facet. The light that facets lose to each other is added by the
    albedos of white facets, in float64.
    """
    towards = np.array([0.0, 0.6, 0.8])
    sun = {"direction": towards.tolist(), "irradiance": [2.0] * 3, "angle": 0.001}
    camera = {"position": [0, -1, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 0.01}
    materials = {"pane": glass(1.5, roughness=0.8, thin=True)}
    things = [quad([-9, 0, -9], [18, 0, 0], [0, 0, 18], "pane")]
    scene = scene_of(things, materials, camera, sun=sun)
    found = rendered(scene, context, 16, width=8, height=8).radiance
    alpha, cos_i = 0.64, 0.6
    half = np.array([0.0, 1.0, 0.0]) + towards
    half /= np.linalg.norm(half)
    face = float(fresnel64(np.array([half[1]]), 1 / 1.5)[0])
    d = alpha**2 / (np.pi * (1 + (alpha**2 - 1) * half[1] ** 2) ** 2)
    shadow = (np.sqrt(1 + alpha**2 * (1 - cos_i**2) / cos_i**2) - 1) / 2
    facets = (1 - 2 * face / (1 + face)) * d / (1 + shadow) / (4 * cos_i)
    loss = pane_loss(alpha, 1.5)
    assert loss is not None
    straight, slanted = 1 - np.interp([1.0, cos_i**0.5], np.linspace(0, 1, 65), loss.albedos[0])
    again = loss.crossing[0] * straight * slanted / (np.pi * loss.means[0])
    expected = (facets + again) * cos_i * 2.0
    assert_allclose(found, np.full_like(found, expected), rtol=1e-3)


def test_glass_of_index_1_is_not_there_however_rough(context: Context) -> None:
    materials: dict[str, Any] = {"glass": glass(1.0, roughness=0.7), "floor": MATTE}
    floor = plane([0, -1.2, 0], [0, 1, 0], "floor")
    with_ball, alone = (
        rendered(scene_of(things, materials, CAMERA, background=SKY), context, 64, bounces=8)
        for things in ([floor, BALL], [floor])
    )
    assert_allclose(with_ball.radiance.mean(), alone.radiance.mean(), rtol=2e-3)
