"""Rays against disks, and disks as lamps: float64 and closed forms are the judges."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, disk, lamp, plane, scene_of
from tests.support.images import same_bits
from tests.support.numerics import ULP, Array, directions, dot, float32, length, unit_square
from tests.support.renders import METHODS, assert_mean, rendered, whole

FREE = "Ray(origin, direction, NO_SHAPE, false)"
DISK = "Disk(center, 0, normal, radius, NO_LIGHT)"


def rays(n: int, seed: int) -> dict[str, Array]:
    """Rays of all sizes at points in and around disks, and what they aim at in radii."""
    random = np.random.default_rng(seed)
    scale = 10.0 ** random.uniform(-3, 6, n)
    normal = directions(n, seed)[:n].astype(np.float64)
    center = random.uniform(-1, 1, (n, 3)) * scale[:, None]
    across = np.cross(normal, random.normal(size=(n, 3)))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    share = random.uniform(0, 1.5, n)
    target = center + (share * scale)[:, None] * across
    direction = directions(n, seed + 1)[:n].astype(np.float64)
    origin = target - direction * (scale * random.uniform(0.1, 10, n))[:, None]
    return {
        "center": center,
        "normal": normal,
        "radius": scale,
        "origin": origin,
        "direction": direction,
    }


def test_disks_are_hit_where_float64_says(call_glsl: CallGlsl) -> None:
    given = rays(50_000, 1)
    found = call_glsl(f"disk_distance({FREE}, {DISK})", **given)
    c, m, o, d = (float32(given[name]) for name in ("center", "normal", "origin", "direction"))
    radius = float32(given["radius"])
    exact = dot(c - o, m) / dot(d, m)
    share = length(o + exact[:, None] * d - c) / radius
    steep = np.abs(dot(d, m)) > 0.05
    sure = steep & (np.abs(share - 1) > 1e-4)
    assert sure.mean() > 0.9
    assert np.array_equal((found > 0)[sure], (share < 1)[sure])
    hit = sure & (share < 1)
    assert_allclose(found[hit], exact[hit], rtol=1e-4)


def test_a_disk_of_twice_the_size_is_hit_twice_as_far(call_glsl: CallGlsl) -> None:
    given = {name: values.astype(np.float32) for name, values in rays(20_000, 2).items()}
    once = call_glsl(f"disk_distance({FREE}, {DISK})", **given)
    for factor in (np.float32(2.0**-20), np.float32(2.0**20)):
        lengths = {name: factor * given[name] for name in ("center", "radius", "origin")}
        found = call_glsl(f"disk_distance({FREE}, {DISK})", **{**given, **lengths})
        assert same_bits(found, factor * once)


def test_the_rim_belongs_to_a_disk_and_a_ray_along_it_does_not(call_glsl: CallGlsl) -> None:
    scene = scene_of([disk([0, 0, -1], [0, 0, 3], 1, "m")], {"m": MATTE})
    origin = np.array([[1, 0, 0], [0, -1, 0], [0, 0, 0], [1 + 1e-6, 0, 0]])
    ray = "Ray(origin, vec3(0.0, 0.0, -1.0), NO_SHAPE, false)"
    found = call_glsl(f"disk_distance({ray}, disk_at(0))", scene=scene, origin=origin)
    assert found.tolist() == [1, 1, 1, 0]
    along = "Ray(origin, vec3(1.0, 0.0, 0.0), NO_SHAPE, false)"
    origin = np.array([[-3, 0, -1.0], [0, 0, -1.0], [-3, 0, -0.5]])
    assert np.all(call_glsl(f"closest_hit({along}).shape", "int", scene=scene, origin=origin) == -1)


def test_a_ray_does_not_meet_the_disk_that_it_leaves(call_glsl: CallGlsl) -> None:
    scene = scene_of([disk([0, 0.3, 0], [0.2, 1, 0.1], 2, "m")], {"m": MATTE})
    n = 20_000
    start = np.random.default_rng(3).uniform(-1, 1, (n, 3)) * [1, 1e-6, 1] + [0, 0.3, 0]
    args = {"scene": scene, "origin": start, "direction": directions(n, 4)[:n]}
    ray = "Ray(origin, direction, 0, false)"
    assert np.all(call_glsl(f"closest_hit({ray}).shape", "int", **args) == -1)


@pytest.mark.parametrize("height", [0.3, 1.0, 1000.0])
def test_the_density_is_that_of_even_points_in_solid_angle(
    call_glsl: CallGlsl, height: float
) -> None:
    """The mean of 1 / density is the solid angle: 2 PI (1 - cos) on the axis."""
    scene = scene_of([disk([0, height, 0], [0, -2, 0], 1.0, "lamp")], {"lamp": lamp()})
    ray = "Ray(vec3(0.0), vec3(0.0), NO_SHAPE, false)"
    setup = f"LightSample found = sample_lamp({ray}, 0, u, 1.0);"
    pdf = call_glsl("found.pdf", setup=setup, scene=scene, u=unit_square(256))
    cosine = height / math.hypot(height, 1)
    truth = 2 * math.pi * (1 / (height**2 + 1)) / (1 + cosine)
    assert np.mean(1 / pdf.astype(np.float64)) == pytest.approx(truth, rel=1e-3)
    place = call_glsl("found.ray.direction * found.distance", "vec3", setup, "", scene, u=corners())
    assert np.abs(place[:, 1] / height - 1).max() < 4 * ULP
    assert length(place[:, [0, 2]]).max() <= 1 + 4 * ULP


def corners() -> Array:
    ends = [0.0, 0.25, 0.5, 1 - 2.0**-24]
    return np.array([(x, y) for x in ends for y in ends])


FLOOR = plane([0, 0, 0], [0, 1, 0], "floor")
MATERIALS = {"floor": MATTE, "lamp": lamp(2.0)}  # albedo 0.5 under radiance 2: L is the form factor


def form_factor(height: float, radius: float, aside: float) -> float:
    """The form factor of a disk parallel to the surface, `aside` from the point's normal."""
    if aside == 0:
        return radius**2 / (radius**2 + height**2)
    h, r = height / aside, radius / aside
    z = 1 + h * h + r * r
    return 0.5 * (1 - (z - 2 * r * r) / math.sqrt(z * z - 4 * r * r))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("aside", "facing"), [(0.0, 1), (0.7, -1), (1.5, 1)])
def test_a_round_lamp_lights_the_floor_by_its_form_factor(
    context: Context, aside: float, facing: int, method: str
) -> None:
    panel = disk([0, 1.0, aside], [0, facing, 0], 0.8, "lamp")
    eye = {"position": [-2, 1, 0], "look_at": [0, 0, 0], "fov": 0.01}
    scene = scene_of([FLOOR, panel], MATERIALS, eye)
    samples = 512 if method == "naive" else 128
    image = rendered(scene, context, samples, method=method, bounces=1, width=24, height=24)
    assert_mean(whole(image), form_factor(1.0, 0.8, aside), within=0.04)


@pytest.mark.parametrize("seen_from", [1, -1])
def test_a_white_disk_vanishes_under_a_white_sky(context: Context, seen_from: int) -> None:
    white = {"type": "lambertian", "color": [1, 1, 1]}
    scene = scene_of(
        [disk([0, 0, 0], [0.1, 0.2, 1], 1, "white")],
        {"white": white},
        {"position": [0, 0, 3 * seen_from], "look_at": [0, 0, 0]},
        background={"color": [1, 1, 1]},
    )
    assert (rendered(scene, context, 4, roulette=False, width=32, height=32).radiance == 1).all()


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("seen_from", [1, -1])
def test_both_sides_of_a_disk_shine_and_scatter(
    context: Context, seen_from: int, method: str
) -> None:
    """Two disks face each other; from either side the lamp's light falls on the white one."""
    things = [disk([0, 0, 0], [0, 1, 0], 9, "floor"), disk([0, seen_from, 0], [0, 1, 0], 1, "lamp")]
    eye = {"position": [-2, seen_from, 0], "look_at": [0, 0, 0], "fov": 0.01}
    scene = scene_of(things, MATERIALS, eye)
    samples = 512 if method == "naive" else 128
    image = rendered(scene, context, samples, method=method, bounces=1, width=16, height=16)
    assert_mean(whole(image), 0.5, within=0.06)
