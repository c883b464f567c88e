"""Spheres found by the tree: the same hits, shadows and pictures as one by one."""

from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.plan import facts
from glrt.plan.facts import SPHERES_FROM
from glrt.scene.scene import Scene
from glrt.settings import Cost
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.mixed_scene import EYE, MATERIALS, OBJECTS, everything
from tests.support.packed import packed
from tests.support.renders import rendered, rendering, same

Array = np.ndarray[Any, Any]


# --- rays ------------------------------------------------------------------------------------


def balls(count: int, seed: int, spread: float = 2.0) -> list[dict[str, Any]]:
    """Overlapping balls of very different sizes, some of them twice or thrice."""
    rng = np.random.default_rng(seed)
    center = rng.uniform(-spread, spread, (count, 3)).round(3)
    radius = 10 ** rng.uniform(-2, -0.3, count)
    center[count // 2 :: 7], radius[count // 2 :: 7] = center[0], radius[0]
    center[count // 2 + 1 :: 9], radius[count // 2 + 1 :: 9] = center[1], radius[1]
    names = ["white", "red", "glass", "brass"]
    return [sphere(c, r, names[i % 4]) for i, (c, r) in enumerate(zip(center, radius, strict=True))]


CROWD = scene_of(balls(300, 5), MATERIALS)
COUNT = 4096
NEAR = 1.0


def rays(kind: str) -> dict[str, Any]:
    """Origins, directions, and the sphere that each ray leaves, with its side."""
    rng = np.random.default_rng(9)
    spheres = packed(CROWD)["Sphere"]
    chosen = rng.integers(0, len(spheres), COUNT)
    center, radius = spheres["center"][chosen], spheres["radius"][chosen][:, None]
    direction = unit(rng.normal(size=(COUNT, 3)))
    origin, leaves = rng.uniform(-3, 3, (COUNT, 3)), np.full(COUNT, -1)
    if kind == "along axes":
        direction = np.eye(3)[rng.integers(0, 3, COUNT)] * rng.choice([1.0, -1.0], (COUNT, 1))
        direction *= rng.choice([1.0, -1.0], (COUNT, 3))  # zeros of both signs
        origin = np.where(direction == 0, center + radius * rng.integers(-1, 2, (COUNT, 3)), origin)
    if kind in ("to rims", "from afar"):
        distance = 1e5 if kind == "from afar" else 3.0
        origin = center + distance * unit(rng.normal(size=(COUNT, 3)))
        aside = unit(np.cross(center - origin, rng.normal(size=(COUNT, 3))))
        direction = unit(
            center + radius * aside * (1 + 1e-6 * rng.normal(size=(COUNT, 1))) - origin
        )
    if kind == "along faces":  # of boxes, where spheres touch them, up to rounding
        axis = np.eye(3)[rng.integers(0, 3, COUNT)] * rng.choice([1.0, -1.0], (COUNT, 1))
        direction = unit(np.cross(axis, direction))
        far = 10 ** rng.uniform(0, 5, (COUNT, 1))
        aside = 1e-7 * (far + 3) * rng.uniform(-1, 1, (COUNT, 1))
        origin = center + (radius + aside) * axis - far * direction
    if kind in ("from spheres", "within spheres"):
        side = 1 if kind == "from spheres" else -1
        outward = unit(rng.normal(size=(COUNT, 3)))
        origin, leaves = center + radius * outward, chosen
        direction *= side * np.sign((direction * outward).sum(axis=1, keepdims=True))
    inward = np.full(COUNT, int(kind == "within spheres"))
    return {"o": origin, "d": direction, "leaves": leaves, "inward": inward}


def unit(vectors: Array) -> Array:
    lengths: Array = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / lengths


KINDS = [
    *("anywhere", "along axes", "along faces", "to rims", "from afar"),
    *("from spheres", "within spheres"),
]
HIT = """
    Ray ray = Ray(o, d, leaves, inward == 1);
    Hit hit = find_hit(ray, limit, ignored, false);
    bool hidden = occluded(ray, limit, ignored);"""


def found(call_glsl: CallGlsl, has_tree: bool, scene: Scene = CROWD, **inputs: Any) -> Array:
    """Distance, shape and shadow of each ray."""
    return call_glsl(
        "vec3(hit.distance, float(hit.shape), float(hidden))",
        "vec3",
        setup=HIT,
        scene=scene,
        constants={"HAS_SPHERE_TREE": has_tree},
        **inputs,
    )


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("limit", [3.4e38, NEAR])
def test_a_ray_finds_by_the_tree_what_it_finds_without(
    call_glsl: CallGlsl, kind: str, limit: float
) -> None:
    given = {**rays(kind), "limit": np.array([limit]), "ignored": np.arange(COUNT) % 7}
    by_tree, without = (found(call_glsl, has_tree, **given) for has_tree in (True, False))
    assert by_tree.tobytes() == without.tobytes()
    assert (without[:, 1] < 0).any()
    assert limit == NEAR or (without[:, 1] >= 0).sum() > COUNT / 4


def test_balls_that_touch_the_horizon_are_seen_as_without_a_tree(call_glsl: CallGlsl) -> None:
    """From the eye, which is the origin: there boxes are no wider than their own slack."""
    rng = np.random.default_rng(6)
    radius = 10 ** rng.uniform(-2, 0, 400)
    center = np.column_stack([rng.uniform(-9, 9, 400), -radius, rng.uniform(-9, 9, 400)])
    horizon = scene_of(
        [sphere(c, r, "m") for c, r in zip(center, radius, strict=True)], {"m": MATTE}
    )
    direction = unit(np.where([1, 0, 1], center, 1e-7)[rng.integers(0, 400, COUNT)])
    direction[:, 1] *= rng.normal(size=COUNT)
    none, far = np.array([-1]), np.array([3.4e38])
    given = {"o": np.zeros((COUNT, 3)), "d": direction, "leaves": none, "inward": none}
    by_tree, without = (
        found(call_glsl, has_tree, horizon, limit=far, ignored=none, **given)
        for has_tree in (True, False)
    )
    assert by_tree.tobytes() == without.tobytes()
    assert (without[:, 1] >= 0).sum() > COUNT / 4


def unpacked(nodes: Array) -> tuple[Array, Array, Array, Array]:
    """Each node's sphere, how many lie below it, and the corners of its box."""
    corner, cell = np.split(nodes["sphere"][0].view(np.float32).astype(float), [3])
    cells, last = nodes["box"][1:, :3], nodes["box"][1:, 3]
    return (
        last & 0xFFFF,
        last >> 16,
        corner + cell * (cells & 0xFFFF),
        corner + cell * (cells >> 16),
    )


@pytest.mark.parametrize("far", [0.0, 1000.0])
def test_boxes_are_wider_than_their_spheres_by_many_roundings(far: float) -> None:
    """They are not wider by many grid cells: its longest side has 2^15 cells or more."""
    scene = scene_of(balls(300, 5), MATERIALS, {"position": [0, far, 0], "look_at": [1, far, 0]})
    arrays = packed(scene)
    spheres = arrays["Sphere"]
    center, radius = spheres["center"].astype(float), spheres["radius"].astype(float)[:, None]
    rounding = 2.0**-24 * (np.abs(center).max(axis=1, keepdims=True) + radius)
    numbers, rest, lower, upper = unpacked(arrays["Node"])
    assert sorted(numbers) == list(range(300))
    for place in np.flatnonzero(rest):
        items = numbers[place + 1 : place + 1 + rest[place]]
        high, low = (center + radius)[items], (center - radius)[items]
        assert (upper[place] >= high + 32 * rounding[items]).all()
        assert (lower[place] <= low - 32 * rounding[items]).all()
        room = 128 * rounding[items].max() + 5 * 2.0**-15
        assert (upper[place] <= high.max(axis=0) + room).all()
        assert (lower[place] >= low.min(axis=0) - room).all()


@pytest.mark.parametrize("far", [1.0, 1000.0, 2.0**40])
def test_a_box_is_met_as_if_the_ray_began_up_to_many_roundings_alongside(
    call_glsl: CallGlsl, far: float
) -> None:
    """Past the upper face of a box, from afar: by 32 roundings it is met, by 128 it is not."""
    call = {
        "expression": "meets_box(slab_of(Ray(o, d, -1, false), grid), uvec3(edge << 16), FAR)",
        "returns": "bool",
        "setup": "vec4 grid = vec4(vec3(-size), size / 16384.0);",
    }
    roundings = np.array([-128, -1, 0, 1, 32, 128])
    origin = np.column_stack([np.full(6, -far), far / 2 * (1 + 2.0**-23 * roundings), np.zeros(6)])
    inputs = {"o": origin, "d": np.array([[1.0, 0, 0]] * 6), "size": np.array([far / 2])}
    inputs["edge"] = np.array([32768], np.uint32)  # cells from -size to size
    assert call_glsl(**call, **inputs).tolist() == [True] * 5 + [False]


def test_a_ray_is_as_uncertain_as_the_corner_of_the_grid(call_glsl: CallGlsl) -> None:
    """The ray starts at the origin, next to a box; the grid begins far away."""
    far, roundings = 1000.0, np.array([0, 32, 128])
    call = {
        "expression": "meets_box(slab_of(Ray(o, d, -1, false), grid), uvec3(edge << 16), FAR)",
        "returns": "bool",
        "setup": f"vec4 grid = vec4(vec3(-{far}), {far / 1000});",
    }
    origin = np.column_stack([np.zeros(3), far * 2.0**-23 * roundings, np.zeros(3)])
    inputs = {"o": origin, "d": np.array([[1.0, 0, 0]] * 3), "edge": np.array([1000], np.uint32)}
    assert call_glsl(**call, **inputs).tolist() == [True, True, False]


def test_of_equal_spheres_the_first_is_hit(call_glsl: CallGlsl) -> None:
    spheres = packed(CROWD)["Sphere"]
    given = {**rays("to rims"), "limit": np.array([3.4e38]), "ignored": np.array([-1])}
    shapes = found(call_glsl, True, **given)[:, 1].astype(int)
    hit = spheres[shapes[shapes >= 0]]
    places = np.column_stack([spheres["center"], spheres["radius"]])
    first = {tuple(place): index for index, place in reversed(list(enumerate(places)))}
    assert len(first) < len(places), "there are equal ones"
    expected = [first[(*s["center"], s["radius"])] for s in hit]
    assert shapes[shapes >= 0].tolist() == expected


def test_a_ray_finds_by_the_tree_what_float64_says(call_glsl: CallGlsl) -> None:
    given = {**rays("anywhere"), "limit": np.array([3.4e38]), "ignored": np.array([-1])}
    distance, shape, _ = found(call_glsl, True, **given).T
    spheres = packed(CROWD)["Sphere"]
    to_center = spheres["center"][None].astype(float) - given["o"][:, None]
    along = np.einsum("rsk,rk->rs", to_center, given["d"])
    rest = np.square(spheres["radius"].astype(float)) - np.square(to_center).sum(axis=2) + along**2
    half = np.sqrt(np.maximum(rest, 0))
    near, far = along - half, along + half
    exact = np.where(rest > 0, np.where(near > 0, near, np.where(far > 0, far, np.inf)), np.inf)
    exact = exact.min(axis=1)
    is_rim = (np.abs(rest) < 1e-5 * np.square(to_center).sum(axis=2)).any(axis=1)
    sure = ~is_rim
    assert sure.mean() > 0.9
    assert np.array_equal(np.isfinite(exact[sure]), shape[sure] >= 0)
    hit = sure & (shape >= 0)
    np.testing.assert_allclose(distance[hit], exact[hit], rtol=1e-4, atol=1e-5)


# --- pictures --------------------------------------------------------------------------------


def crowd(seed: int, scale: float = 1.0) -> Scene:
    """Every shape and material, and overlapping balls, some of them lamps."""
    rng = np.random.default_rng(seed)
    many = balls(int(rng.integers(SPHERES_FROM, 3 * SPHERES_FROM)), seed)
    for ball in many[:: rng.integers(5, 40)]:
        ball["material"] = "lamp"
    objects = [
        {
            key: (scale * np.array(value)).tolist()
            if key not in ("shape", "material", "normal")
            else value
            for key, value in shape.items()
        }
        for shape in [*OBJECTS[:2], *many, *OBJECTS[2:]]
    ]
    eye = {**EYE, "position": [scale * c for c in (0.1, 0.2, 3.0)], "focus_distance": scale * 3}
    return everything(objects, eye)


def without_tree(
    scene: Scene, context: Context, monkeypatch: pytest.MonkeyPatch, **more: Any
) -> Image:
    with monkeypatch.context() as patch:
        for name in ("TREE_FROM", "SPHERES_FROM"):
            patch.setattr(facts, name, 1 << 30)
        return rendered(scene, context, 3, **more)


@pytest.mark.slow_cases("mis-1")
@pytest.mark.slow_cases("mis-0", "mis-2", "mis-3")
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("method", ["naive", "mis"])
def test_a_picture_is_the_same_with_the_tree_and_without(
    context: Context, monkeypatch: pytest.MonkeyPatch, method: str, seed: int
) -> None:
    scene, settings = crowd(seed), {"width": 24, "height": 24, "method": method}
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    by_tree = rendered(scene, context, 3, **settings)
    assert same(by_tree, without_tree(scene, context, monkeypatch, **settings))


@pytest.mark.slow
def test_a_crowd_scaled_by_a_power_of_two_keeps_its_bits(context: Context) -> None:
    for power in (-10, 5):
        assert same(rendered(crowd(1), context, 3), rendered(crowd(1, 2.0**power), context, 3))


def test_moving_or_adding_a_sphere_to_a_tree_compiles_nothing(context: Context) -> None:
    some = balls(140, 3)
    moved = [*some[:50], {**some[50], "center": [0.25, 0.5, 0.75]}, *some[51:]]
    more = [*some, sphere([0, 0, 0], 0.25, "white")]
    with rendering(everything(some), context) as renderer:
        renderer.render(1)
        for edited in (moved, more):
            assert renderer.update(everything(edited)) is Cost.RESTART
            expected = rendered(everything(edited), context, 2)
            assert same(renderer.render(2).image(), expected)
