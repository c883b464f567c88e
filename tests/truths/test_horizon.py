"""A background of two gradients, one on either side of the horizon."""

import math
from typing import Any

import numpy as np
import pytest

from glrt.analysis.reference import closed_form
from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.plan.methods import CLASSIC
from glrt.plan.plan import prepare
from glrt.scene.scene import Scene, with_lights
from glrt.settings import Settings
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, plane, scene_of, sphere
from tests.support.numerics import ULP, Array, directions, dot
from tests.support.renders import METHODS, assert_agree, assert_mean, rendered, whole

SKY: dict[str, Any] = {"bottom": [0.2, 0.5, 0.1], "horizon": [1.5, 0.25, 0.5], "top": [1, 0.4, 3]}
BOTTOM, HORIZON, TOP = (np.array(SKY[key]) for key in ("bottom", "horizon", "top"))
MIRROR = {"type": "metal", "color": [1, 1, 1]}


def lit(*objects: dict[str, Any], **camera: Any) -> Scene:
    """Matte things under the sky."""
    return scene_of(list(objects), {"m": MATTE, "mirror": MIRROR}, camera, background=SKY)


def sky64(direction: Array) -> Array:
    height = direction[:, 1:2]
    mixed: Array = HORIZON + np.abs(height) * (np.where(height < 0, BOTTOM, TOP) - HORIZON)
    return mixed


def test_each_side_is_a_gradient_of_its_own(call_glsl: CallGlsl) -> None:
    direction = directions(10_000)
    found = call_glsl("background(direction)", "vec3", scene=lit(), direction=direction)
    assert np.abs(found - sky64(direction.astype(np.float64))).max() < 4 * ULP
    ends = np.array([[0, 1, 0], [0, -1, 0], [1, 0, 0], [0, -0.0, 1]])
    seen = call_glsl("background(direction)", "vec3", scene=lit(), direction=ends)
    assert np.abs(seen - np.array([TOP, BOTTOM, HORIZON, HORIZON])).max() < ULP


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("up", "pole"), [(1, TOP), (-1, BOTTOM)])
def test_a_floor_gathers_its_half_of_the_sky(
    context: Context, up: int, pole: Array, method: str
) -> None:
    """The pole gives two thirds of the cosine-weighted sky."""
    eye = {"position": [0, up, 1], "look_at": [0, 0, 0], "fov": 10}
    scene = lit(plane([0, 0, 0], [0, 1, 0], "m"), **eye)
    image = rendered(scene, context, 32, method=method, bounces=1, width=16, height=16)
    assert_mean(whole(image), 0.5 * (HORIZON / 3 + 2 / 3 * pole), within=0.05)


def test_models_know_what_a_surface_gathers(call_glsl: CallGlsl) -> None:
    normal = directions(200, 3)
    found = call_glsl("unhidden_sky(normal)", "vec3", scene=lit(), normal=normal)
    around = fibonacci(20_000)
    light, truth = sky64(around), []
    for n in normal.astype(np.float64):
        cosine = np.maximum(dot(around, n), 0)
        truth.append((cosine[:, None] * light).mean(axis=0) * 4)
    assert np.abs(found - truth).max() < 1e-3


def fibonacci(count: int) -> Array:
    """Directions evenly around."""
    z = 1 - (2 * np.arange(count) + 1) / count
    angle = np.arange(count) * math.pi * (3 - math.sqrt(5))
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(angle), z, r * np.sin(angle)], axis=-1)


@pytest.mark.parametrize("method", CLASSIC)
def test_models_light_a_ball_as_in_truth(context: Context, method: str) -> None:
    ball = lit(sphere([0, 0, -3], 1, "m"), fov=36)
    model = rendered(ball, context, 16, method=method, width=32, height=32)
    truth = rendered(ball, context, 64, method="mis", seed=1, width=32, height=32)
    assert_agree(model, truth, within=0.02)


def test_a_horizon_halfway_between_is_one_gradient(context: Context) -> None:
    sky = {key: SKY[key] for key in ("bottom", "top")}
    two = lit(sphere([0, 0, -3], 1, "mirror"))
    halfway = two.background.model_copy(update={"horizon": tuple((BOTTOM + TOP) / 2)})
    one = scene_of([sphere([0, 0, -3], 1, "mirror")], {"mirror": MIRROR}, background=sky)
    other = two.model_copy(update={"background": halfway})
    first, second = (rendered(scene, context, 1).radiance for scene in (one, other))
    assert np.allclose(first, second, rtol=1e-6)


def test_a_horizon_of_one_colour_is_known_in_closed_form() -> None:
    flat = dict.fromkeys(SKY, [0.5] * 3)
    assert closed_form(scene_of([], {}, background=flat)) == 0.5
    assert closed_form(scene_of([], {}, background={**flat, "horizon": [0.5, 0.5, 0.6]})) is None


def test_light_of_the_sky_is_a_weighted_sum() -> None:
    scene, settings = lit(sphere([0, 0, -3], 1, "m")), Settings()
    plan = prepare(scene, settings, "groups")
    dimmed = plan.relit(with_lights(scene, {"background": 0.5}), settings, "groups")
    assert dimmed
    assert dimmed.weights == ((0.5, 0.5, 0.5),)
    plain = scene.background.model_copy(update={"horizon": None})
    other = scene.model_copy(update={"background": plain})
    assert plan.relit(other, settings, "groups") is None
    assert prepare(other, settings, "groups").relit(scene, settings, "groups") is None


def test_a_horizon_needs_both_poles() -> None:
    with pytest.raises(SceneError, match="horizon goes with bottom and top; give all three"):
        scene_of([], {}, background={"horizon": [1, 1, 1]})
    with pytest.raises(SceneError, match="bottom and top go together"):
        scene_of([], {}, background={"horizon": [1, 1, 1], "top": [1, 1, 1]})
