"""Rays against planes, quads and whole scenes: float64 on the same inputs is the judge."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, disk, plane, quad, scene_of, sphere
from tests.support.numerics import ULP, Array, directions, dot, float32, length, roots64
from tests.support.packed import packed

FREE = "Ray(origin, direction, NO_SHAPE, false)"


# --- planes and quads ----------------------------------------------------------------------


def test_planes_are_hit_where_float64_says(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(12)
    n = 100_000
    scale = 10.0 ** random.uniform(-3, 6, (n, 1))
    rays = {
        "point": random.uniform(-1, 1, (n, 3)) * scale,
        "origin": random.uniform(-1, 1, (n, 3)) * scale,
        "normal": directions(n, 13)[:n],
        "direction": directions(n, 14)[:n],
    }
    found = call_glsl(f"plane_distance({FREE}, point, normal)", **rays)
    p, o, m, d = (float32(rays[name]) for name in ("point", "origin", "normal", "direction"))
    height, approach = dot(p - o, m), dot(d, m)
    exact = height / approach
    doubt = 4 * ULP * (length(p - o) / np.abs(height) + 1 / np.abs(approach))
    assert np.median(doubt) < 5e-6
    assert np.all(np.abs(found / exact - 1) <= doubt)


def test_a_quad_is_hit_inside_its_edges_and_nowhere_else(call_glsl: CallGlsl) -> None:
    corner = np.array([-0.3, 0.2, -2.0])
    u, v = np.array([1.0, 0.2, 0.1]), np.array([0.4, 0.9, -0.3])
    scene = scene_of([quad(corner, u, v, "m")], {"m": MATTE})
    random = np.random.default_rng(15)
    n = 100_000
    st = random.uniform(-0.5, 1.5, (n, 2))
    target = corner + st[:, :1] * u + st[:, 1:] * v
    origin = random.uniform(-1, 1, (n, 3))
    origin[:, 2] += random.choice([1.0, -5.0], n)  # before and behind
    away = np.linalg.norm(target - origin, axis=1)
    direction = (target - origin) / away[:, None]
    args = {"scene": scene, "origin": origin, "direction": direction}
    found = call_glsl(f"quad_distance({FREE}, quad_at(0))", **args)
    inside = np.all((st >= 0) & (st <= 1), axis=1)
    edge = np.min(np.abs(st * (1 - st)), axis=1) < 1e-4
    assert edge.mean() < 2e-3
    assert np.array_equal((found > 0)[~edge], inside[~edge])
    normal = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    sure = inside & ~edge & (np.abs(direction @ normal) > 0.1)
    assert sure.sum() > 10_000
    assert_allclose(found[sure], away[sure], rtol=1e-5)


def test_the_edges_of_a_quad_belong_to_it(call_glsl: CallGlsl) -> None:
    scene = scene_of([quad([0, 0, -1], [1, 0, 0], [0, 1, 0], "m")], {"m": MATTE})
    xy = np.array([(0, 0), (1, 0), (0, 1), (1, 1), (0.5, 0), (-1e-6, 0), (0, 1 + 1e-6)])
    origin = np.concatenate([xy, np.zeros((len(xy), 1))], axis=1)
    ray = "Ray(origin, vec3(0.0, 0.0, -1.0), NO_SHAPE, false)"
    found = call_glsl(f"quad_distance({ray}, quad_at(0))", scene=scene, origin=origin)
    assert found.tolist() == [1, 1, 1, 1, 1, 0, 0]


FLAT = scene_of(
    [
        plane([0, -1, 0], [0, 2, 0], "m"),
        quad([-1, 1, -1], [2, 0, 0], [0, 0, 2], "m"),
    ],
    {"m": MATTE},
)


def test_a_ray_along_a_plane_or_a_quad_meets_neither(call_glsl: CallGlsl) -> None:
    origin = np.array([[0, -1.0, 0], [0, -0.5, 0], [0, 1.0, 0], [0, 1.0, 5]])  # on and off both
    ray = "Ray(origin, vec3(0.0, 0.0, -1.0), NO_SHAPE, false)"
    assert np.all(call_glsl(f"closest_hit({ray}).shape", "int", scene=FLAT, origin=origin) == -1)
    blocked = call_glsl(f"occluded({ray}, FAR, NO_SHAPE)", "bool", scene=FLAT, origin=origin)
    assert not blocked.any()


def test_a_flat_shape_is_not_met_again_by_the_ray_that_leaves_it(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(16)
    n = 100_000
    start = random.uniform(-0.9, 0.9, (n, 3))
    direction = directions(n, 17)[:n]
    for shape, height in ((0, -1.0), (1, 1.0)):
        start[:, 1] = height + random.uniform(-1, 1, n) * 1e-6  # rounded to either side
        args = {"scene": FLAT, "origin": start, "direction": direction, "left": np.array([shape])}
        ray = "Ray(origin, direction, left, false)"
        met = call_glsl(f"closest_hit({ray}).shape", "int", **args)
        assert set(met.tolist()) == {-1, 1 - shape}


# --- scenes --------------------------------------------------------------------------------


def mixed_scene(seed: int) -> Scene:
    """Spheres, planes and quads at random around the camera."""
    random = np.random.default_rng(seed)
    spheres = [sphere(random.uniform(-3, 3, 3), random.uniform(0.2, 1), "m") for _ in range(6)]
    quads = [quad(c, u, v, "m") for c, u, v in random.uniform(-3, 3, (4, 3, 3))]
    planes = [plane(n * random.uniform(3, 4), n, "m") for n in random.normal(size=(3, 3))]
    return scene_of([*spheres, *quads, *planes], {"m": MATTE})


def distances64(scene: Scene, origin: Array, direction: Array) -> Array:
    """The distance of every shape from every ray, inf for none, (shapes, n)."""
    rows = packed(scene)
    found = []
    for ball in rows["Sphere"]:
        center = ball["center"].astype(np.float64)
        radius = np.full(len(origin), ball["radius"], np.float64)
        (near, far), _ = roots64(center, radius, origin, direction)
        found.append(np.where(near > 0, near, far))
    for flat in [*rows["Plane"], *rows["Quad"]]:
        point = flat["point" if "point" in flat.dtype.names else "corner"].astype(np.float64)
        normal = flat["normal"].astype(np.float64)
        t = dot(point - origin, normal) / dot(direction, normal)
        if "corner" in flat.dtype.names:
            p = origin + t[:, None] * direction - point
            st = np.stack([p @ flat["dual_u"].astype(np.float64), p @ flat["dual_v"]])
            t = np.where(np.all((st >= 0) & (st <= 1), axis=0), t, np.inf)
        found.append(t)
    distances = np.array(found)
    return np.where(distances > 0, distances, np.inf)


@pytest.mark.parametrize("seed", [1, 2])
def test_the_closest_shape_is_the_one_that_float64_finds(call_glsl: CallGlsl, seed: int) -> None:
    scene = mixed_scene(seed)
    n = 100_000
    random = np.random.default_rng(seed)
    args = {"origin": random.uniform(-3, 3, (n, 3)), "direction": random.normal(size=(n, 3))}
    args["direction"] /= np.linalg.norm(args["direction"], axis=1, keepdims=True)
    shape = call_glsl(f"closest_hit({FREE}).shape", "int", scene=scene, **args)
    distance = call_glsl(f"closest_hit({FREE}).distance", scene=scene, **args)
    exact = distances64(scene, float32(args["origin"]), float32(args["direction"]))
    nearest = np.where(np.isfinite(exact.min(axis=0)), exact.argmin(axis=0), -1)
    assert np.mean(shape != nearest) < 1e-4  # silhouettes and edges
    same = (shape == nearest) & (shape >= 0)
    assert same.mean() > 0.7
    wrong = np.abs(distance / exact.min(axis=0) - 1)[same]
    assert np.quantile(wrong, 0.99) < 1e-5
    limit = random.uniform(0, 6, n)
    blocked = call_glsl(
        f"occluded({FREE}, limit, NO_SHAPE)", "bool", scene=scene, limit=limit, **args
    )
    assert np.array_equal(blocked, distance < limit.astype(np.float32))  # F5


@pytest.mark.parametrize(
    ("objects", "lamp", "beyond"),
    [
        ([sphere([0, 0, -2], 0.5, "m"), sphere([0, 0, -4], 0.5, "m")], 0, 3.5),
        ([sphere([0, 0, -4], 0.5, "m"), sphere([0, 0, -2], 0.5, "m")], 1, 3.5),
        ([quad([-1, -1, -2], [2, 0, 0], [0, 2, 0], "m"), plane([0, 0, -5], [0, 0, 1], "m")], 1, 5),
        ([quad([-1, -1, -z], [2, 0, 0], [0, 2, 0], "m") for z in (2, 3)], 0, 3),
        ([quad([-1, -1, -2], [2, 0, 0], [0, 2, 0], "m"), sphere([0, 0, -4], 0.5, "m")], 1, 3.5),
    ],
)
def test_a_shadow_ray_looks_past_its_lamp_alone(
    call_glsl: CallGlsl, objects: list[dict[str, Any]], lamp: int, beyond: float
) -> None:
    args = {"scene": scene_of(objects, {"m": MATTE}), "limit": beyond + np.array([-0.01, 0.01])}
    ray = "Ray(vec3(0.0), vec3(0.0, 0.0, -1.0), NO_SHAPE, false)"
    found = call_glsl(f"occluded({ray}, limit, {lamp})", "bool", **args)
    assert found.tolist() == [False, True]
    assert call_glsl(f"occluded({ray}, limit, NO_SHAPE)", "bool", **args).all()


def test_of_two_shapes_at_the_same_place_the_first_is_hit(call_glsl: CallGlsl) -> None:
    twice = [sphere([0, 0, -3], 1, "m"), sphere([0, 0, -3], 1, "m")]
    ray = "Ray(vec3(0.0), vec3(0.0, 0.0, -1.0), NO_SHAPE, false)"
    for objects in (twice, [quad([-1, -1, -2], [2, 0, 0], [0, 2, 0], "m")] * 2):
        scene = scene_of(objects, {"m": MATTE})
        assert call_glsl(f"closest_hit({ray}).shape", "int", scene=scene).tolist() == [0]


def test_a_point_that_was_hit_lies_on_its_shape(call_glsl: CallGlsl) -> None:
    scene = mixed_scene(3)
    n = 100_000
    random = np.random.default_rng(18)
    args = {"origin": random.uniform(-3, 3, (n, 3)), "direction": directions(n, 19)[:n]}
    setup = f"Ray ray = {FREE}; Hit hit = closest_hit(ray);"
    setup += "Surface surface = surface_at(ray, hit);"
    hit = call_glsl("vec2(hit.shape, hit.distance)", "vec2", setup=setup, scene=scene, **args)
    position = call_glsl("surface.position", "vec3", setup=setup, scene=scene, **args)
    normal = call_glsl("surface.normal", "vec3", setup=setup, scene=scene, **args)
    shape = hit[:, 0].astype(int)
    rows = packed(scene)
    balls, flats = rows["Sphere"], [*rows["Plane"], *rows["Quad"]]
    for number in range(len(balls) + len(flats)):
        on = (shape == number) & (hit[:, 1] < 20)
        p, m = float32(position[on]), float32(normal[on])
        assert len(p) > 50
        assert np.abs(length(m) - 1).max() < 2 * ULP
        if number < len(balls):
            out = p - balls[number]["center"]
            assert np.abs(length(out) / balls[number]["radius"] - 1).max() < 1e-5
            assert_allclose(out / length(out)[:, None], m, atol=1e-5)
        else:
            flat = flats[number - len(balls)]
            point = flat["point" if "point" in flat.dtype.names else "corner"]
            assert np.abs(dot(p - point, m)).max() < 1e-5
            assert np.all(normal[on] == flat["normal"])
        along = float32(args["origin"][on]) + hit[on, 1:] * float32(args["direction"][on])
        assert np.abs(along - p).max() < 1e-4


@pytest.mark.parametrize(
    "thing",
    [
        sphere([0, 0, 0], 1, "m"),
        plane([0, 0.1, 0], [3, 5, -2], "m"),
        quad([-0.7, -0.3, 0.1], [1, 0.2, 0.3], [-0.1, 0.9, 0.2], "m"),
        disk([-0.2, 0.1, 0.1], [0.2, 0.3, -1], 0.7, "m"),
    ],
    ids=["sphere", "plane", "quad", "disk"],
)
def test_a_point_that_was_hit_from_afar_lies_on_its_shape_to_the_last_digits(
    call_glsl: CallGlsl, thing: dict[str, Any]
) -> None:
    n = 20_000
    target = np.random.default_rng(20).uniform(-0.5, 0.5, (n, 3))
    direction = directions(n, 21)[:n]
    setup = f"Ray ray = {FREE}; Hit hit = closest_hit(ray);"
    scene = scene_of([thing], {"m": MATTE})
    args: dict[str, Any] = {
        "scene": scene,
        "origin": target - 1e4 * direction,
        "direction": direction,
    }
    met = call_glsl("hit.shape == 0", "bool", setup=setup, **args)
    found = call_glsl("surface_at(ray, hit).position", "vec3", setup=setup, **args)
    p = found[met & (length(found) < 10)].astype(np.float64)
    assert len(p) > n / 10
    if thing["shape"] == "sphere":
        assert np.abs(length(p) - 1).max() < 2 * ULP
    else:
        row = packed(scene)[thing["shape"].capitalize()][0]
        point = row[row.dtype.names[0]].astype(np.float64)
        assert np.abs(dot(p - point, row["normal"].astype(np.float64))).max() < 40 * ULP
