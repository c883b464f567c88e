"""Sampling of an image of the sky: its density, small suns, poles and the seam."""

from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.packing.sky_table import sky_sampling
from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.shaders.test_sampling import DRAWS, RNG, cells_of
from tests.support.alarms import assert_fits
from tests.support.builders import MATTE, glass, plane, scene_of, sphere
from tests.support.numerics import Array
from tests.support.renders import METHODS, assert_agree, assert_mean, rendered, whole
from tests.support.sky_images import random_sky, sky64, spot, under

ON: dict[str, bool | int] = {"HAS_ENVIRONMENT": True, "SAMPLE_SKY": True, "BACKGROUND_LAYER": 0}
FLOOR = plane([0, 0, 0], [0, 1, 0], "m")
ABOVE = {"position": [0, 1, 1], "look_at": [0, 0, 0], "fov": 10}
SMALL: dict[str, Any] = {"width": 16, "height": 16}
SIZES = [(1, 1), (2, 1), (1, 2), (7, 5), (16, 8), (33, 17)]  # width, height
SKY_RAY = "Ray ray = Ray(vec3(0.0), vec3(0.0, 0.0, 1.0), NO_SHAPE, false);"


def drawn(call_glsl: CallGlsl, scene: Scene, count: int, what: str, returns: str) -> Array:
    setup = f"{RNG} {SKY_RAY} LightSample light = sample_sky(ray, rng);"
    lanes = np.arange(count)
    return call_glsl(what, returns, setup=setup, scene=scene, constants=ON, lane=lanes)


def density(call_glsl: CallGlsl, scene: Scene, direction: Array) -> Array:
    found = call_glsl(
        "pdf_sky(direction)", scene=scene, constants=ON, direction=direction.astype(np.float32)
    )
    return found.astype(np.float64)


def grid_of(rows: int, columns: int) -> Array:
    """Directions in the middle of cells of even solid angle, (rows, columns, 3), z the axis."""
    z = 2 * (np.arange(rows) + 0.5) / rows - 1
    phi = 2 * np.pi * (np.arange(columns) + 0.5) / columns
    r = np.sqrt(1 - z * z)[:, None]
    return np.stack([r * np.cos(phi), r * np.sin(phi), z[:, None] + 0 * phi], axis=-1)


@pytest.mark.parametrize("rotation", [0.0, 77.0])
@pytest.mark.parametrize("size", SIZES)
def test_the_density_is_that_of_a_direction_and_integrates_to_one(
    call_glsl: CallGlsl, size: tuple[int, int], rotation: float
) -> None:
    scene = under(random_sky(*size), FLOOR, rotation=rotation)
    grid = grid_of(1000, 1000).reshape(-1, 3)
    found = density(call_glsl, scene, grid)
    assert found.min() > 0
    assert found.mean() * 4 * np.pi == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize("size", SIZES)
def test_samples_report_the_density_and_the_radiance_of_their_direction(
    call_glsl: CallGlsl, size: tuple[int, int]
) -> None:
    pixels = random_sky(*size)
    scene = under(pixels, FLOOR, rotation=30, color=[1, 2, 3])
    direction = drawn(call_glsl, scene, 20_000, "light.ray.direction", "vec3")
    figures = drawn(call_glsl, scene, 20_000, "vec4(light.radiance, light.pdf)", "vec4")
    assert np.abs(np.linalg.norm(direction.astype(np.float64), axis=1) - 1).max() < 1e-6
    truth = sky64(pixels, direction.astype(np.float64), 30) * [1, 2, 3]
    assert np.abs(figures[:, :3] - truth).max() < 2e-5 * max(size)
    again = density(call_glsl, scene, direction)
    away = np.hypot(direction[:, 0], direction[:, 2]) > 0.01  # from the poles
    assert np.allclose(figures[away, 3], again[away], rtol=2e-3)


@pytest.mark.parametrize("size", SIZES)
def test_samples_follow_their_density(call_glsl: CallGlsl, size: tuple[int, int]) -> None:
    """Chi-square over cells of the sphere whose poles are not those of the image."""
    scene = under(random_sky(*size), FLOOR)
    direction = drawn(call_glsl, scene, DRAWS, "light.ray.direction", "vec3")
    rows, columns, fine = 12, 24, 60
    grid = grid_of(rows * fine, columns * fine)
    found = density(call_glsl, scene, grid.reshape(-1, 3)).reshape(rows, fine, columns, fine)
    share = found.mean(axis=(1, 3)) * 4 * np.pi / (rows * columns)
    counts = cells_of(direction, rows, columns, -1.0)
    assert_fits(counts, DRAWS * (share / share.sum()).ravel())


@pytest.mark.parametrize("place", [(3, 2), (0, 0), (15, 7), (15, 3)], ids=str)
def test_a_small_sun_is_all_that_is_sampled(call_glsl: CallGlsl, place: tuple[int, int]) -> None:
    """Inside the image, at both poles, and at the seam: radiance over density hardly varies."""
    scene = under(spot(*place, radiance=1000.0), FLOOR)
    found = drawn(call_glsl, scene, 1 << 16, "vec2(light.radiance.x, light.pdf)", "vec2")
    assert found.min() > 0
    ratio = found[:, 0].astype(np.float64) / found[:, 1]
    sphere_ = grid_of(1000, 1000).reshape(-1, 3)
    truth = sky64(spot(*place, radiance=1000.0), sphere_)[:, 0].mean() * 4 * np.pi
    assert ratio.mean() == pytest.approx(truth, rel=5e-3)
    assert ratio.std() < 0.35 * ratio.mean()


def test_no_table_is_made_of_a_black_image() -> None:
    assert sky_sampling(np.zeros((4, 8, 3), np.float32)).density == 0


def test_a_black_image_lights_nothing(context: Context) -> None:
    scene = under(np.zeros((4, 8, 3), np.float32), FLOOR, camera=ABOVE)
    for method in METHODS:
        assert not rendered(scene, context, 16, method=method, **SMALL).radiance.any()


def sun_sky(column: int = 20, row: int = 5) -> Array:
    """64 x 32 pixels of an even sky, and one that is a thousand times as bright."""
    pixels = np.full((32, 64, 3), 0.5, np.float32)
    pixels[row, column] = 500.0
    return pixels


@pytest.mark.parametrize("method", ["nee", "mis"])
def test_a_sun_of_one_pixel_lights_a_floor_as_a_quadrature_says(
    context: Context, method: str
) -> None:
    scene = under(sun_sky(), FLOOR, camera=ABOVE)
    image = rendered(scene, context, 512, method=method, bounces=1, **SMALL)
    upper = grid_of(1000, 1000).reshape(-1, 3)[:, [0, 2, 1]]
    light = sky64(sun_sky(), upper) * np.maximum(upper[:, 1:2], 0)
    assert_mean(whole(image), 0.5 * 4 * light.mean(axis=0), within=0.02, floor=1e-3)


@pytest.mark.slow
def test_methods_agree_under_a_small_sun(context: Context) -> None:
    """The sun shines on rough glass, a mirror and a matte floor, with shadows."""
    things = [FLOOR, sphere([0, 0.3, 0], 0.3, "mirror"), sphere([0.7, 0.3, 0], 0.3, "frost")]
    pixels = np.full((32, 64, 3), 0.5, np.float32)
    pixels[3:7, 18:24] = 10.0
    lit = under(pixels, FLOOR, camera={**ABOVE, "fov": 60})
    materials: dict[str, Any] = {
        "m": MATTE,
        "mirror": {"type": "metal", "color": [1] * 3, "roughness": 0.4},
    }
    more = scene_of(things, {**materials, "frost": glass(roughness=0.5)})
    scene = lit.model_copy(update={"materials": more.materials, "objects": more.objects})
    naive, nee, mis = (
        rendered(scene, context, 4096, method=method, seed=seed, bounces=4, **SMALL)
        for seed, method in enumerate(METHODS)
    )
    assert_agree(nee, naive, within=0.1)
    assert_agree(mis, naive, within=0.1)


def test_sampling_the_sun_takes_its_noise_away(context: Context) -> None:
    scene = under(sun_sky(), FLOOR, camera=ABOVE)
    naive, mis = (rendered(scene, context, 256, method=m, **SMALL).error for m in ("naive", "mis"))
    assert naive
    assert mis
    assert naive > 5 * mis


def test_all_ways_show_the_same_bits(context: Context) -> None:
    scene = under(sun_sky(), FLOOR, sphere([0, 0.3, 0], 0.3, "m"), camera=ABOVE)
    ways: list[dict[str, Any]] = [{}, {"pipeline": "fragment"}, {"tier": "complete"}]
    found = {rendered(scene, context, 16, **SMALL, **way).radiance.tobytes() for way in ways}
    assert len(found) == 1


@pytest.mark.parametrize("k", [-10, 10])
def test_the_size_of_a_scene_changes_no_bit(context: Context, k: int) -> None:
    def picture(scale: float) -> bytes:
        camera = {"position": [0, scale, scale], "look_at": [0, 0, 0], "fov": 40}
        scene = under(
            sun_sky(), FLOOR, sphere([0, 0.3 * scale, 0], 0.3 * scale, "m"), camera=camera
        )
        return rendered(scene, context, 16, **SMALL).radiance.tobytes()

    assert picture(1.0) == picture(2.0**k)
