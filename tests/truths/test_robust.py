"""Where path tracers lose their digits: extreme sizes and distances, grazing rays, and many
bounces. Each test says what must hold, at which extreme, and what a simpler form would give.
"""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from tests.conftest import CallGlsl
from tests.shaders.test_camera import pinhole
from tests.shaders.test_rng import drawn
from tests.support.builders import MATTE, lamp, plane, scene_of, sphere
from tests.support.numerics import ULP, directions, float32, length, roots64
from tests.support.renders import METHODS, assert_mean, rendered, whole

HALF_ULP = ULP / 2
SQUARE = {"width": 256, "height": 256}
FREE = "Ray(origin, direction, NO_SHAPE, false)"


# --- spheres -------------------------------------------------------------------------------


@pytest.mark.parametrize("power", [1, 2, 3, 4, 5, 6])
def test_distance_of_a_huge_ground_ball_is_known_to_a_rounding_of_its_radius(
    call_glsl: CallGlsl, power: int
) -> None:
    """R 2^-24 / h at the height h above a ball of radius R, however the roots are written: its
    centre is rounded to that. At R = 1e6 h it is some 10 %; glrt warns above 1e4 h.
    """
    n = 20_000
    height, radius = 1.0, 10.0**power
    direction = directions(n, 3)[:n]
    direction[:, 1] = -np.abs(direction[:, 1]) - np.float32(0.2)
    direction /= length(direction)[:, None].astype(np.float32)
    args = {"origin": np.zeros((n, 3)), "direction": direction}
    ball = "Sphere(vec3(0.0, center, 0.0), radius, 0, NO_LIGHT)"
    center = np.array([-radius - height])
    found = call_glsl(
        f"sphere_distance({FREE}, {ball}, 3)", center=center, radius=np.array([radius]), **args
    )
    centers = np.tile([0, -radius - height, 0], (n, 1))
    exact, _ = roots64(centers, np.full(n, radius), np.zeros((n, 3)), float32(direction))
    hit = np.isfinite(exact[0])
    assert hit.mean() > 0.3
    assert np.all(np.isfinite(found))
    wrong = np.abs(found / exact[0] - 1)[hit]
    assert wrong.max() <= 16 * max(radius * HALF_ULP / height, HALF_ULP)


def test_balls_of_all_sizes_are_hit_from_a_hundred_thousand_radii(call_glsl: CallGlsl) -> None:
    """Hit or miss as in float64, except rays that pass the rim closer than their own rounding."""
    random = np.random.default_rng(7)
    n = 200_000
    radius = 10.0 ** random.uniform(-4, 6, n)
    direction = directions(n, 8)[:n]
    side = np.cross(direction, directions(n, 9)[:n])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    miss = random.uniform(0, 1.5, n)
    center = radius[:, None] * (1e5 * direction + miss[:, None] * side)
    args = {"center": center, "radius": radius, "origin": np.zeros((n, 3)), "direction": direction}
    found = call_glsl(f"sphere_distance({FREE}, Sphere(center, radius, 0, NO_LIGHT), 3)", **args)
    exact, beside = roots64(**{name: float32(values) for name, values in args.items()})
    doubtful = np.abs(beside / float32(radius) - 1) < 8 * HALF_ULP * 1e5
    assert doubtful.mean() < 0.1
    assert np.array_equal((found > 0)[~doubtful], (beside < float32(radius))[~doubtful])
    hit = (found > 0) & ~doubtful
    assert_allclose(found[hit], exact[0][hit], rtol=1e-6)


@pytest.mark.parametrize("radius", [1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6])
@pytest.mark.parametrize("method", METHODS)
def test_room_of_any_size_keeps_its_sum(context: Context, radius: float, method: str) -> None:
    """2 - 2^-B to the last bit: no ray misses the wall that it leaves, none meets it at once."""
    room = sphere([0, 0, 0], radius, "glow")
    eye = {
        "position": [0.31 * radius, -0.17 * radius, 0.23 * radius],
        "look_at": [-0.6 * radius, 0.5 * radius, -radius],
        "fov": 90,
    }
    scene = scene_of([room], {"glow": lamp(1.0, 0.5)}, eye)
    image = rendered(scene, context, 8, bounces=12, method=method, roulette=False)
    assert (image.radiance == 2 - 2.0**-12).all()


@pytest.mark.parametrize("offset", [1e3, 1e6])
@pytest.mark.parametrize("radius", [1e-4, 1.0, 1e4])
def test_ball_on_a_floor_far_from_the_origin_is_lit_as_at_home(
    context: Context, radius: float, offset: float
) -> None:
    """The point where a ball of radius r rests sees nothing of a white sky. At the distance
    2r from it, the ball hides (1/sqrt(5))^2 / sqrt(5) of the sky.
    """
    away = [offset, 0.3 * offset, -0.7 * offset]
    at = [away[0] + 2 * radius, away[1], away[2]]
    ball = sphere([away[0], away[1] + radius, away[2]], radius, "black")
    eye = {
        "position": [at[0] + 2 * radius, at[1] + radius, at[2]],
        "look_at": at,
        "fov": 0.1,
    }
    materials = {"floor": MATTE, "black": {"type": "lambertian", "color": [0, 0, 0]}}
    scene = scene_of(
        [plane(away, [0, 1, 0], "floor"), ball], materials, eye, background={"color": [1, 1, 1]}
    )
    image = rendered(scene, context, 512, bounces=1, width=32, height=32)
    assert_mean(whole(image), 0.5 * (1 - ball_next_to(1 / 5, 1 / math.sqrt(5))), within=0.005)


def ball_next_to(s2: float, cosine: float) -> float:
    """Form factor of a ball that touches the horizon: its rim lies on it, none is cut off."""
    return s2 * cosine


# --- flat shapes ---------------------------------------------------------------------------


def test_rays_along_a_plane_give_numbers_or_no_hit(call_glsl: CallGlsl) -> None:
    """Down to an approach of 1e-38: far away, or beyond all numbers, but never at a NaN."""
    slope = np.concatenate([10.0 ** -np.arange(0, 45), -(10.0 ** -np.arange(0, 45)), [0.0, -0.0]])
    direction = np.stack([np.sqrt(1 - np.minimum(slope**2, 1)), slope, 0 * slope], axis=-1)
    scene = scene_of([plane([0, -1, 0], [0, 1, 0], "m")], {"m": MATTE})
    setup = f"Ray ray = {FREE}; Hit hit = closest_hit(ray);"
    args = {"scene": scene, "setup": setup, "direction": direction}
    args["origin"] = np.zeros((len(slope), 3))
    shape, distance = call_glsl("vec2(hit.shape, hit.distance)", "vec2", **args).T
    assert np.all(np.isfinite(distance))
    down = direction.astype(np.float32)[:, 1] < -3e-38  # beyond, 1 / slope is no number
    assert np.all(shape[down] == 0)
    assert np.all(shape[direction[:, 1] >= 0] == -1)
    assert_allclose(distance[down], -1 / float32(direction)[down, 1], rtol=1e-6)


def test_grazing_floor_is_lit_evenly_to_the_horizon(context: Context) -> None:
    """Under a white sky a matte floor shows its albedo in every row, the horizon's included."""
    floor = plane([0, 0, 0], [0, 1, 0], "floor")
    eye = {"position": [0, 1e-3, 0], "look_at": [1, 1e-3, 0], "fov": 1e-3}
    scene = scene_of([floor], {"floor": MATTE}, eye, background={"color": [1, 1, 1]})
    image = rendered(scene, context, 16, width=8, height=64)
    lower = image.radiance[33:, :, 0]
    assert (lower == 0.5).all()
    assert (image.radiance[:31] == 1).all()


# --- many bounces --------------------------------------------------------------------------


def test_closed_white_room_ends_at_its_bounce_limit(context: Context) -> None:
    """Albedo 1: each of 1000 bounces brings 1, and roulette has nobody to end."""
    room = sphere([0, 0, 0], 1, "glow")
    scene = scene_of([room], {"glow": lamp(1.0, 1.0)}, {"position": [0.3, 0.1, 0.2]})
    for roulette in (False, True):
        image = rendered(scene, context, 2, bounces=1000, roulette=roulette)
        assert (image.radiance == 1001).all()


# --- frames --------------------------------------------------------------------------------


@pytest.mark.parametrize("fov", [1e-3, 0.01, 1.0, 120.0, 179.0, 179.9])
def test_rays_are_right_at_any_field_of_view(call_glsl: CallGlsl, fov: float) -> None:
    """Within 4 roundings of a direction, or of the frame where that is coarser. A pixel narrower
    than a direction's rounding is a caution (glrt/scene/warnings.py).
    """
    camera = {"position": [3, -2, 5], "look_at": [-1, 4, 2], "up": [0.3, 1, 0.2], "fov": fov}
    scene = scene_of([sphere([0, 0, 0], 0.01, "m")], {"m": MATTE}, camera, render=SQUARE)
    random = np.random.default_rng(3)
    pixel = random.integers(0, 256, (4096, 2)).astype(float)
    seeds = np.arange(len(pixel), dtype=np.uint32)
    setup = """Sampler rng = make_sampler(seed);
        Ray ray = camera_ray(frame.camera, vec2(frame.size), pixel, rng);"""
    found = call_glsl("ray.direction", "vec3", setup=setup, scene=scene, pixel=pixel, seed=seeds)
    exact = pinhole(camera, 256, 256, pixel + drawn(seeds, 2) / 2**24)
    distance = np.linalg.norm(exact, axis=1, keepdims=True)
    exact /= distance
    coarse = 4 * HALF_ULP * np.maximum(1, math.tan(math.radians(fov) / 2) / distance)
    assert np.all(np.abs(found - exact) <= coarse)


@pytest.mark.parametrize("size", [(1, 1), (7, 5), (1, 4096), (8191, 1), (9, 16)])
def test_every_pixel_of_any_frame_is_filled(context: Context, size: tuple[int, int]) -> None:
    width, height = size
    scene = scene_of([sphere([0, 0, 0], 1, "glow")], {"glow": lamp(1.0, 0.5)})
    image = rendered(scene, context, 2, width=width, height=height, bounces=3, roulette=False)
    assert image.radiance.shape == (height, width, 3)
    assert (image.radiance == 1.875).all()
