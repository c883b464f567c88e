"""Rays against spheres: float64 on the same inputs is the judge."""

from typing import Any

import numpy as np
from numpy.testing import assert_allclose

from tests.conftest import CallGlsl
from tests.support.numerics import ULP, Array, directions, float32, length, roots64

SPHERE = "Sphere(center, radius, 0, NO_LIGHT)"
FREE = "Ray(origin, direction, NO_SHAPE, false)"
HALF_ULP = ULP / 2


def aimed(distance: Array, beside: Array, scale: Array, seed: int) -> dict[str, Array]:
    """Rays that miss the centres of spheres `distance` radii away, by some radii."""
    random = np.random.default_rng(seed)
    n = len(distance)
    axis, other = random.normal(size=(2, n, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    other = np.cross(axis, other)
    other /= np.linalg.norm(other, axis=1, keepdims=True)
    origin = random.uniform(-1, 1, (n, 3)) * scale[:, None]
    center = origin + (axis * distance[:, None] + other * beside[:, None]) * scale[:, None]
    given = {"center": center, "radius": scale, "origin": origin, "direction": axis}
    return {name: values.astype(np.float32) for name, values in given.items()}


def test_spheres_are_hit_where_float64_says_from_near_and_from_far(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(1)
    n = 200_000
    distance = 10.0 ** random.uniform(0.2, 5, n)
    rays = aimed(distance, random.uniform(0, 1.5, n), 10.0 ** random.uniform(-3, 6, n), 2)
    found = call_glsl(f"sphere_distance({FREE}, {SPHERE}, 3)", **rays)
    exact, beside = roots64(**{name: float32(values) for name, values in rays.items()})
    radius = float32(rays["radius"])
    doubtful = np.abs(beside / radius - 1) < 8 * HALF_ULP * distance  # F4
    assert doubtful.mean() < 0.02
    hit = found > 0
    assert np.array_equal(hit[~doubtful], beside[~doubtful] < radius[~doubtful])
    sure = hit & (beside < 0.95 * radius)
    assert sure.sum() > n / 2
    assert_allclose(found[sure], exact[0][sure], rtol=2e-6)


def test_the_naive_discriminant_would_fail_this(call_glsl: CallGlsl) -> None:
    naive = """float naive_distance(Ray ray, Sphere sphere) {
        vec3 to_center = sphere.center - ray.origin;
        float b = dot(to_center, ray.direction);
        float discriminant = b * b - (dot(to_center, to_center) - sphere.radius * sphere.radius);
        return discriminant > 0.0 ? b - sqrt(discriminant) : 0.0;
    }"""
    n = 50_000
    beside = np.random.default_rng(3).uniform(0, 1.5, n)
    rays = aimed(np.full(n, 1e4), beside, np.ones(n), 4)
    found = call_glsl(f"naive_distance({FREE}, {SPHERE})", functions=naive, **rays)
    assert np.mean((found > 0) != (beside < 1)) > 0.05


def test_from_inside_a_sphere_its_far_wall_is_hit(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(5)
    n = 50_000
    inside = random.uniform(-1, 1, (n, 3)) * 0.55
    rays = {
        "center": np.zeros((n, 3)),
        "radius": np.ones(n),
        "origin": inside,
        "direction": directions(n)[:n],
    }
    found = call_glsl(f"sphere_distance({FREE}, {SPHERE}, 3)", **rays)
    exact, _ = roots64(**{name: float32(values) for name, values in rays.items()})
    assert_allclose(found, exact[1], rtol=3e-6)


def test_a_sphere_behind_is_not_hit(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(6)
    n = 50_000
    rays = aimed(-(10.0 ** random.uniform(0.01, 4, n)), random.uniform(0, 0.99, n), np.ones(n), 7)
    outside = length(rays["center"] - rays["origin"]) > 1.0001
    found = call_glsl(f"sphere_distance({FREE}, {SPHERE}, 3)", **rays)
    assert found[outside].max() <= 0


def test_a_tangent_ray_gives_a_number(call_glsl: CallGlsl) -> None:
    steps = np.arange(-64, 65)
    distance = np.repeat(10.0 ** np.linspace(-1, 5, 200), len(steps))
    beside = np.tile(1 + steps * HALF_ULP, 200)
    rays = aimed(distance, beside, np.ones(len(beside)), 8)
    found = call_glsl(f"sphere_distance({FREE}, {SPHERE}, 3)", **rays)
    assert np.all(np.isfinite(found))
    hit = found > 0
    assert 0.1 < hit.mean() < 0.9
    half_chord = np.sqrt(2 * HALF_ULP * (64 + 16 * distance))
    assert np.all(np.abs(found - distance)[hit] < (half_chord + 2 * ULP * distance)[hit])


LEAVING = f"""
    Sphere ball = {SPHERE};
    vec3 n = normalized(normal);
    Surface surface = Surface(center + radius * n, n, 7, 0, NO_LIGHT);
    float side = inward == 1 ? -1.0 : 1.0;
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    vec3 local = vec3(sine * cos(azimuth), sine * sin(azimuth), cosine);
    vec3 direction = normalized(frame_around(side * n) * local);
    Ray ray = Ray(surface.position, direction, 7, inward == 1);
    float t = sphere_distance(ray, ball, 7);"""


def leaving(n: int, cosine: Array, inward: bool) -> dict[str, Any]:
    """Rays that start on spheres of all sizes, at a cosine to the normal."""
    random = np.random.default_rng(9)
    radius = 10.0 ** random.uniform(-4, 6, n)
    return {
        "setup": LEAVING,
        "radius": radius,
        "center": random.uniform(-100, 100, (n, 3)) * radius[:, None],
        "normal": directions(n)[:n],
        "azimuth": random.uniform(0, 2 * np.pi, n),
        "cosine": cosine,
        "inward": np.array([int(inward)]),
    }


def test_a_ray_that_leaves_a_sphere_outward_never_meets_it_again(call_glsl: CallGlsl) -> None:
    cosine = 10.0 ** np.random.default_rng(10).uniform(-9, 0, 500_000)
    assert np.all(call_glsl("t", **leaving(len(cosine), cosine, False)) == 0)


def test_a_ray_into_a_sphere_ends_on_its_far_side_however_flat(call_glsl: CallGlsl) -> None:
    n = 500_000
    cosine = np.maximum(10.0 ** np.random.default_rng(11).uniform(-4, 0, n), 2.0**-12)
    rays = leaving(n, cosine, True)  # 2^-12: the flattest ray that matte surfaces scatter
    t = call_glsl("t", **rays)
    assert t.min() > 0
    chord = t / rays["radius"].astype(np.float32)
    shift = 1e-4 * 200  # of the start off its sphere, by its distance from the origin
    steep = cosine > np.sqrt(shift)
    assert np.abs(chord / (2 * cosine) - 1)[steep].max() < 1e-2
    near = rays | {"center": rays["center"] / 100}
    steep = cosine > 0.05
    chord = call_glsl("t", **near) / rays["radius"]
    assert np.abs(chord / (2 * cosine) - 1)[steep].max() < 1e-4


def test_a_ray_that_comes_from_elsewhere_may_run_inward_or_not(call_glsl: CallGlsl) -> None:
    ray = "Ray(vec3(0.0, 0.0, 5.0), vec3(0.0, 0.0, -1.0), 8, inward == 1)"
    ball = "Sphere(vec3(0.0), 1.0, 0, NO_LIGHT)"
    found = call_glsl(f"sphere_distance({ray}, {ball}, 7)", inward=np.array([0, 1]))
    assert found.tolist() == [4, 4]
