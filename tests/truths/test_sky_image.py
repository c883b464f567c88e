"""An image as background: where its pixels stand, and what it lights.

Seeds are fixed; `tests/support/alarms.py` says how often a correct program fails.
"""

from typing import Any

import numpy as np
import pytest

from glrt.analysis.reference import closed_form
from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.plan.explanation import explain
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.plan.omissions import omissions
from glrt.plan.plan import prepare
from glrt.scene.scene import Scene, with_lights
from glrt.settings import Settings
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, lamp, plane, scene_of, sphere
from tests.support.numerics import Array, directions
from tests.support.renders import METHODS, assert_agree, assert_mean, rendered, whole
from tests.support.sky_images import random_sky, sky64, spot, under

ON: dict[str, bool | int] = {"HAS_ENVIRONMENT": True}
FLOOR = plane([0, 0, 0], [0, 1, 0], "m")
ABOVE = {"position": [0, 1, 1], "look_at": [0, 0, 0], "fov": 10}


def seen(call_glsl: CallGlsl, scene: Scene, direction: Array) -> Array:
    return call_glsl(
        "background(direction)", "vec3", scene=scene, constants=ON, direction=direction
    )


@pytest.mark.parametrize("rotation", [0.0, 30.0, -120.0, 725.0])
@pytest.mark.parametrize("size", [(64, 32), (7, 5), (1, 1), (2, 1), (1, 2)])
def test_directions_see_what_float64_says(
    call_glsl: CallGlsl, size: tuple[int, int], rotation: float
) -> None:
    pixels = random_sky(*size)
    scene = under(pixels, FLOOR, rotation=rotation)
    direction = directions(20_000)
    direction = direction[direction[:, [0, 2]].any(axis=1)]  # at a pole all azimuths are one
    found = call_glsl(
        "background(direction)", "vec3", scene=scene, constants=ON, direction=direction
    )
    expected = sky64(pixels, direction.astype(np.float64), rotation)
    assert np.abs(found - expected).max() < 4e-6 * max(size)


@pytest.mark.parametrize(
    ("column", "row", "direction"),
    [
        (8, 4, [0, 0, -1]),
        (12, 4, [1, 0, 0]),
        (4, 4, [-1, 0, 0]),
        (0, 4, [0, 0, 1]),
    ],
)
def test_pixels_stand_where_the_format_says(
    call_glsl: CallGlsl, column: int, row: int, direction: list[float]
) -> None:
    """In 16 x 8 pixels an axis lies on the corner of four: each has a quarter of it."""
    scene = under(spot(column, row), FLOOR)
    point = np.array([direction], np.float32)
    found = seen(call_glsl, scene, point)
    assert found[0, 0] == pytest.approx(0.25, abs=1e-5)


@pytest.mark.parametrize(("row", "up"), [(0, 1.0), (7, -1.0)])
def test_the_first_row_is_above(call_glsl: CallGlsl, row: int, up: float) -> None:
    pixels = np.zeros((8, 16, 3), np.float32)
    pixels[row] = 1
    poles = np.array([[0, up, 0], [0, -up, 0]], np.float32)
    scene = under(pixels, FLOOR)
    found = seen(call_glsl, scene, poles)
    assert found[:, 0].tolist() == [1.0, 0.0]


def test_a_quarter_turn_moves_what_stood_ahead_to_the_left(call_glsl: CallGlsl) -> None:
    scene = under(spot(8, 4), FLOOR, rotation=90)
    left = np.array([[-1, 0, 0], [0, 0, -1]], np.float32)
    found = seen(call_glsl, scene, left)
    assert found[:, 0] == pytest.approx([0.25, 0.0], abs=1e-5)


@pytest.mark.parametrize("method", METHODS)
def test_an_image_of_one_colour_is_that_colour(context: Context, method: str) -> None:
    """Bit for bit, where it is found by scattering alone; else in the mean."""
    color = np.array([0.5, 0.25, 2.0], np.float32)
    things = FLOOR, sphere([0, 0.3, 0], 0.3, "mirror")
    image = under(np.broadcast_to(color, (3, 5, 3)).copy(), *things, camera=ABOVE)
    plain = scene_of(
        list(things),
        {"m": MATTE, "mirror": {"type": "metal", "color": [1, 1, 1]}},
        ABOVE,
        background={"color": color.tolist()},
    )
    found, expected = (
        rendered(scene, context, 256, method=method, seed=seed, width=16, height=16)
        for scene, seed in ((image, 0), (plain, 0 if method == "naive" else 1))
    )
    if method == "naive":
        assert found.radiance.tobytes() == expected.radiance.tobytes()
    else:
        assert_agree(found, expected, within=0.05)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rotation", [0.0, 77.0])
def test_a_floor_gathers_the_upper_half(context: Context, method: str, rotation: float) -> None:
    """The integral of radiance times cosine over pi, by a quadrature of float64."""
    pixels = random_sky(6, 4, seed=3)
    scene = under(pixels, FLOOR, camera=ABOVE, rotation=rotation)
    image = rendered(scene, context, 1024, method=method, bounces=1, width=16, height=16)
    assert_mean(whole(image), 0.5 * gathered(pixels), within=0.02)


def gathered(pixels: Array) -> Array:
    """The sum over even steps of cos^2 and of the azimuth: each step has equal weight."""
    steps = 400
    middle = (np.arange(steps) + 0.5) / steps
    squared, turns = (part.ravel() for part in np.meshgrid(middle, middle))
    cosine, sine = np.sqrt(squared), np.sqrt(1 - squared)
    angle = 2 * np.pi * turns
    direction = np.stack([sine * np.cos(angle), cosine, sine * np.sin(angle)], axis=1)
    mean: Array = sky64(pixels, direction).mean(axis=0)
    return mean


@pytest.mark.slow
def test_methods_agree_under_an_image_and_a_lamp(context: Context) -> None:
    pixels = random_sky(8, 4, seed=5)
    things = FLOOR, sphere([0, 0.3, 0], 0.3, "mirror")
    lit = under(pixels, *things, camera={**ABOVE, "fov": 60})
    materials = {**lit.materials, **scene_of([FLOOR], {"m": MATTE, "lamp": lamp(4.0)}).materials}
    ball = scene_of([sphere([0.8, 0.8, 0], 0.2, "lamp")], {"lamp": lamp(4.0)}).objects
    scene = lit.model_copy(update={"materials": materials, "objects": (*lit.objects, *ball)})
    pictures = {
        method: rendered(scene, context, 256, method=method, seed=seed, width=16, height=16)
        for seed, method in enumerate(METHODS)
    }
    for method in METHODS[1:]:
        assert_agree(pictures[METHODS[0]], pictures[method], within=0.05)


def test_color_and_intensity_are_factors(context: Context) -> None:
    pixels = random_sky(8, 4)
    size: dict[str, Any] = {"width": 16, "height": 16}
    plain = rendered(under(pixels, FLOOR, camera=ABOVE), context, 16, **size)
    double = rendered(under(pixels, FLOOR, camera=ABOVE, color=[2, 2, 2]), context, 16, **size)
    lit = with_lights(under(pixels, FLOOR, camera=ABOVE), {"background": 2.0})
    assert (2 * plain.radiance).tobytes() == double.radiance.tobytes()
    assert (2 * plain.radiance).tobytes() == rendered(lit, context, 16, **size).radiance.tobytes()


def test_both_pipelines_and_tiers_show_the_same_bits(context: Context) -> None:
    scene = under(random_sky(32, 16), FLOOR, sphere([0, 0.3, 0], 0.3, "mirror"), camera=ABOVE)
    ways: list[dict[str, Any]] = [{}, {"pipeline": "fragment"}, {"tier": "complete"}]
    pictures = {
        rendered(scene, context, 16, width=16, height=16, **way).radiance.tobytes() for way in ways
    }
    assert len(pictures) == 1


def test_what_is_not_done_is_reported() -> None:
    scene = under(random_sky(4, 2), FLOOR)
    reasons = {feature.name: feature for feature in explain(prepare(scene, Settings()))}
    assert reasons["image of the sky"].present
    assert reasons["sky sampling"].present
    assert not needs_of(SceneFacts(scene), Settings(method="naive")).sample_sky
    assert "the image of the sky lights nothing" in omissions(
        SceneFacts(scene), Settings(method="cook")
    )
    assert closed_form(under(random_sky(4, 2), FLOOR)) is None


@pytest.mark.slow
def test_models_take_no_light_of_an_image(context: Context) -> None:
    scene = under(random_sky(4, 2), FLOOR, camera=ABOVE)
    for method in ("whitted", "cook", "phong"):
        image = rendered(scene, context, 1, method=method, width=8, height=8)
        assert not image.radiance.any()


def test_an_image_that_was_not_read_is_refused(context: Context) -> None:
    scene = scene_of([FLOOR], {"m": MATTE}, background={"image": "sky.exr"})
    with pytest.raises(SceneError, match=r"background.image: the file sky.exr was not read"):
        rendered(scene, context, 1)
