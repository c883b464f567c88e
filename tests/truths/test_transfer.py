"""Scientific volumes: transfer functions of grids, against closed forms and quadratures."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.density import Density
from glrt.scene.medium import Medium
from glrt.scene.scene import Scene
from glrt.scene.transfer import Transfer
from glrt.settings import Cost
from tests.support.builders import box, quad, scene_of, sphere
from tests.support.media import EVEN, FAR, MATERIALS, MU, filled
from tests.support.numerics import Array
from tests.support.renders import METHODS, assert_mean, rendered, rendering, same, whole

CUBE = filled(box([-1, -1, -1], [1, 1, 1], ""))
ONES = np.ones((9, 17, 8), np.float32)
LAYERS = 32
RAMP = np.arange(LAYERS + 1, dtype=np.float32)[:, None, None] / LAYERS * np.ones((1, 3, 2), "f4")
RED, GREEN, BLUE = np.eye(3).tolist()
RAINBOW = Transfer(
    values=[0, 0.4, 0.5, 0.5, 1],
    colors=[RED, GREEN, BLUE, RED, [1, 1, 0]],
    opacities=[0, 0.1, 0.9, 0.3, 0],
    length=0.5,
)
BUMPY = np.random.default_rng(5).uniform(0, 1, (20, 12, 9)).astype(np.float32)


def volume(values: Array, transfer: Transfer, **more: Any) -> Medium:
    return Medium(density=Density(values, **more), transfer=transfer)


def with_volume(fog: Medium, things: Any = (CUBE,), camera: Any = FAR, **more: Any) -> Scene:
    more = {"background": EVEN, **more}
    return scene_of(list(things), MATERIALS, camera, media={"fog": fog}, **more)


def even(color: Any, opacity: float, length: float = 1.0) -> Transfer:
    """The same colour and opacity at all densities."""
    return Transfer(values=[0.5], colors=[color], opacities=[opacity], length=length)


def along_z(values: Array, transfer: Transfer, steps: int = 400_000) -> Array:
    """The light through the middle of CUBE, of layers that are even, over radiance 1.

    The emission-absorption integral by the midpoint rule, from the front to the back.
    """
    layers = values[:, 0, 0].astype(float)
    z = 1 - (np.arange(steps) + 0.5) * (2 / steps)
    density = np.interp(z, -1 + 2 * (np.arange(len(layers)) + 0.5) / len(layers), layers)
    opacity = np.interp(density, transfer.values, transfer.opacities)
    colors = np.array(transfer.colors).T
    color = np.array([np.interp(density, transfer.values, channel) for channel in colors])
    left = np.exp(np.cumsum(np.log1p(-opacity)) * (2 / steps / transfer.length))
    lost = -np.diff(left, prepend=1.0)
    found: Array = (color * lost).sum(axis=1) + left[-1]
    return found


# --- closed forms ----------------------------------------------------------------------------


def test_an_even_grid_has_its_opacity_over_its_length(context: Context) -> None:
    """CUBE is 2 deep: (1 - o)^4 of the light comes through, for o over 0.5."""
    color, left = np.array([0.3, 2.0, 0.0]), 0.7**4
    image = rendered(with_volume(volume(ONES, even(color, 0.3, 0.5))), context, 2048, bounces=0)
    assert_mean(whole(image), color * (1 - left) + left, 0.03)


def test_a_gradient_with_a_knot_has_the_depth_of_its_logarithms(context: Context) -> None:
    """Opacity rises from 0 to 0.8, and falls to 0.2, linearly along z.

    The integral of -ln(1 - o) over o is (1 - o) ln(1 - o) + o. Half a voxel at each end is even.
    """
    transfer = Transfer(
        values=[0, 0.25, 1], colors=[[0.5, 1.5, 2]] * 3, opacities=[0, 0.8, 0.2], length=0.5
    )

    def depth(a: float, b: float) -> float:
        first, last = ((1 - o) * np.log1p(-o) + o for o in (a, b))
        return float((last - first) / (b - a))

    voxel = 2 / (LAYERS + 1)
    whole_ramp = LAYERS * voxel
    tau = 2 * (
        whole_ramp * (0.25 * depth(0, 0.8) + 0.75 * depth(0.8, 0.2)) - voxel / 2 * np.log(0.8)
    )
    left = np.exp(-tau)
    image = rendered(with_volume(volume(RAMP, transfer)), context, 4096, bounces=0)
    assert_mean(whole(image), np.array([0.5, 1.5, 2]) * (1 - left) + left, 0.02)


def test_an_opaque_step_shows_its_front(context: Context) -> None:
    """From density 0.5 on nothing is seen through; there, the colour is that of the step."""
    step = Transfer(
        values=[0, 0.5, 0.5, 1],
        colors=[RED, RED, [0.2, 0.4, 0.6], [0.2, 0.4, 0.6]],
        opacities=[0, 0, 0.99999, 0.99999],
        length=1e-3,
    )
    image = rendered(with_volume(volume(RAMP, step)), context, 16, bounces=0)
    assert_allclose(image.radiance, np.broadcast_to([0.2, 0.4, 0.6], (16, 16, 3)), rtol=2e-6)
    from_below = with_volume(volume(RAMP[::-1].copy(), step, scale=0.4))
    assert_allclose(rendered(from_below, context, 16, bounces=0).radiance, 1.0, rtol=2e-6)


def test_colors_of_knots_are_met_in_turn(context: Context) -> None:
    """A step, and a layer that is denser than its neighbours on both sides."""
    image = rendered(with_volume(volume(RAMP, RAINBOW)), context, 4096, bounces=0)
    assert_mean(whole(image), along_z(RAMP, RAINBOW), 0.02)


def test_a_white_volume_under_an_even_sky_cannot_be_seen(context: Context) -> None:
    """Each sample emits what it takes, whatever the opacities."""
    white = RAINBOW.model_copy(update={"colors": ((1.0, 1.0, 1.0),) * 5})
    image = rendered(with_volume(volume(BUMPY, white)), context, 64, bounces=0)
    assert_allclose(image.radiance, 1.0, rtol=2e-6)


def test_the_light_of_a_volume_has_an_intensity(context: Context) -> None:
    transfer = even([1, 2, 3], 0.9)
    scene = with_volume(volume(ONES, transfer), lights={"media.fog": 0.25})
    image = rendered(scene, context, 2048, bounces=0)
    assert_mean(whole(image), np.array([1, 2, 3]) * (0.25 * 0.99) + 0.01, 0.05)


# --- with surfaces and lamps -----------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_a_lamp_is_seen_through_a_volume(context: Context, method: str) -> None:
    """The volume is black, and so is the sky."""
    black = RAINBOW.model_copy(update={"colors": ((0.0, 0.0, 0.0),) * 5})
    things = [CUBE, filled(sphere([0, 0, 40], 0.5, ""), None, "lamp")]
    eye = {"position": [0, 0, -2], "look_at": [0, 0, 0], "fov": 0.01, "up": [0, 1, 0]}
    scene = with_volume(volume(RAMP, black), things, eye, background={})
    image = rendered(scene, context, 4096, method=method, bounces=1)
    assert_mean(whole(image), 9 * along_z(RAMP, black), 0.05)


@pytest.mark.slow
def test_lamps_shine_through_a_volume(context: Context) -> None:
    """Direct light of a lamp straight above a floor, with and without the volume between."""
    black = RAINBOW.model_copy(update={"colors": ((0.0, 0.0, 0.0),) * 5})
    clear = even([0, 0, 0], 0.0)
    things = [
        CUBE,
        quad([-0.01, -0.01, -1.5], [0.02, 0, 0], [0, 0.02, 0], "white"),
        filled(sphere([0, 0, 90], 0.5, ""), None, "lamp"),
    ]
    eye = {"position": [0, 0, -1.2], "look_at": [0, 0, -1.5], "up": [0, 1, 0], "fov": 0.01}
    scenes = [with_volume(volume(RAMP, it), things, eye, background={}) for it in (black, clear)]
    image, bare = (rendered(it, context, 4096, bounces=1, roulette=False) for it in scenes)
    assert_mean(whole(image), whole(bare)[0] * along_z(RAMP, black), 0.05)


@pytest.mark.slow
def test_smoke_and_a_volume_stand_side_by_side(context: Context) -> None:
    """The rows of knots lie between those of the two media."""
    things = [
        filled(box([-1, -1, -1], [1, 1, 0], ""), "ct"),
        filled(box([-1, -1, 0.5], [1, 1, 1], ""), "fog"),
    ]
    media = {"ct": volume(RAMP, RAINBOW), "fog": Medium(absorption=MU)}
    scene = scene_of(things, MATERIALS, FAR, media=media, background=EVEN)
    half = RAINBOW.model_copy(update={"length": 1.0})  # a ramp half as long
    image = rendered(scene, context, 8192, bounces=0)
    assert_mean(whole(image), along_z(RAMP, half) * np.exp(-0.5 * MU), 0.02)


@pytest.mark.slow
def test_lengths_that_are_twice_as_large_keep_the_bits(context: Context) -> None:
    def scene(size: float) -> Scene:
        transfer = RAINBOW.model_copy(update={"length": 0.5 * size})
        eye = {"position": [0, 0, 5 * size], "look_at": [0, 0, 0], "fov": 40}
        body = filled(box([-size] * 3, [size] * 3, ""))
        return with_volume(volume(BUMPY, transfer), [body], eye)

    first, second = (rendered(scene(size), context, 16) for size in (1.0, 8.0))
    assert same(first, second)


@pytest.mark.slow
def test_an_edit_of_knots_keeps_the_kernel(context: Context) -> None:
    with rendering(with_volume(volume(ONES, even([1, 1, 1], 0.5))), context) as renderer:
        renderer.render(1)
        cost = renderer.update(with_volume(volume(ONES, RAINBOW)))
        assert cost is Cost.RESTART
