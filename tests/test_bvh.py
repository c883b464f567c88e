"""The tree over the spheres: its shape, and that it changes no bit of any picture."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt import needs, schedule
from glrt.bvh import Tree, build, refit
from glrt.cli import main
from glrt.context import Context
from glrt.image import Image
from glrt.needs import TREE_FROM
from glrt.pack import pack_scene
from glrt.renderer import Renderer
from glrt.scene import Scene
from glrt.settings import Cost
from tests.builders import MATTE, plane, scene_of, sphere
from tests.conftest import CallGlsl
from tests.mixture import EYE, MATERIALS, OBJECTS, everything
from tests.renders import rendered, rendering, same

Array = np.ndarray[Any, Any]
WHITE = {"color": [1.0, 1.0, 1.0]}

# --- the tree --------------------------------------------------------------------------------


def boxes(count: int, seed: int = 1) -> tuple[Array, Array]:
    """Corners of random boxes of very different sizes."""
    rng = np.random.default_rng(seed)
    center = rng.uniform(-10, 10, (count, 3))
    half = rng.uniform(0.01, 1, (count, 3)) * 10 ** rng.uniform(-2, 1, (count, 1))
    return center - half, center + half


def pile(count: int) -> tuple[Array, Array]:
    """One box many times: no plane parts their centres."""
    return np.zeros((count, 3)), np.ones((count, 3))


TREES = {
    **{f"{count} boxes": boxes(count) for count in (1, 2, 3, 17, 1000)},
    "a pile": pile(33),
    "a row": (np.outer(np.arange(50), [1.0, 0, 0]), np.outer(np.arange(50), [1.0, 0, 0])),
}


def below(tree: Tree, node: int) -> slice:
    return slice(node + 1, tree.skip[node])


@pytest.mark.parametrize("name", TREES)
def test_every_box_is_one_node_and_lies_in_the_boxes_of_all_above_it(name: str) -> None:
    lower, upper = TREES[name]
    tree = build(lower, upper)
    assert sorted(tree.item) == list(range(len(lower)))
    for node in range(len(lower)):
        rest = tree.item[below(tree, node)]
        assert len(rest) == 0 or np.array_equal(tree.lower[node], lower[rest].min(axis=0))
        assert len(rest) == 0 or np.array_equal(tree.upper[node], upper[rest].max(axis=0))


@pytest.mark.parametrize("name", TREES)
def test_boxes_that_have_moved_keep_their_order_and_every_box_holds_what_lies_below_it(
    name: str,
) -> None:
    lower, upper = TREES[name]
    tree = build(lower, upper)
    again = refit(tree.item, tree.skip, lower, upper)
    assert all(np.array_equal(a, b) for a, b in zip(again, tree, strict=True))
    way = np.array([0.37, -11.0, 5.3])
    moved = refit(tree.item, tree.skip, lower + way, upper + way)
    for node in range(len(lower)):
        rest = tree.item[below(tree, node)]
        assert len(rest) == 0 or np.array_equal(moved.lower[node], (lower + way)[rest].min(axis=0))
        assert len(rest) == 0 or np.array_equal(moved.upper[node], (upper + way)[rest].max(axis=0))


def test_a_camera_that_moves_builds_no_tree_again(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To the bits of a render from there."""
    rng = np.random.default_rng(5)
    balls = [sphere(p.tolist(), 0.3, "m") for p in rng.uniform(-2, 2, (200, 3))]
    near, far = (
        scene_of(balls, {"m": MATTE}, {"position": [0.3, 0, z]}, background=WHITE)
        for z in (5.0, 6.0)
    )
    with rendering(near, context, width=32, height=32) as renderer:
        renderer.render(1)
        with monkeypatch.context() as patch:
            patch.setattr("glrt.bvh.build", None)
            assert renderer.update(far) is Cost.RESTART
        assert same(renderer.render(4).image(), rendered(far, context, 4, width=32, height=32))
        others = [sphere([0.1, 0.2, 1.0], 0.5, "m"), *balls[1:]]
        moved = scene_of(others, {"m": MATTE}, {"position": [0.3, 0, 6.0]}, background=WHITE)
        with monkeypatch.context() as patch:
            patch.setattr("glrt.bvh.build", None)
            with pytest.raises(TypeError):  # other balls want another tree
                renderer.update(moved)
        renderer.update(moved)
        assert same(renderer.render(4).image(), rendered(moved, context, 4, width=32, height=32))


@pytest.mark.parametrize("name", TREES)
def test_a_ray_that_misses_a_box_goes_on_behind_all_that_lies_below_it(name: str) -> None:
    tree = build(*TREES[name])
    ends = [len(tree.skip)]
    for node, skip in enumerate(tree.skip):
        while ends[-1] == node:
            ends.pop()
        assert node < skip <= ends[-1], "what lies below a node lies below those above it"
        ends.append(skip)


@pytest.mark.parametrize("name", TREES)
def test_a_node_has_two_children_where_there_are_two(name: str) -> None:
    tree = build(*TREES[name])
    for node in range(len(tree.skip)):
        children, place = 0, node + 1
        while place < tree.skip[node]:
            place, children = tree.skip[place], children + 1
        assert children == min(2, tree.skip[node] - node - 1)


def test_the_largest_box_stands_above_the_others() -> None:
    lower, upper = TREES["1000 boxes"]
    tree = build(lower, upper)
    x, y, z = (upper - lower)[tree.item].T
    area = x * y + y * z + z * x
    for node in range(len(tree.skip)):
        assert (area[below(tree, node)] <= area[node]).all()


def visits(tree: Tree, origin: Array, direction: Array) -> int:
    """How many nodes a line looks at."""
    node = count = 0
    while node < len(tree.skip):
        a, b = (tree.lower[node] - origin) / direction, (tree.upper[node] - origin) / direction
        meets = np.minimum(a, b).max() <= np.maximum(a, b).min()
        node = node + 1 if meets else tree.skip[node]
        count += 1
    return count


def test_a_ray_meets_few_nodes_though_there_are_many() -> None:
    """Balls that fill the same share of a cube; the mean is of 200 lines, its chance error 10 %."""
    rng = np.random.default_rng(3)
    means = []
    for count in (100, 3000):
        center = rng.uniform(-1, 1, (count, 3))
        radius = 0.2 * count ** (-1 / 3)
        tree = build(center - radius, center + radius)
        lines = [(rng.uniform(-1, 1, 3), rng.normal(size=3)) for _ in range(200)]
        means.append(np.mean([visits(tree, *line) for line in lines]))
    assert means[0] < 22
    assert means[1] < 100, "all: 3000"


def surface_cost(tree: Tree) -> float:
    """Nodes below the root that a line is expected to look at: the children of boxes it meets."""
    return sum(
        surface(tree.upper[node] - tree.lower[node]) * min(2, int(tree.skip[node]) - node - 1)
        for node in range(len(tree.skip))
    )


def surface(size: Array) -> float:
    x, y, z = size
    return float(x * y + y * z + z * x)


def test_the_tree_is_nearly_as_good_as_one_that_tries_every_place() -> None:
    lower, upper = boxes(300, seed=2)
    assert surface_cost(build(lower, upper)) < 1.05 * swept_cost(lower, upper)


def swept_cost(lower: Array, upper: Array) -> float:
    """The cost of a tree that tries all places to split, node by node (MacDonald, Booth 1990)."""

    def area(items: Array) -> float:
        return surface(upper[items].max(axis=0) - lower[items].min(axis=0))

    def cost(items: Array) -> float:
        rest = np.delete(items, np.argmax([surface((upper - lower)[item]) for item in items]))
        if len(rest) < 2:
            return area(rest) if len(rest) else 0.0
        orders = [rest[np.argsort((lower + upper)[rest, axis])] for axis in range(3)]
        splits = [(order[:k], order[k:]) for order in orders for k in range(1, len(rest))]
        left, right = min(splits, key=lambda s: area(s[0]) * len(s[0]) + area(s[1]) * len(s[1]))
        return 2 * area(rest) + cost(left) + cost(right)

    return cost(np.arange(len(lower)))


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
    spheres = pack_scene(CROWD)["Spheres"]
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
        constants={"HAS_TREE": has_tree},
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
    """Of each node its sphere, how many lie below it, and the corners of its box."""
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
    """And not by many cells of the grid, of which there are 2^15 or more along its longest side."""
    scene = scene_of(balls(300, 5), MATERIALS, {"position": [0, far, 0], "look_at": [1, far, 0]})
    arrays = pack_scene(scene)
    spheres = arrays["Spheres"]
    center, radius = spheres["center"].astype(float), spheres["radius"].astype(float)[:, None]
    rounding = 2.0**-24 * (np.abs(center).max(axis=1, keepdims=True) + radius)
    numbers, rest, lower, upper = unpacked(arrays["Nodes"])
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
def test_a_box_is_met_as_if_the_ray_began_up_to_many_roundings_beside(
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
    """From the origin itself, beside a box far from which the grid begins."""
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
    spheres = pack_scene(CROWD)["Spheres"]
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
    spheres = pack_scene(CROWD)["Spheres"]
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
    many = balls(int(rng.integers(TREE_FROM, 3 * TREE_FROM)), seed)
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
        patch.setattr(needs, "TREE_FROM", 1 << 30)
        return rendered(scene, context, 3, **more)


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


# --- the loop limit --------------------------------------------------------------------------


@pytest.fixture
def hopeful(monkeypatch: pytest.MonkeyPatch) -> None:
    """The renderer believes that rays run through any tree in no time."""
    monkeypatch.setattr(schedule.iterations_per_sample, "__defaults__", (0.0,))  # of `tree_rounds`


@pytest.mark.usefixtures("hopeful")
def test_a_frame_that_lost_samples_is_done_again_with_fewer_at_once(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Bit for bit: 300 samples a dispatch of rays that meet 300 nodes each are too many."""
    if not context.is_software:
        pytest.skip("this machine renders on hardware")
    scene = scene_of(
        [sphere([0, 0, 0], 1, "m")] * 300, {"m": MATTE}, background={"color": [1, 1, 1]}
    )
    settings = {"width": 8, "height": 8, "bounces": 3}
    with rendering(scene, context, **settings) as renderer:
        before = renderer.most_samples
        renderer.step(300)
        assert renderer.most_samples <= 300 // 2 < before
        assert renderer.nonfinite() == 0
        image = renderer.image()
    monkeypatch.setattr(needs, "TREE_FROM", 1 << 30)
    assert same(image, rendered(scene, context, 300, **settings))


def test_a_sample_beyond_the_loop_limit_is_dropped_and_counted(context: Context) -> None:
    """Rays to the left meet 40,000 spheres, twice, and are lost; those to the right none."""
    if not context.is_software:
        pytest.skip("this machine renders on hardware")
    pile_of = [sphere([-3, 0, -5], 2, "white")] * 40_000
    white = {"white": {"type": "lambertian", "color": [1, 1, 1]}}
    scene = scene_of(pile_of, white, background={"color": [0.5, 0.5, 0.5]})
    renderer = Renderer(scene, context=context, width=64, height=16, method="naive")
    image = renderer.render(2).image()
    dropped = renderer.nonfinite()
    assert 2 * 64 * 16 / 8 < dropped < 2 * 64 * 16
    assert set(np.unique(image.radiance)) <= {0.0, 0.5}, "no sample is wrong"
    renderer.step(2)
    assert (renderer.samples, renderer.most_samples) == (4, 1)
    renderer.release()


def test_dropped_samples_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Renderer, "nonfinite", lambda _: 1234)
    small = ["--width", "8", "--height", "8", "--samples", "1"]
    assert main(["render", "sky", "-o", str(tmp_path / "a.npy"), *small]) == 0
    assert "1,234 samples were dropped" in capsys.readouterr().err


@pytest.mark.slow
def test_65_536_spheres_are_rendered_without_losing_a_sample(context: Context) -> None:
    rng = np.random.default_rng(4)
    center = rng.uniform(-1, 1, (65_535, 3)).round(4).tolist()
    many = [sphere(c, 0.01, "m") for c in center]
    scene = scene_of(
        [*many, plane([0, -1, 0], [0, 1, 0], "m")],
        {"m": MATTE},
        {"position": [0, 0, 4]},
        background={"color": [1, 1, 1]},
    )
    image = rendered(scene, context, 4, width=64, height=64)
    assert 0.05 < image.radiance.mean() < 1
