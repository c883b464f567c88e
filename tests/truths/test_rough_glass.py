"""Rough glass in pictures: furnaces, methods that agree, and the smooth glass that it tends to."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
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


@pytest.mark.parametrize("things", ["pane", "ball around a lamp", "box beside a lamp"])
def test_methods_agree_on_light_through_rough_glass(context: Context, things: str) -> None:
    frosted = glass(1.5, roughness=0.5)
    materials = {"glass": frosted, "lamp": lamp(6.0), "floor": MATTE}
    floor = plane([0, -1.2, 0], [0, 1, 0], "floor")
    around = {
        "pane": [box([-1, -1, 0.5], [1, 1, 0.7], "glass"), sphere([0.3, 0.2, -0.5], 0.4, "lamp")],
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


def test_glass_of_index_1_is_not_there_however_rough(context: Context) -> None:
    materials: dict[str, Any] = {"glass": glass(1.0, roughness=0.7), "floor": MATTE}
    floor = plane([0, -1.2, 0], [0, 1, 0], "floor")
    with_ball, alone = (
        rendered(scene_of(things, materials, CAMERA, background=SKY), context, 64, bounces=8)
        for things in ([floor, BALL], [floor])
    )
    assert_allclose(with_ball.radiance.mean(), alone.radiance.mean(), rtol=2e-3)
