"""Rough glasses that overlap by priority: against one glass, a furnace, and refusals."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from tests.support.builders import MATTE, box, glass, lamp, scene_of, sphere
from tests.support.renders import METHODS, assert_mean, rendered, whole


@pytest.mark.parametrize("roughness", [0.3, 0.9])
def test_rough_glass_in_water_is_one_of_their_ratio(context: Context, roughness: float) -> None:
    """In a room full of water, a ball of 1.5 in 1.33; without water, one of 1.5 / 1.33."""
    room = box([-2, -1.2, -2], [2, 2, 5.5], "wall")
    things = [room, sphere([0, 0, 0], 1, "glass"), sphere([1.2, 1.2, 1], 0.4, "lamp")]
    lit = {"wall": MATTE, "lamp": lamp(4.0)}
    camera = {"position": [0, 0.3, 4], "look_at": [0, 0, 0], "fov": 40}
    full = {
        "glass": glass(1.5, roughness=roughness, priority=2),
        "water": glass(1.33, priority=1),
    }
    flooded = scene_of([*things, sphere([0, 0, 1], 20, "water")], lit | full, camera)
    dry = scene_of(things, lit | {"glass": glass(1.5 / 1.33, roughness=roughness)}, camera)
    first, second = (rendered(scene, context, 64, bounces=6) for scene in (flooded, dry))
    close = np.isclose(first.radiance, second.radiance, rtol=1e-3).all(axis=-1)
    assert close.mean() > 0.99  # the rest: rays that rounding sends another way


@pytest.mark.slow
@pytest.mark.parametrize("around", ["water", "air"])
def test_rough_glass_in_its_own_index_is_not_there(context: Context, around: str) -> None:
    """Each pixel shows the lamp around it, without noise: no light is reflected or lost."""
    ior = 1.33 if around == "water" else 1.0
    things = [sphere([0, 0, 0], 1, "ball"), box([-5, -5, -5], [5, 5, 5], "lamp")]
    things += [sphere([0, 0, 0], 20, "water")] if around == "water" else []
    materials = {
        "ball": glass(ior, roughness=0.7, priority=2),
        "water": glass(1.33, priority=1),
        "lamp": lamp(1.0),
    }
    camera = {"position": [0, 0, 4], "look_at": [0, 0, 0], "fov": 40}
    found = rendered(scene_of(things, materials, camera), context, 16, bounces=4).radiance
    assert_allclose(found, np.ones_like(found), rtol=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_rough_glasses_that_overlap_vanish_in_even_light(context: Context, method: str) -> None:
    """The furnace: ice in water in a bowl of glass, all of them rough."""
    things = [
        sphere([0, 0, 0], 1.2, "bowl"),
        sphere([0, 0, 0], 1.0, "water"),
        sphere([0.8, 0.2, 0.3], 0.5, "ice"),
    ]
    materials = {
        "bowl": glass(1.5, roughness=0.7, priority=1),
        "water": glass(1.33, roughness=0.4, priority=2),
        "ice": glass(1.8, roughness=0.9, priority=3),
    }
    camera = {"position": [0.5, 0.5, 5], "look_at": [0, 0, 0], "fov": 30}
    scene = scene_of(things, materials, camera, background={"color": [1.0] * 3})
    image = rendered(scene, context, 512, method=method, bounces=100)
    assert_mean(whole(image), 1, within=0.02, floor=2e-3)


def test_rough_glass_with_a_priority_and_a_medium_is_refused() -> None:
    fog = {"fog": {"scattering": [0.1] * 3}}
    materials = {"glass": glass(1.5, roughness=0.3, priority=1)}
    with pytest.raises(SceneError, match="rough glass is not supported in a scene with media"):
        scene_of([sphere([0, 0, 0], 1, "glass")], materials, media=fog, medium="fog")
