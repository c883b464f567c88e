"""Light sampling: densities against closed forms of solid angles, and the choice of a lamp."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, lamp, plane, quad, scene_of, sphere
from tests.support.numerics import BELOW_ONE, Array, directions, length, unit_square
from tests.support.packed import packed

LAMPS = {"matte": MATTE, "lamp": lamp(2.0), "bright": lamp(30.0), "dark": lamp(0.0)}
SIDES = 0.7, 1.3  # of the quad lamp, the shorter first: points go by it
BALL = scene_of([sphere([0, 0, -3], 1, "lamp")], LAMPS)
QUAD = scene_of([quad([0, 0, -1], [SIDES[0], 0, 0], [0, SIDES[1], 0], "lamp")], LAMPS)
MANY = scene_of(
    [
        quad([-1, 3, -1], [2, 0, 0], [0, 0, 2], "lamp"),
        sphere([0, 0, -3], 1, "bright"),
        plane([0, -1, 0], [0, 1, 0], "lamp"),  # infinite: never sampled
        sphere([3, 0, 0], 0.5, "lamp"),
        sphere([9, 9, 9], 0.1, "matte"),
        quad([-3, -1, -1], [0, 2, 0], [0, 0, 2], "dark"),
        sphere([-4, 2, 0], 0.25, "lamp"),
    ],
    LAMPS,
)
SETUP = """
    Ray from = Ray(origin, vec3(0.0, 1.0, 0.0), leaves, false);
    float total = total_weight(from);
    int index = choose_light(from, total, vec3(u, 0.0));
    int shape = light_at(index).shape;
    LightSample light = sample_lamp(from, index, v, total);"""


def sampled(call_glsl: CallGlsl, scene: Scene, what: str, returns: str, **inputs: Any) -> Array:
    """Something of the light sampled from `origin`; `u.x` chooses the lamp, `v` the place."""
    n = max(len(values) for values in inputs.values())
    given = {"u": np.zeros((n, 2)), "v": np.full((n, 2), 0.5), "leaves": np.array([-1])}
    return call_glsl(what, returns, setup=SETUP, scene=scene, **{**given, **inputs})


def rectangle_solid_angle(a: float, b: float, height: float) -> float:
    """The solid angle of a rectangle a x b seen from a point above one corner."""
    return float(np.arctan(a * b / (height * np.sqrt(a * a + b * b + height**2))))


# --- spheres -------------------------------------------------------------------------------


def test_the_cone_of_a_sphere_keeps_its_digits_up_to_a_million_radii(call_glsl: CallGlsl) -> None:
    ratio = 10.0 ** np.linspace(0.001, 6, 5000)
    to_center = directions(5000)[:5000] * ratio[:, None]
    found = call_glsl("cone_of_sphere(d, 1.0)", d=to_center)
    sine2 = 1 / length(to_center.astype(np.float32)) ** 2
    exact = sine2 / (1 + np.sqrt(1 - sine2))
    far = ratio > 1.1
    assert_allclose(found[far], exact[far], rtol=1e-6)  # F9 asks for 1e-5
    assert_allclose(found, exact, rtol=2e-3)
    naive = 1 - np.sqrt(1 - np.float32(1e-4) ** 2)
    assert naive == 0 < call_glsl("cone_of_sphere(vec3(1e4, 0.0, 0.0), 1.0)")[0]


def test_the_density_of_a_sphere_lamp_is_one_over_its_solid_angle(call_glsl: CallGlsl) -> None:
    distance = 10.0 ** np.linspace(0.02, 6, 1000)
    origin = np.stack([0 * distance, 0 * distance, distance - 3], axis=-1)
    pdf = sampled(call_glsl, BALL, "light.pdf", "float", origin=origin)
    exact = 1 / (origin[:, 2].astype(np.float32).astype(np.float64) + 3)
    one_minus_cos = exact**2 / (1 + np.sqrt(1 - exact**2))
    assert_allclose(pdf, 1 / (2 * np.pi * one_minus_cos), rtol=2e-5)


@pytest.mark.slow
def test_directions_to_a_sphere_lamp_fill_its_cone_and_hit_it(call_glsl: CallGlsl) -> None:
    v = unit_square(256)
    origin = np.tile([0.4, -0.3, 0.5], (len(v), 1))
    args = {"origin": origin, "v": v}
    ray = sampled(call_glsl, BALL, "light.ray.direction", "vec3", **args).astype(np.float64)
    away = np.array([0, 0, -3]) - origin[0]
    distance = np.linalg.norm(away)
    cosine = ray @ away / distance
    rim = np.sqrt(1 - 1 / distance**2)
    assert cosine.min() > rim - 1e-6
    assert cosine.mean() == pytest.approx((1 + rim) / 2, abs=1e-6)
    assert (cosine**2).mean() == pytest.approx((1 + rim + rim**2) / 3, abs=1e-6)
    assert_allclose(ray.mean(axis=0), away / distance * (1 + rim) / 2, atol=2e-6)
    met = sampled(call_glsl, BALL, "closest_hit(light.ray).shape", "int", **args)
    assert np.mean(met == 0) > 0.999  # except at the very rim
    hit = sampled(
        call_glsl, BALL, "vec2(light.distance, closest_hit(light.ray).distance)", "vec2", **args
    )[met == 0]
    assert np.array_equal(hit[:, 0], hit[:, 1])
    radiance = sampled(call_glsl, BALL, "light.radiance", "vec3", **args)
    assert np.all(radiance == 2)


@pytest.mark.parametrize("depth", [0.0, 0.5, 0.999, 1.0])
def test_a_point_in_or_on_a_sphere_lamp_samples_nothing_of_it(
    call_glsl: CallGlsl, depth: float
) -> None:
    n = directions(1000)[:1000]
    origin = n * np.float32(depth) + np.array([0, 0, -3])
    both = "vec2(light.pdf, pdf_light(0, Ray(origin, direction, leaves, false), 1.0, 1.0))"
    left = -1 if depth < 1 else 0  # a point on it comes from it
    args = {"origin": origin, "direction": directions(1000, 2)[:1000]}
    found = sampled(call_glsl, BALL, both, "vec2", leaves=np.array([left]), **args)
    assert np.all(found == 0)


# --- quads ---------------------------------------------------------------------------------


@pytest.mark.parametrize("height", [0.1, 1.0, 10.0])
def test_densities_of_a_quad_lamp_sum_up_to_its_solid_angle(
    call_glsl: CallGlsl, height: float
) -> None:
    v = unit_square(1024)
    origin = np.tile([0.0, 0.0, height - 1], (len(v), 1))
    pdf = sampled(call_glsl, QUAD, "light.pdf", "float", origin=origin, v=v).astype(np.float64)
    found = (1 / pdf).mean()  # over samples, 1 / pdf is an estimate of the solid angle
    assert found == pytest.approx(rectangle_solid_angle(*SIDES, height), rel=2e-5)


def test_the_density_of_a_quad_lamp_integrates_to_one_over_all_directions(
    call_glsl: CallGlsl,
) -> None:
    side = 1000
    z, turn = (unit_square(side) * 2 - 1).T
    r, phi = np.sqrt(1 - z * z), np.pi * turn
    direction = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
    setup = """Ray ray = Ray(vec3(0.3, 0.2, 0.0), direction, NO_SHAPE, false);
        float distance = quad_distance(ray, quad_at(0));"""
    pdf = call_glsl(
        "distance > 0.0 ? pdf_light(0, ray, distance, total_weight(ray)) : 0.0",
        setup=setup,
        scene=QUAD,
        direction=direction,
    )
    assert pdf.astype(np.float64).mean() * 4 * np.pi == pytest.approx(1, abs=3e-3)


def test_points_of_a_quad_lamp_are_even_and_where_the_ray_meets_it(call_glsl: CallGlsl) -> None:
    v = unit_square(128)
    origin = np.tile([0.3, -2.0, 0.5], (len(v), 1))
    args = {"origin": origin, "v": v}
    ray = sampled(call_glsl, QUAD, "vec4(light.ray.direction, light.distance)", "vec4", **args)
    point = origin + ray[:, :3].astype(np.float64) * ray[:, 3:]
    expected = np.concatenate([v * SIDES, np.full((len(v), 1), -1.0)], axis=1)
    assert_allclose(point, expected, atol=2e-6)
    hit = sampled(call_glsl, QUAD, "closest_hit(light.ray).distance", "float", **args)
    inner = np.all(np.abs(v - 0.5) < 0.49, axis=1)
    assert_allclose(hit[inner], ray[inner, 3], rtol=2e-6)


def test_a_quad_lamp_shines_from_both_sides_and_not_along_itself(call_glsl: CallGlsl) -> None:
    origin = np.array([[0.5, 0.3, 1.0], [0.5, 0.3, -3.0], [3.0, 0.3, -1.0], [0.65, 0.35, -1.0]])
    pdf = sampled(call_glsl, QUAD, "light.pdf", "float", origin=origin)
    assert pdf[0] == pytest.approx(pdf[1], rel=1e-6)
    assert pdf[0] > 0
    assert pdf[2:].tolist() == [0, 0]  # in its plane, and at the very point


# --- all lamps -----------------------------------------------------------------------------


def test_every_lamp_and_its_light_know_each_other() -> None:
    rows = packed(MANY)
    none = {"light": np.full(len(rows["Plane"]), -1)}  # planes are no lamps to be sampled
    own = np.concatenate([part["light"] for part in (rows["Sphere"], none, rows["Quad"])])
    shapes = rows["Light"]["shape"]
    assert shapes.tolist() == [0, 1, 3, 5, 6]  # 2 is matte, 4 the infinite plane
    assert own[shapes].tolist() == [0, 1, 2, 3, 4]
    assert np.all(np.delete(own, shapes) == -1)


def exact_density(rows: dict[str, Array], shape: int, direction: Array, distance: float) -> Array:
    """Per solid angle at the origin, without the choice of a lamp, float64."""
    flat = shape - len(rows["Sphere"]) - len(rows["Plane"])
    if flat < 0:
        ball = rows["Sphere"][shape]
        sine2 = ball["radius"] ** 2 / (ball["center"].astype(np.float64) ** 2).sum()
        return np.full(len(direction), 1 / (2 * np.pi * (1 - np.sqrt(1 - sine2))))
    quad_row = rows["Quad"][flat]
    cosine = np.abs(direction @ quad_row["normal"].astype(np.float64))
    density: Array = distance**2 / (quad_row["width"] * quad_row["height"] * cosine)
    return density


@pytest.mark.slow
def test_a_density_contains_the_choice_and_is_0_for_the_lamp_just_left(
    call_glsl: CallGlsl,
) -> None:
    rows = packed(MANY)
    direction = directions(200)[:200]
    for index, row in enumerate(rows["Light"]):
        left, free = (
            call_glsl(
                f"pdf_light({index}, Ray(vec3(0.0), direction, {shape}, false), 2.5, 1.0)",
                scene=MANY,
                direction=direction,
            )
            for shape in (row["shape"], 4)
        )
        assert np.all(left == 0)
        own = rows["Cluster"][index]
        chance = own["probability"] / max((own["center"] ** 2).sum(), own["reach2"])
        exact = chance * exact_density(rows, row["shape"], direction, 2.5)
        assert_allclose(free, exact, rtol=1e-5)


def test_sampling_and_density_agree_for_every_lamp(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(1)
    n = 50_000
    args = {
        "u": np.minimum(random.uniform(size=(n, 2)), BELOW_ONE),
        "v": random.uniform(size=(n, 2)),
        "origin": random.uniform(-2, 2, (n, 3)),
    }
    setup = (
        "Hit hit = closest_hit(light.ray);"
        "float pdf = pdf_light(index, light.ray, hit.distance, total_weight(from));"
    )
    found = call_glsl(
        "vec4(light.pdf, pdf, hit.shape == shape, light.shape == shape)",
        "vec4",
        setup=SETUP + setup,
        scene=MANY,
        leaves=np.array([-1]),
        **args,
    )
    drawn, evaluated, met, same = found.T
    seen = (met == 1) & (drawn > 0)
    assert seen.mean() > 0.5
    assert np.median(np.abs(evaluated[seen] / drawn[seen] - 1)) < 1e-6
    assert np.quantile(np.abs(evaluated[seen] / drawn[seen] - 1), 0.999) < 1e-4
    assert np.all((same == 1) == (drawn > 0))
