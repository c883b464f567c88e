"""Rays against boxes: float64 and closed forms are the judges."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.plan.explanation import explain
from glrt.plan.facts import SceneFacts
from glrt.plan.omissions import omissions
from glrt.plan.plan import prepare
from glrt.scene.scene import Scene
from glrt.scene.shapes.box import Box, rotation
from glrt.settings import Settings
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, box, glass, lamp, scene_of
from tests.support.images import same_bits
from tests.support.numerics import ULP, Array, directions, dot, float32, length
from tests.support.packed import packed
from tests.support.renders import METHODS, assert_mean, rendered, whole

FREE = "Ray(origin, direction, NO_SHAPE, false)"
LOW, HIGH, TURN = [-0.5, -0.3, -2.7], [0.7, 0.4, -1.9], [20.0, -35.0, 70.0]
WHITE = {"type": "lambertian", "color": [1, 1, 1]}
SKY = {"color": [1, 1, 1]}


def one(turn: Any = TURN, material: dict[str, Any] = MATTE, scale: float = 1.0) -> Scene:
    """A box alone, seen from the origin."""
    low, high = ([scale * c for c in corner] for corner in (LOW, HIGH))
    return scene_of([box(low, high, "m", turn)], {"m": material})


def model(scene: Scene) -> Box:
    found = scene.objects[0]
    assert isinstance(found, Box)
    return found


def aimed(n: int, seed: int, far: float = 4.0) -> dict[str, Array]:
    """Rays at points in and around the box, from within and from all around."""
    random = np.random.default_rng(seed)
    target = np.array([0.1, 0.05, -2.3]) + random.uniform(-0.9, 0.9, (n, 3))
    direction = directions(n, seed)[:n]
    origin = target - direction * far * random.uniform(0, 1, (n, 1)) ** 4
    return {"origin": origin.astype(np.float32), "direction": direction}


def distances64(scene: Scene, origin: Array, direction: Array) -> Array:
    """The distances by the row that the kernel has, in float64."""
    row = packed(scene)["Box"][0]
    axes = np.array([row[f"axis_{name}"] for name in "xyz"], np.float64)
    half = np.array([row[f"half_{name}"] for name in "xyz"], np.float64)
    numbers = np.concatenate([row["center"].astype(np.float64), half, axes.ravel()])[None]
    with np.errstate(all="ignore"):
        found = [
            Box.distances(numbers, o, d)[0]
            for o, d in zip(float32(origin), float32(direction), strict=True)
        ]
    return np.array(found)


@pytest.mark.parametrize("turn", [TURN, [0, 0, 0]])
def test_boxes_are_hit_where_float64_says(call_glsl: CallGlsl, turn: list[float]) -> None:
    scene, rays = one(turn), aimed(10_000, 1)
    found = call_glsl(f"box_distance({FREE}, box_at(0), 3)", scene=scene, **rays)
    exact = distances64(scene, **rays)
    hit = np.isfinite(exact)
    assert 0.2 < hit.mean() < 0.9
    assert np.mean((found > 0) != hit) < 1e-3  # along edges
    both = hit & (found > 0)
    assert np.quantile(np.abs(found / exact - 1)[both], 0.999) < 1e-4


def test_rays_along_the_axes_and_faces(call_glsl: CallGlsl) -> None:
    scene = scene_of([box([-1, -1, -4], [1, 1, -2], "m")], {"m": MATTE})
    origin = np.array([[0, 0, 0], [1, 1, 0], [1, 0, -3], [1.5, 0, 0], [0, 0, -3], [0, 0, -5]])
    ray = "Ray(origin, vec3(0.0, 0.0, -1.0), NO_SHAPE, false)"
    found = call_glsl(f"box_distance({ray}, box_at(0), 3)", scene=scene, origin=origin)
    assert found[[0, 1, 2, 3, 4]].tolist() == [2, 2, 1, 0, 1]
    assert found[5] <= 0


def test_a_box_of_twice_the_size_is_hit_twice_as_far(call_glsl: CallGlsl) -> None:
    rays = aimed(10_000, 2)
    once = call_glsl(f"box_distance({FREE}, box_at(0), 3)", scene=one(), **rays)
    for factor in (2.0**-20, 2.0**20):
        moved = {**rays, "origin": np.float32(factor) * rays["origin"]}
        found = call_glsl(f"box_distance({FREE}, box_at(0), 3)", scene=one(scale=factor), **moved)
        assert same_bits(found, np.float32(factor) * once)


@pytest.mark.slow
def test_the_point_hit_lies_on_a_face_and_faces_the_ray(call_glsl: CallGlsl) -> None:
    scene, rays = one(), aimed(10_000, 3, far=1e4)
    setup = f"Ray ray = {FREE}; Hit hit = closest_hit(ray); Surface s = surface_at(ray, hit);"
    args: dict[str, Any] = {"setup": setup, "scene": scene, **rays}
    met = call_glsl("hit.shape == 0", "bool", **args)
    inside = call_glsl("cross_box(ray, box_at(0)).enters <= 0.0", "bool", **args)
    p, n = (float32(call_glsl(f"s.{what}", "vec3", **args)) for what in ("position", "normal"))
    thing = model(scene)
    local = (p - np.array(thing.middle)) @ thing.axes.T
    gap = np.abs(np.abs(local) - thing.halves).min(axis=1)
    near = met & (length(p) < 4)
    assert near.sum() > 3000
    assert gap[near].max() < 4 * ULP * 4
    along = float32(call_glsl("ray.origin + hit.distance * ray.direction", "vec3", **args))
    assert length(p - along)[near].max() < 0.01, "and not on another face"
    assert np.abs(length(n[met]) - 1).max() < 2 * ULP
    outward = dot(n, rays["direction"].astype(np.float64)) > 0
    assert np.array_equal(outward[met], inside[met])


LEAVING = """
    Ray camera = Ray(origin, direction, NO_SHAPE, false);
    Surface s = surface_at(camera, closest_hit(camera));
    bool inner = dot(direction, s.normal) > 0.0;
    mat3 around = frame_around(inward == 1 ? -s.normal : s.normal);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    vec3 away = normalized(around * vec3(sine * cos(azimuth), sine * sin(azimuth), cosine));
    Ray ray = Ray(s.position, away, 0, inward == 1);
    Hit hit = closest_hit(ray);
    Surface next = surface_at(ray, hit);"""


def leaving(n: int, inward: bool, edge: bool) -> dict[str, Any]:
    """Rays that leave points on a box at all angles; some of points within rounding of an edge."""
    random = np.random.default_rng(7)
    thing = model(one())
    place = random.uniform(-1, 1, (n, 3))
    place[np.arange(n), random.integers(0, 3, n)] = 1
    if edge:
        place[np.arange(n), random.integers(0, 3, n)] = 1 - ULP * random.integers(-4, 5, n)
    target = np.array(thing.middle) + (place * thing.halves * 0.999999) @ thing.axes
    outside = np.array(thing.middle) + 3 * (place * thing.halves) @ thing.axes
    direction = target - outside
    return {
        "setup": LEAVING,
        "scene": one(),
        "origin": outside,
        "direction": direction / np.linalg.norm(direction, axis=1, keepdims=True),
        "cosine": np.maximum(10.0 ** random.uniform(-5, 0, n), 2.0**-12),
        "azimuth": random.uniform(0, 2 * math.pi, n),
        "inward": np.array([int(inward)]),
    }


@pytest.mark.parametrize("edge", [False, True])
def test_a_ray_that_leaves_a_box_outwards_never_meets_it_again(
    call_glsl: CallGlsl, edge: bool
) -> None:
    found = call_glsl("hit.shape", "int", **leaving(50_000, False, edge))
    assert np.all(found == -1)


@pytest.mark.parametrize("edge", [False, True])
def test_a_ray_into_a_box_ends_on_another_face_seen_from_inside(
    call_glsl: CallGlsl, edge: bool
) -> None:
    args = leaving(50_000, True, edge)
    found = call_glsl("vec2(hit.shape, dot(away, next.normal))", "vec2", **args)
    assert np.all(found[:, 0] == 0), "nothing gets out unseen"
    assert np.all(found[:, 1] > 0)
    place = float32(call_glsl("next.position", "vec3", **args))
    thing = model(one())
    local = np.abs((place - np.array(thing.middle)) @ thing.axes.T) / thing.halves
    assert local.max() < 1 + 1e-5
    if not edge:
        turned = call_glsl("dot(s.normal, next.normal)", **args)
        assert np.mean(turned > 0.5) < 1e-3, "the face just left is not met"


@pytest.mark.parametrize("turn", [[0, 0, 0], TURN])
@pytest.mark.parametrize("method", METHODS)
def test_a_room_of_light_is_exact_and_lets_nothing_out(
    context: Context, method: str, turn: list[float]
) -> None:
    """Walls of emission 1 and albedo 1/2: every path adds 1 + 1/2 + ... and no other light."""
    half = lamp(1.0, 0.5)
    eye = {"position": [0.1, 0.2, 0.3], "look_at": [0.3, -0.4, -1], "fov": 100}
    scene = scene_of([box([-1, -0.5, -2], [1, 1, 1], "m", turn)], {"m": half}, eye)
    image = rendered(scene, context, 16, method=method, bounces=9, roulette=False)
    assert (image.radiance == 2 - 2.0**-9).all()


def test_no_light_gets_into_a_closed_room(context: Context) -> None:
    eye = {"position": [0.1, 0.2, 0.3], "look_at": [0.3, -0.4, -1], "fov": 100}
    room = box([-1, -0.5, -2], [1, 1, 1], "m", TURN)
    scene = scene_of([room], {"m": WHITE}, eye, background={"color": [1e6] * 3})
    image = rendered(scene, context, 32, bounces=40, roulette=False, width=48, height=48)
    assert image.radiance.max() == 0


@pytest.mark.parametrize("turn", [[0, 0, 0], TURN])
def test_a_white_box_vanishes_under_a_white_sky(context: Context, turn: list[float]) -> None:
    scene = scene_of([box(LOW, HIGH, "m", turn)], {"m": WHITE}, background=SKY)
    assert (rendered(scene, context, 4, roulette=False).radiance == 1).all()


def test_a_glass_box_vanishes_under_a_white_sky(context: Context) -> None:
    """Light loses by leaving as much as it gains by entering, to rounding."""
    scene = scene_of([box(LOW, HIGH, "m", TURN)], {"m": glass(1.5)}, background=SKY)
    image = rendered(scene, context, 4, roulette=False, bounces=200, width=48, height=48)
    assert np.abs(image.radiance - 1).max() < 1e-4


def test_light_in_glass_is_the_square_of_its_index(context: Context) -> None:
    """Towards a face, for other rays are caught in the box for ever."""
    eye = {"position": [0.2, 0.1, 0], "look_at": [0.2, 0.3, -1], "fov": 30}
    scene = scene_of([box([-1, -1, -1], [1, 1, 1], "m")], {"m": glass(1.5)}, eye, background=SKY)
    image = rendered(scene, context, 16, roulette=False, bounces=100, width=16, height=16)
    assert_allclose(image.radiance, 2.25, rtol=1e-5)


@pytest.mark.parametrize("ior", [1.3, 1.5, 2.0])
@pytest.mark.parametrize("angle", [0.0, 60.0])
def test_a_slab_of_glass_lets_through_its_share(context: Context, ior: float, angle: float) -> None:
    """T = (1 - F) / (1 + F), of light that is reflected to and fro: the far side is bright."""
    sine, cosine = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    below = math.sqrt(1 - (sine / ior) ** 2)
    rs = ((cosine - ior * below) / (cosine + ior * below)) ** 2
    rp = ((below - ior * cosine) / (below + ior * cosine)) ** 2
    fresnel = (rs + rp) / 2
    eye = {"position": [2 * sine, 0, 2 * cosine], "look_at": [0, 0, 0], "fov": 0.01}
    things = [
        box([-50, -50, -0.1], [50, 50, 0.1], "glass"),
        {"shape": "plane", "point": [0, 0, -1], "normal": [0, 0, 1], "material": "lamp"},
    ]
    scene = scene_of(things, {"glass": glass(ior), "lamp": lamp()}, eye)
    image = rendered(scene, context, 128, bounces=100, roulette=False, width=32, height=32)
    assert_mean(whole(image), (1 - fresnel) / (1 + fresnel), within=0.02)


def test_turns_are_about_x_then_y_then_z() -> None:
    x, y, z = np.eye(3)
    assert np.array_equal(rotation((90, 0, 0)) @ y, z)
    assert np.array_equal(rotation((0, 90, 0)) @ z, x)
    assert np.array_equal(rotation((0, 0, 90)) @ x, y)
    assert np.array_equal(rotation((90, 90, 0)) @ y, x)
    assert np.array_equal(rotation((-90, 360, 450)), rotation((270, 0, 90)))
    turn = rotation((10.0, 20.0, 30.0))
    parts = rotation((0, 0, 30.0)) @ rotation((0, 20.0, 0)) @ rotation((10.0, 0, 0))
    assert_allclose(turn, parts, atol=1e-15)
    assert_allclose(turn @ turn.T, np.eye(3), atol=1e-15)


def test_a_box_without_volume_is_refused() -> None:
    with pytest.raises(SceneError, match="max is not above min along y"):
        scene_of([box([0, 0, 0], [1, 0, 1], "m")], {"m": MATTE})


def test_a_box_as_a_lamp_is_reported_to_be_found_by_scattering() -> None:
    scene = one(material=lamp())
    told = {feature.name: feature.reason for feature in explain(prepare(scene, Settings()))}
    assert told["light sampling"].endswith("1 box lamp (by scattering alone)")
    assert told["boxes"] == "1 box"
    assert "box lamps light nothing" in omissions(SceneFacts(scene), Settings(method="phong"))
