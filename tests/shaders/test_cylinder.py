"""Rays against cylinders, open and closed: float64 and closed forms are the judges."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import glrt
from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene, scene_to_dict
from glrt.scene.shapes.cylinder import Cylinder
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, cylinder, glass, lamp, scene_of
from tests.support.images import same_bits
from tests.support.numerics import ULP, Array, directions, dot, float32, length
from tests.support.packed import packed
from tests.support.renders import METHODS, assert_mean, rendered, whole

FREE = "Ray(origin, direction, NO_SHAPE, false)"
START, END, RADIUS = [-0.4, -0.3, -2.7], [0.5, 0.4, -1.9], 0.45
WHITE = {"type": "lambertian", "color": [1, 1, 1]}
SKY = {"color": [1, 1, 1]}


def one(capped: bool = True, material: dict[str, Any] = MATTE, scale: float = 1.0) -> Scene:
    """A cylinder alone, seen from the origin."""
    start, end = ([scale * c for c in point] for point in (START, END))
    return scene_of([cylinder(start, end, scale * RADIUS, "m", capped)], {"m": material})


def model(scene: Scene) -> Cylinder:
    found = scene.objects[0]
    assert isinstance(found, Cylinder)
    return found


def aimed(n: int, seed: int, far: float = 4.0) -> dict[str, Array]:
    """Rays at points in and around the cylinder, from within and from all around."""
    random = np.random.default_rng(seed)
    target = np.array([0.05, 0.05, -2.3]) + random.uniform(-0.9, 0.9, (n, 3))
    direction = directions(n, seed)[:n]
    origin = target - direction * random.uniform(0, far, (n, 1))
    return {"origin": origin.astype(np.float32), "direction": direction}


def distances64(scene: Scene, origin: Array, direction: Array) -> Array:
    """The distances by the row that the kernel has, in float64."""
    row = packed(scene)["Cylinder"][0]
    rest = [row["half_height"], row["radius"], row["is_capped"]]
    numbers = np.concatenate([row["center"], row["axis"], rest]).astype(np.float64)[None]
    with np.errstate(all="ignore"):
        found = [
            Cylinder.distances(numbers, o, d)[0]
            for o, d in zip(float32(origin), float32(direction), strict=True)
        ]
    return np.array(found)


@pytest.mark.parametrize("capped", [True, False])
def test_cylinders_are_hit_where_float64_says(call_glsl: CallGlsl, capped: bool) -> None:
    scene, rays = one(capped), aimed(10_000, 1)
    found = call_glsl(f"cylinder_distance({FREE}, cylinder_at(0), 3)", scene=scene, **rays)
    exact = distances64(scene, **rays)
    hit = np.isfinite(exact)
    assert 0.2 < hit.mean() < 0.9
    assert np.mean((found > 0) != hit) < 1e-3  # along rims
    both = hit & (found > 0)
    assert np.quantile(np.abs(found / exact - 1)[both], 0.995) < 1e-4


def test_rays_along_and_across_the_axis(call_glsl: CallGlsl) -> None:
    ends = [0, 0, -2], [0, 0, -4]
    origin = np.array([[0, 0, 0], [1, 0, 0], [0, 1.5, 0], [0, 0, -3], [0.5, 0, -3]])
    along = "Ray(origin, vec3(0.0, 0.0, -1.0), NO_SHAPE, false)"
    for capped, truth in ((True, [2, 2, 0, 1, 1]), (False, [0, 0, 0, 0, 0])):
        scene = scene_of([cylinder(*ends, 1.0, "m", capped)], {"m": MATTE})
        args: dict[str, Any] = {"scene": scene, "origin": origin}
        found = call_glsl(f"cylinder_distance({along}, cylinder_at(0), 3)", **args)
        assert found.tolist() == truth
        aside = "Ray(origin + vec3(-3.0, 0.0, -3.0), vec3(1.0, 0.0, 0.0), NO_SHAPE, false)"
        found = call_glsl(f"cylinder_distance({aside}, cylinder_at(0), 3)", **args)
        assert found.tolist() == [2, 1, 0, 0, 0]


def test_a_cylinder_of_twice_the_size_is_hit_twice_as_far(call_glsl: CallGlsl) -> None:
    rays = aimed(10_000, 2)
    distance = f"cylinder_distance({FREE}, cylinder_at(0), 3)"
    for capped in (True, False):
        once = call_glsl(distance, scene=one(capped), **rays)
        for factor in (2.0**-20, 2.0**20):
            moved = {**rays, "origin": np.float32(factor) * rays["origin"]}
            found = call_glsl(distance, scene=one(capped, scale=factor), **moved)
            assert same_bits(found, np.float32(factor) * once)


def gaps(thing: Cylinder, place: Array) -> tuple[Array, Array]:
    """How far points lie outside of the wall, and beyond the ends."""
    offset = place - np.array(thing.middle)
    height = offset @ thing.axis
    aside = length(offset - height[:, None] * thing.axis)
    return aside - thing.radius, np.abs(height) - thing.half


@pytest.mark.parametrize("capped", [True, False])
def test_the_point_hit_lies_on_the_cylinder_and_faces_the_ray(
    call_glsl: CallGlsl, capped: bool
) -> None:
    scene, rays = one(capped), aimed(10_000, 3)
    setup = f"Ray ray = {FREE}; Hit hit = closest_hit(ray); Surface s = surface_at(ray, hit);"
    args: dict[str, Any] = {"setup": setup, "scene": scene, **rays}
    met = call_glsl("hit.shape == 0", "bool", **args)
    p, n = (float32(call_glsl(f"s.{what}", "vec3", **args))[met] for what in ("position", "normal"))
    assert met.sum() > 1500
    wall, ends = gaps(model(scene), p)
    assert np.abs(length(n) - 1).max() < 2 * ULP
    on_wall = np.abs(dot(n, np.broadcast_to(model(scene).axis, n.shape))) < 0.5
    assert np.abs(wall[on_wall]).max() < 16 * ULP
    assert np.abs(ends[~on_wall]).max(initial=0) < 16 * ULP
    assert ends[on_wall].max() < 16 * ULP
    assert wall[~on_wall].max(initial=0) < 1e-4
    assert on_wall.all() != capped
    origin = rays["origin"].astype(np.float64)[met]
    outside = np.maximum(*gaps(model(scene), origin)) > 1e-4
    outward = dot(n, rays["direction"].astype(np.float64)[met]) > 0
    if capped:
        assert np.mean(outward[outside]) < 1e-3, "silhouettes"


LEAVING = """
    Ray camera = Ray(origin, direction, NO_SHAPE, false);
    Surface s = surface_at(camera, closest_hit(camera));
    mat3 around = frame_around(inward == 1 ? -s.normal : s.normal);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    vec3 away = normalized(around * vec3(sine * cos(azimuth), sine * sin(azimuth), cosine));
    Ray ray = Ray(s.position, away, 0, inward == 1);
    Hit hit = closest_hit(ray);
    Surface next = surface_at(ray, hit);"""


def leaving(n: int, inward: bool, rim: bool, capped: bool = True) -> dict[str, Any]:
    """Rays that leave points on the wall or a cap at all angles; some of points at the rim."""
    random = np.random.default_rng(7)
    scene = one(capped)
    thing = model(scene)
    u = np.cross(thing.axis, [0, 0, 1.0])
    u /= np.linalg.norm(u)
    v = np.cross(thing.axis, u)
    angle = random.uniform(0, 2 * math.pi, n)
    out = np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * v
    near = 1 - 1e-6 * random.uniform(0, 1, n)
    aside = np.where(random.random(n) < 0.5, near if rim else random.random(n), 1)
    height = np.where(aside < 1, 1, near if rim else random.uniform(-1, 1, n))
    place = (height * thing.half)[:, None] * thing.axis + (aside * thing.radius)[:, None] * out
    way = np.where((aside < 1)[:, None], thing.axis, out)
    outside = np.array(thing.middle) + place + 0.5 * way
    return {
        "setup": LEAVING,
        "scene": scene,
        "origin": outside,
        "direction": -way,
        "cosine": np.maximum(10.0 ** random.uniform(-5, 0, n), 2.0**-12),
        "azimuth": random.uniform(0, 2 * math.pi, n),
        "inward": np.array([int(inward)]),
    }


@pytest.mark.parametrize("rim", [False, True])
@pytest.mark.parametrize("capped", [False, True])
def test_a_ray_that_leaves_a_cylinder_outwards_never_meets_it_again(
    call_glsl: CallGlsl, capped: bool, rim: bool
) -> None:
    args = leaving(30_000, False, rim, capped)
    met = call_glsl("closest_hit(camera).shape == 0", "bool", **args)
    assert met.mean() > 0.3
    assert np.all(call_glsl("hit.shape", "int", **args)[met] == -1)


@pytest.mark.parametrize("rim", [False, True])
def test_a_ray_into_a_closed_cylinder_ends_on_it_seen_from_inside(
    call_glsl: CallGlsl, rim: bool
) -> None:
    args = leaving(50_000, True, rim)
    met = call_glsl("closest_hit(camera).shape == 0", "bool", **args)
    assert met.mean() > (0.3 if rim else 0.99)
    found = call_glsl("vec2(hit.shape, dot(away, next.normal))", "vec2", **args)[met]
    assert np.all(found[:, 0] == 0), "nothing gets out unseen"
    assert found[:, 1].min() > (-4 * ULP if rim else 0), "tangents at the rim, to rounding"
    place = float32(call_glsl("next.position", "vec3", **args))[met]
    wall, ends = gaps(model(one()), place)
    assert max(wall.max(), ends.max()) < 1e-5


@pytest.mark.parametrize("method", METHODS)
def test_a_round_room_of_light_is_exact(context: Context, method: str) -> None:
    """Walls of emission 1 and albedo 1/2: every path adds 1 + 1/2 + ... and no other light."""
    eye = {"position": [0.1, 0.2, 0.3], "look_at": [0.3, -0.4, -1], "fov": 100}
    room = cylinder([-0.2, -0.6, 0.1], [0.3, 1, 0.4], 1.3, "m")
    scene = scene_of([room], {"m": lamp(1.0, 0.5)}, eye)
    image = rendered(scene, context, 16, method=method, bounces=9, roulette=False)
    assert (image.radiance == 2 - 2.0**-9).all()


def test_no_light_gets_into_a_closed_cylinder(context: Context) -> None:
    eye = {"position": [0.1, 0.2, 0.3], "look_at": [0.3, -0.4, -1], "fov": 100}
    room = cylinder([-0.2, -0.6, 0.1], [0.3, 1, 0.4], 1.3, "m")
    scene = scene_of([room], {"m": WHITE}, eye, background={"color": [1e6] * 3})
    image = rendered(scene, context, 32, bounces=40, roulette=False, width=48, height=48)
    assert image.radiance.max() == 0


@pytest.mark.parametrize("capped", [True, False])
def test_a_white_cylinder_vanishes_under_a_white_sky(context: Context, capped: bool) -> None:
    image = rendered(
        one(capped, WHITE).model_copy(update={"background": glrt.Background(color=(1, 1, 1))}),
        context,
        4,
        bounces=1000,
        roulette=False,
    )
    assert (image.radiance == 1).all()


def test_light_in_glass_is_the_square_of_its_index(context: Context) -> None:
    """Towards a cap, for other rays are caught in it for ever."""
    eye = {"position": [0.2, 0.1, 0], "look_at": [0.2, 0.3, -1], "fov": 30}
    rod = cylinder([0, 0, -1], [0, 0, 1], 1.0, "m")
    scene = scene_of([rod], {"m": glass(1.5)}, eye, background=SKY)
    image = rendered(scene, context, 16, roulette=False, bounces=100, width=16, height=16)
    assert_allclose(image.radiance, 2.25, rtol=1e-5)


@pytest.mark.parametrize("angle", [0.0, 60.0])
def test_a_round_slab_of_glass_lets_through_its_share(context: Context, angle: float) -> None:
    """T = (1 - F) / (1 + F), of light that is reflected to and fro: the far side is bright."""
    ior, sine, cosine = 1.5, math.sin(math.radians(angle)), math.cos(math.radians(angle))
    below = math.sqrt(1 - (sine / ior) ** 2)
    rs = ((cosine - ior * below) / (cosine + ior * below)) ** 2
    rp = ((below - ior * cosine) / (below + ior * cosine)) ** 2
    fresnel = (rs + rp) / 2
    eye = {"position": [2 * sine, 0, 2 * cosine], "look_at": [0, 0, 0], "fov": 0.01}
    things = [
        cylinder([0, 0, -0.1], [0, 0, 0.1], 50.0, "glass"),
        {"shape": "plane", "point": [0, 0, -1], "normal": [0, 0, 1], "material": "lamp"},
    ]
    scene = scene_of(things, {"glass": glass(ior), "lamp": lamp()}, eye)
    image = rendered(scene, context, 128, bounces=100, roulette=False, width=24, height=24)
    assert_mean(whole(image), (1 - fresnel) / (1 + fresnel), within=0.03)


def test_a_cylinder_is_made_in_python_and_in_files() -> None:
    made = glrt.Cylinder(from_=(0, 1, 2), to=[0, 3, 2], radius=0.5, material="m")
    assert made.from_ == (0, 1, 2)
    assert (made.middle, made.half, made.capped) == ((0, 2, 2), 1, True)
    read = scene_of([cylinder([0, 1, 2], [0, 3, 2], 0.5, "m")], {"m": MATTE})
    assert read.objects[0] == made
    assert parse_scene(scene_to_dict(read), "again") == read


@pytest.mark.parametrize(
    ("thing", "message"),
    [
        (cylinder([0, 0, 0], [0, 0, 0], 1, "m"), "from and to are the same point"),
        (
            cylinder([0, 0, 0], [0, 1, 0], 1, "glass", capped=False),
            "an open cylinder encloses nothing",
        ),
        ({"shape": "cylinder", "to": [0, 1, 0], "radius": 1, "material": "m"}, "from is missing"),
    ],
)
def test_a_cylinder_without_volume_is_refused(thing: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=message):
        scene_of([thing], {"m": MATTE, "glass": glass()})
