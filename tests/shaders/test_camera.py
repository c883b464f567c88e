"""Camera rays against the pinhole and thin-lens formulas, in float64 and from scratch."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.shaders.test_rng import drawn
from tests.support.alarms import assert_near
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.numerics import ULP, Array, length

SIZES = [(64, 64), (1, 1), (7, 5), (37, 3), (2, 129), (1920, 1080)]
SETUP = """
    Sampler rng = make_sampler(seed);
    Ray ray = camera_ray(frame.camera, vec2(frame.size), pixel, rng);"""


def seen_by(camera: dict[str, Any], width: int = 64, height: int = 64) -> Scene:
    """A scene with this camera, whatever it shows."""
    size = {"width": width, "height": height}
    return scene_of([sphere([0, 0, 0], 0.01, "m")], {"m": MATTE}, camera, render=size)


def corners_and_middle(width: int, height: int) -> Array:
    """Pixels (column, row), (n, 2)."""
    columns = sorted({0, width // 3, width // 2, width - 1})
    rows = sorted({0, height // 3, height // 2, height - 1})
    return np.array([(x, y) for x in columns for y in rows], np.float64)


def rays(
    call_glsl: CallGlsl, scene: Scene, pixel: Array, seeds: Array, **more: Any
) -> tuple[Array, Array]:
    """Origin and direction for each pixel and seed, (n, 3) each."""
    args = {"setup": SETUP, "scene": scene, "pixel": pixel, "seed": seeds, **more}
    return call_glsl("ray.origin", "vec3", **args), call_glsl("ray.direction", "vec3", **args)


def view(camera: dict[str, Any]) -> tuple[Array, Array, Array]:
    """Right, up and forward, unit, by Gram and Schmidt."""
    eye, target = (np.array(camera[key], np.float64) for key in ("position", "look_at"))
    forward = (target - eye) / np.linalg.norm(target - eye)
    up = np.array(camera.get("up", [0, 1, 0]), np.float64)
    up -= forward * (up @ forward)
    up /= np.linalg.norm(up)
    return np.cross(forward, up), up, forward


def pinhole(camera: dict[str, Any], width: int, height: int, place: Array) -> Array:
    """Points at distance 1 along the axis, seen at `place` (pixels from the upper left corner)."""
    right, up, forward = view(camera)
    half = np.tan(np.radians(camera["fov"]) / 2)
    unit = 2 * half / height  # of a pixel, which is square
    across = (place[:, :1] - width / 2) * unit * right
    down = (place[:, 1:] - height / 2) * unit * up
    seen: Array = forward + across - down
    return seen


CAMERAS: list[dict[str, Any]] = [
    {"position": [0, 0, 0], "look_at": [0, 0, -1], "fov": 45.0},
    {"position": [3, -2, 5], "look_at": [-1, 4, 2], "fov": 90.0, "up": [0.3, 1, 0.2]},
    {"position": [0, 5, 0], "look_at": [0, 0, 0], "fov": 10.0, "up": [0, 0, -1]},
    {"position": [1, 1, 1], "look_at": [1.5, 1, 1], "fov": 150.0},
]


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("camera", CAMERAS)
def test_rays_follow_the_pinhole_formula(
    call_glsl: CallGlsl, camera: dict[str, Any], size: tuple[int, int]
) -> None:
    pixel = np.repeat(corners_and_middle(*size), 8, axis=0)
    seeds = np.arange(len(pixel), dtype=np.uint32)
    origin, direction = rays(call_glsl, seen_by(camera, *size), pixel, seeds)
    exact = pinhole(camera, *size, pixel + drawn(seeds, 2) / 2**24)
    exact /= np.linalg.norm(exact, axis=1, keepdims=True)
    assert np.all(origin == 0)
    half_width = np.tan(np.radians(camera["fov"]) / 2) * max(1, size[0] / size[1])
    assert np.abs(direction - exact).max() < 3 * ULP * max(1, half_width)  # G31
    assert np.abs(length(direction) - 1).max() < 2 * ULP


def test_rays_of_a_pixel_are_spread_evenly_about_its_centre(call_glsl: CallGlsl) -> None:
    seeds = np.arange(2**16, dtype=np.uint32)
    pixel = np.tile([5.0, 11.0], (len(seeds), 1))
    _, direction = rays(call_glsl, seen_by(CAMERAS[0]), pixel, seeds)
    half = np.tan(np.radians(22.5))
    across = 32 + 32 * direction[:, 0].astype(np.float64) / -direction[:, 2] / half
    down = 32 - 32 * direction[:, 1].astype(np.float64) / -direction[:, 2] / half
    for place, first in ((across, 5), (down, 11)):
        assert place.min() > first - 1e-4
        assert place.max() < first + 1 + 1e-4
        assert_near(place.mean(), first + 0.5, np.sqrt(1 / 12 / 2**16))
        assert_near(place.var(), 1 / 12, np.sqrt(1 / 180 / 2**16))


def test_row_0_is_on_top_and_columns_run_to_the_right(call_glsl: CallGlsl) -> None:
    pixel = np.array([(0, 0), (63, 0), (0, 63), (63, 63)], np.float64)
    looks = {  # towards: the axes that lie to the right and upwards in the picture
        (0, 0, -1): ((1, 0, 0), (0, 1, 0)),
        (0, 0, 1): ((-1, 0, 0), (0, 1, 0)),
        (1, 0, 0): ((0, 0, 1), (0, 1, 0)),
        (-1, 0, 0): ((0, 0, -1), (0, 1, 0)),
    }
    for look_at, (right, up) in looks.items():
        camera = {"position": [0, 0, 0], "look_at": list(look_at), "fov": 60.0}
        seeds = np.zeros(4, np.uint32)
        _, direction = rays(call_glsl, seen_by(camera), pixel, seeds)
        assert (np.sign(direction @ np.array(right))).tolist() == [-1, 1, -1, 1]
        assert (np.sign(direction @ np.array(up))).tolist() == [1, 1, -1, -1]


def test_the_field_of_view_is_the_angle_from_the_upper_to_the_lower_edge(
    call_glsl: CallGlsl,
) -> None:
    for width, height, fov in ((10, 4000, 40.0), (4000, 4000, 120.0), (8000, 2000, 75.0)):
        camera = {"position": [0, 0, 0], "look_at": [0, 0, -1], "fov": fov}
        pixel = np.array([((width - 1) / 2, y) for y in (0, height - 1)])
        seeds = np.zeros(2, np.uint32)
        _, direction = rays(call_glsl, seen_by(camera, width, height), pixel, seeds)
        y, z = direction[:, 1:].astype(np.float64).T
        seen = np.degrees(np.arctan2(y[0], -z[0]) - np.arctan2(y[1], -z[1]))
        assert seen == pytest.approx(fov, abs=0.1)


LENS: dict[str, Any] = {
    "position": [3, -2, 5],
    "look_at": [-1, 4, 2],
    "fov": 50.0,
    "defocus_angle": 12.0,
    "focus_distance": 3.5,
}


def test_rays_through_the_lens_meet_in_the_plane_of_focus(call_glsl: CallGlsl) -> None:
    seeds = np.arange(4096, dtype=np.uint32)
    pixel = np.tile([50.0, 20.0], (len(seeds), 1))
    origin, direction = rays(call_glsl, seen_by(LENS), pixel, seeds)
    focus = 3.5 * pinhole(LENS, 64, 64, pixel + drawn(seeds, 2) / 2**24)
    assert length(np.cross(focus - origin, direction)).max() < 3e-6
    _, _, forward = view(LENS)
    assert np.abs(origin @ forward).max() < 1e-6  # the lens stands upright


def test_the_lens_is_a_disk_of_the_size_reported_and_evenly_filled(call_glsl: CallGlsl) -> None:
    seeds = np.arange(2**16, dtype=np.uint32)
    pixel = np.tile([50.0, 20.0], (len(seeds), 1))
    origin, _ = rays(call_glsl, seen_by(LENS), pixel, seeds)
    right, up, _ = view(LENS)
    radius = 3.5 * np.tan(np.radians(6))  # the full angle of the lens seen from the focus
    x, y = origin @ right / radius, origin @ up / radius
    r2 = x * x + y * y
    assert r2.max() < 1 + 1e-5
    assert r2.max() > 0.999
    root = np.sqrt(len(seeds))
    assert_near(r2.mean(), 1 / 2, np.sqrt(1 / 12) / root)
    assert_near((r2**2).mean(), 1 / 3, np.sqrt(4 / 45) / root)
    for moment in (x, y, x * y, x**2 - y**2):
        assert_near(moment.mean(), 0, 0.5 / root)


def test_the_place_on_the_lens_does_not_follow_the_place_in_the_pixel(call_glsl: CallGlsl) -> None:
    seeds = np.arange(2**16, dtype=np.uint32)
    pixel = np.tile([50.0, 20.0], (len(seeds), 1))
    origin, _ = rays(call_glsl, seen_by(LENS), pixel, seeds)
    jitter = drawn(seeds, 2) / 2**24 - 0.5
    right, up, _ = view(LENS)
    for axis in (right, up):
        for number in jitter.T:
            assert_near(np.corrcoef(origin @ axis, number)[0, 1], 0, 1 / np.sqrt(len(seeds)))


def test_focus_is_by_default_where_the_camera_looks(call_glsl: CallGlsl) -> None:
    there = {**LENS, "focus_distance": float(np.sqrt(16 + 36 + 9))}
    default = {key: value for key, value in LENS.items() if key != "focus_distance"}
    pixel = np.tile([50.0, 20.0], (64, 1))
    seeds = np.arange(64, dtype=np.uint32)
    for found, expected in zip(
        rays(call_glsl, seen_by(default), pixel, seeds),
        rays(call_glsl, seen_by(there), pixel, seeds),
        strict=True,
    ):
        assert_allclose(found, expected, atol=1e-6)


def test_a_lens_of_no_size_gives_the_pinhole_to_the_last_bit(call_glsl: CallGlsl) -> None:
    scene = seen_by(CAMERAS[1], 37, 23)
    pixel = np.tile(corners_and_middle(37, 23), (16, 1))
    seeds = np.arange(len(pixel), dtype=np.uint32)
    without = rays(call_glsl, scene, pixel, seeds)
    compiled_in = rays(call_glsl, scene, pixel, seeds, constants={"HAS_LENS": True})
    for a, b in zip(without, compiled_in, strict=True):
        assert np.array_equal(a, b)


def test_camera_rays_leave_no_shape(call_glsl: CallGlsl) -> None:
    args = {"pixel": np.zeros((4, 2)), "seed": np.arange(4, dtype=np.uint32)}
    found = call_glsl("ray.origin_shape", "int", setup=SETUP, scene=seen_by(LENS), **args)
    assert np.all(found == -1)
    assert not call_glsl("ray.inward", "bool", setup=SETUP, scene=seen_by(LENS), **args).any()
