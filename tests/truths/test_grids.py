"""Media whose density varies, against closed forms and against media of even density."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.density import Density
from glrt.scene.medium import Medium
from glrt.scene.scene import Scene
from tests.support.builders import box, cylinder, quad, scene_of, sphere
from tests.support.media import EVEN, FAR, MATERIALS, MU, ball, filled
from tests.support.meshes import box as box_of_triangles
from tests.support.meshes import mesh
from tests.support.numerics import Array
from tests.support.renders import METHODS, assert_agree, assert_mean, rendered, same, whole

CUBE = filled(box([-1, -1, -1], [1, 1, 1], ""))
ONES = np.ones((9, 17, 8), np.float32)
BUMPY = np.random.default_rng(5).uniform(0, 2, (20, 12, 9)).astype(np.float32)
SPIKE = np.zeros((24, 24, 24), np.float32)
SPIKE[12, 12, 12] = 60.0


def smoke(values: Array, scattering: Any = 0.0, absorption: Any = 0.0, **more: Any) -> Medium:
    """A medium with a grid; a number stands for all channels."""
    box_of_grid = {key: more.pop(key) for key in ("min", "max", "scale") if key in more}
    return Medium(
        scattering=np.broadcast_to(scattering, 3),
        absorption=np.broadcast_to(absorption, 3),
        emission=np.broadcast_to(more.pop("emission", 0.0), 3),
        density=Density(values, **box_of_grid),
        **more,
    )


def with_smoke(fog: Medium, things: Any = (CUBE,), camera: Any = FAR, **more: Any) -> Scene:
    materials = {**MATERIALS, **more.pop("materials", {})}
    return scene_of(list(things), materials, camera, media={"fog": fog}, **more)


# --- what comes through ----------------------------------------------------------------------


def depth_along_z(values: Array) -> Any:
    """The integral of density through the middle of CUBE: trapezoids, and even halves at the ends.

    Grids have the same value in all of a layer.
    """
    layers = values[:, 0, 0].astype(float)
    return 2 / len(layers) * (np.trapezoid(layers) + (layers[0] + layers[-1]) / 2)


RAMP = np.linspace(0, 1, 32, dtype=np.float32)[:, None, None] * np.ones((32, 3, 2), np.float32)
STEPS = np.repeat([0.0, 1.5, 0.0, 0.25], 8)[:, None, None] * np.ones((32, 3, 2), np.float32)


@pytest.mark.parametrize("values", [ONES, RAMP, STEPS], ids=["even", "ramp", "steps"])
def test_a_grid_that_absorbs_leaves_what_beer_says(context: Context, values: Array) -> None:
    scene = with_smoke(smoke(values, absorption=MU), background=EVEN)
    image = rendered(scene, context, 2048)
    assert_mean(whole(image), np.exp(-MU * depth_along_z(values)), 0.1)


@pytest.mark.parametrize("values", [RAMP, STEPS], ids=["ramp", "steps"])
def test_a_grid_that_scatters_lets_through_what_beer_says(context: Context, values: Array) -> None:
    """At most 0 bounces: all that is scattered is lost. The channels differ by up to 4."""
    scene = with_smoke(smoke(values, 0.75 * MU, 0.25 * MU), background=EVEN)
    image = rendered(scene, context, 2048, bounces=0)
    assert_mean(whole(image), np.exp(-MU * depth_along_z(values)), 0.1)


def test_a_grid_that_absorbs_is_as_noisy_as_ratio_tracking(context: Context) -> None:
    """The mean square of the share is exp(-the integral of 2 m - m^2 / M) (Novák et al. 2014).

    M is the density of the fictitious medium: that of the densest channel at the densest place of a
    brick, which the voxels around it bound, too.
    """
    layers = RAMP[:, 0, 0].astype(float)
    place = (np.arange(100_000) + 0.5) / 100_000 * len(layers)  # in voxels
    density = np.interp(place - 0.5, np.arange(len(layers)), layers)
    tops = np.array([layers[max(first - 1, 0) : first + 9].max() for first in range(0, 32, 8)])
    real, most = MU[:, None] * density, MU.max() * tops[(place // 8).astype(int)]
    square, mean = (np.exp(-2 * it.mean(axis=1)) for it in (2 * real - real**2 / most, real))
    scene = with_smoke(smoke(RAMP, absorption=MU), background=EVEN)
    image = rendered(scene, context, 2048)
    found = np.square(image.stderr, dtype=np.float64).mean(axis=(0, 1)) * 2048
    assert_allclose(found, square - mean**2, rtol=0.02)


def test_gray_smoke_lets_light_pass_whole_or_not_at_all(context: Context) -> None:
    """Delta tracking has the variance T (1 - T): each sample is 0 or 1."""
    scene = with_smoke(smoke(RAMP, 0.75, 0.25), background=EVEN)
    image = rendered(scene, context, 1, bounces=0)
    assert np.unique(image.radiance.round(6)).tolist() == [0.0, 1.0]
    many = rendered(scene, context, 512, bounces=0)
    found = np.square(many.stderr, dtype=np.float64).mean(axis=(0, 1)) * 512
    left = np.exp(-depth_along_z(RAMP))
    assert_allclose(found, left * (1 - left), rtol=0.02)


@pytest.mark.slow
def test_a_shadow_is_as_deep_as_the_grid(context: Context) -> None:
    """A floor under smoke that scatters; direct light of a lamp straight above it, far away."""
    things = [
        CUBE,
        quad([-0.01, -0.01, -1.5], [0.02, 0, 0], [0, 0.02, 0], "white"),
        filled(sphere([0, 0, 90], 0.5, ""), None, "lamp"),
    ]
    eye = {"position": [0, 0, -1.2], "look_at": [0, 0, -1.5], "up": [0, 1, 0], "fov": 0.01}
    with_it = with_smoke(smoke(RAMP, MU), things, eye)
    none = with_smoke(smoke(0 * RAMP, MU), things, eye)
    image, clear = (
        rendered(it, context, 4096, bounces=1, roulette=False) for it in (with_it, none)
    )
    left = whole(clear)[0] * np.exp(-MU * depth_along_z(RAMP))
    assert_mean(whole(image), left, 0.05)


def test_a_voxel_in_empty_space_is_found(context: Context) -> None:
    """Its density falls off linearly on both sides of its middle, one voxel far."""
    voxel = 2 / 24
    middle = {"position": [voxel / 2, voxel / 2, 5], "look_at": [voxel / 2] * 3, "fov": 1e-4}
    scene = with_smoke(smoke(SPIKE, absorption=MU / 8), camera=middle, background=EVEN)
    assert_mean(whole(rendered(scene, context, 2048)), np.exp(-MU / 8 * 60 * voxel), 0.03)


# --- what shines -----------------------------------------------------------------------------


def test_gas_in_a_grid_shines_as_long_as_it_is_deep(context: Context) -> None:
    """Emission e and absorption a give e / a (1 - exp(-a d)); without absorption, e d."""
    fog = smoke(RAMP, absorption=[0.5, 2, 0], emission=[1, 2, 3])
    image = rendered(with_smoke(fog), context, 4096, bounces=0)
    depth = depth_along_z(RAMP)
    truth = [2 * (1 - np.exp(-depth / 2)), 1 - np.exp(-2 * depth), 3 * depth]
    assert_mean(whole(image), truth, 0.02)


def test_gas_that_only_shines_is_seen(context: Context) -> None:
    image = rendered(with_smoke(smoke(RAMP, emission=[1, 2, 3])), context, 4096, bounces=0)
    assert_mean(whole(image), depth_along_z(RAMP) * np.array([1, 2, 3]), 0.02)


@pytest.mark.slow
def test_gas_that_scatters_shines_as_a_ball_of_it_does(context: Context) -> None:
    """Without absorption, the mean over the disc is 4 / 3 of e R, whatever scatters."""
    place = np.linspace(-1, 1, 33)[1::2]
    away = np.sqrt(sum(np.square(np.meshgrid(place, place, place, indexing="ij"))))
    even = np.ones_like(away, np.float32)
    fog = smoke(even, [1, 3, 0], emission=1, anisotropy=0.6)
    eye = {"position": [0, 0, 400], "look_at": [0, 0, 0], "fov": 0.287}
    image = rendered(with_smoke(fog, [ball()], eye), context, 512, bounces=200, roulette=False)
    wide = 2 * 400 * np.tan(np.radians(0.287 / 2))
    assert_mean(whole(image), 4 / 3 * np.pi / np.full(3, wide) ** 2, 0.03)


# --- scattering ------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("g", [-0.9, 0.0, 0.9])
def test_white_smoke_under_an_even_sky_cannot_be_seen(context: Context, g: float) -> None:
    fog = smoke(BUMPY, [0.5, 2, 5], anisotropy=g)
    scene = with_smoke(fog, [CUBE], {**FAR, "fov": 30}, background=EVEN)
    image = rendered(scene, context, 256, bounces=1000, roulette=False)
    assert_mean(whole(image), [1.0] * 3, 0.03)


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_a_cavity_with_smoke_in_equilibrium_is_even(context: Context, method: str) -> None:
    """Walls that emit what they absorb, and smoke that does the same (Kirchhoff): radiance 1."""
    wall = {"type": "light", "color": [0.5] * 3, "emission": [0.5] * 3}
    things = [
        box([-3, -3, -3], [3, 3, 3], "wall"),
        filled(cylinder([-0.4, -1.2, 0], [0.5, 1.3, 0.2], 1.2, "")),
        sphere([0.2, 0, 0], 0.4, "wall"),
        sphere([0, 1.2, 0.9], 0.3, "wall"),  # across the bounds
    ]
    fog = smoke(BUMPY, [1, 2, 0.3], [0.5, 1, 0], emission=[0.5, 1, 0], anisotropy=0.5)
    eye = {"position": [0, 0, 2.5], "fov": 60}
    scene = with_smoke(fog, things, eye, materials={"wall": wall})
    image = rendered(scene, context, 256, method=method, bounces=60)
    assert_mean(whole(image), [1.0] * 3, 0.03)


@pytest.mark.slow
@pytest.mark.parametrize("values", [np.ones((1, 1, 1), np.float32), ONES], ids=["voxel", "grid"])
def test_an_even_grid_is_a_medium_without_one(context: Context, values: Array) -> None:
    """A lamp near the medium, whose channels differ."""
    things = [CUBE, filled(sphere([0, 1.6, 0.4], 0.3, ""), None, "lamp")]
    eye = {"position": [0, 0, 4], "fov": 40}
    fog = smoke(values, [1, 2, 0.5], [0.1, 0.1, 0.3], anisotropy=0.4)
    even = fog.model_copy(update={"density": None})
    grid = rendered(with_smoke(fog, things, eye), context, 4096, seed=1)
    assert_agree(grid, rendered(with_smoke(even, things, eye), context, 4096), 0.1)


# --- places ----------------------------------------------------------------------------------


@pytest.mark.slow
def test_voxels_lie_where_they_belong(context: Context) -> None:
    """A grid of 2 x 3 x 4 even blocks, seen along each axis through the middle of each."""
    values = np.zeros((40, 30, 20), np.float32)
    wide = np.random.default_rng(2).uniform(0, 2, (4, 3, 2)).astype(np.float32)
    values[:] = wide.repeat(10, 0).repeat(10, 1).repeat(10, 2)
    for axis in range(3):
        sums = wide.sum(axis=2 - axis) * 2 / wide.shape[2 - axis]  # of x, y, z in turn
        others = [it for it in range(3) if it != axis]
        for place, truth in np.ndenumerate(sums):
            middle = np.zeros(3)
            for it, number in zip(others[::-1], place, strict=True):
                middle[it] = 2 * (number + 0.5) / wide.shape[2 - it] - 1
            eye = middle.copy()
            eye[axis] = 5
            up = np.eye(3)[others[0]].tolist()
            camera = {"position": eye.tolist(), "look_at": middle.tolist(), "fov": 0.01, "up": up}
            scene = with_smoke(smoke(values, absorption=0.5), [CUBE], camera, background=EVEN)
            image = rendered(scene, context, 512, width=4, height=4)
            # Between two values the density is interpolated, evenly around their edge.
            assert_mean(whole(image), [np.exp(-0.5 * truth)] * 3, 0.2)


@pytest.mark.slow_cases("mesh")
@pytest.mark.parametrize("thing", ["box", "mesh"])
def test_a_grid_turns_with_its_object(context: Context, thing: str) -> None:
    """About z by 90 degrees: x of the grid lies along y of the world."""
    corners = [-1, -2, -1], [1, 2, 1]
    solids = {"box": box(*corners, ""), "mesh": mesh(box_of_triangles(*corners), "")}
    turned = filled({**solids[thing], "rotate": [0, 0, 90]})
    values = np.zeros((4, 4, 16), np.float32)
    values[:, :, 8:] = 1.0  # x above 0
    truths = []
    for y in (0.5, -0.5):
        camera = {"position": [0.3, y, 9], "look_at": [0.3, y, 0], "fov": 0.01}
        scene = with_smoke(smoke(values, absorption=MU), [turned], camera, background=EVEN)
        truths.append(whole(rendered(scene, context, 1024)))
    assert_mean(truths[0], np.exp(-2 * MU), 0.2)
    assert_mean(truths[1], [1.0] * 3, 1e-6)


def test_a_box_of_its_own_leaves_the_rest_empty(context: Context) -> None:
    fog = smoke(ONES, absorption=MU, min=(-1, -1, -0.25), max=(1, 1, 0.5), scale=2.0)
    image = rendered(with_smoke(fog, background=EVEN), context, 1024)
    assert_mean(whole(image), np.exp(-1.5 * MU), 0.1)


@pytest.mark.slow
def test_lengths_that_are_twice_as_large_keep_the_bits(context: Context) -> None:
    def scene(size: float) -> Scene:
        corners = [-size] * 3, [size] * 3
        fog = smoke(BUMPY, np.array([1, 2, 4]) / size, 0.5 / size, emission=0.25 / size)
        eye = {"position": [0, 0, 5 * size], "look_at": [0, 0, 0], "fov": 40}
        return with_smoke(fog, [filled(box(*corners, ""))], eye, background=EVEN)

    first, second = (rendered(scene(size), context, 16) for size in (1.0, 8.0))
    assert same(first, second)


def test_a_grid_lies_in_two_objects(context: Context) -> None:
    """A box twice as deep has twice the depth, and one that is turned has it from the other end."""
    steep = np.zeros((32, 3, 2), np.float32)
    steep[16:] = 1.0  # above the middle
    high = {**filled(box([3, -1, -2], [5, 1, 2], "")), "rotate": [0, 180, 0]}
    for x, top, truth in ((0.0, -0.1, 1.0), (4.0, -0.5, np.exp(-1.5 * MU))):
        camera = {"position": [x, 0, top], "look_at": [x, 0, top - 1], "fov": 0.01}
        fog = smoke(steep, absorption=MU)
        image = rendered(with_smoke(fog, [CUBE, high], camera, background=EVEN), context, 1024)
        assert_mean(whole(image), np.broadcast_to(truth, 3), 0.2)


# --- limits ----------------------------------------------------------------------------------


def test_smoke_of_density_0_is_not_there(context: Context) -> None:
    fog = smoke(np.zeros((3, 3, 3), np.float32), [1, 2, 3], 1, emission=5)
    image = rendered(with_smoke(fog, background=EVEN), context, 16)
    assert_allclose(image.radiance, 1.0, rtol=1e-6)


@pytest.mark.slow
def test_all_of_space_may_hold_a_grid(context: Context) -> None:
    """The sky is seen through the box of the grid."""
    fog = smoke(ONES, absorption=MU, min=(-1, -1, -1), max=(1, 1, 1))
    scene = scene_of([], {}, FAR, media={"fog": fog}, medium="fog", background=EVEN)
    assert_mean(whole(rendered(scene, context, 1024)), np.exp(-2 * MU), 0.2)
