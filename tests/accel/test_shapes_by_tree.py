"""Shapes of all bounded kinds found by the tree: the same hits and shadows as one by one."""

from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.plan import facts
from glrt.plan.facts import REST_FROM, TREE_FROM, SceneFacts
from glrt.scene.scene import Scene
from glrt.scene.shapes.disk import Disk
from glrt.settings import Cost
from tests.conftest import CallGlsl
from tests.support.builders import box, cylinder, disk, lamp, plane, quad, scene_of, sphere
from tests.support.meshes import mesh
from tests.support.mixed_scene import MATERIALS
from tests.support.renders import rendered, rendering, same

Array = np.ndarray[Any, Any]

COUNT = 4096
NEAR = 1.0
KINDS = ("sphere", "quad", "disk", "box", "cylinder")
GLASS = ("sphere", "box")  # and white else


def one(kind: str, draw: np.random.Generator, scale: float = 1.0) -> dict[str, Any]:
    """A shape near the origin, of a random place and size."""
    c = draw.uniform(-2, 2, 3) * scale
    size = 10 ** draw.uniform(-1.7, -0.3) * scale
    u, v, w = (size * draw.normal(size=3) for _ in range(3))
    material = str(draw.choice(["white", "red", "brass", *(["glass"] if kind in GLASS else [])]))
    if kind == "sphere":
        return sphere(c, size, material)
    if kind == "quad":
        return quad(c, u, v, material)
    if kind == "disk":
        return disk(c, w, size, material)
    if kind == "box":
        half = size * draw.uniform(0.3, 1, 3)
        return box(c - half, c + half, material, draw.choice([0.0, 30.0, 90.0], 3))
    return cylinder(c, c + u, size, material, bool(draw.choice([True, False])))


def crowd(count: int, seed: int, kinds: tuple[str, ...] = KINDS, scale: float = 1.0) -> Scene:
    """So many shapes, some of them twice, over a floor."""
    draw = np.random.default_rng(seed)
    things = [one(kinds[k % len(kinds)], draw, scale) for k in range(count)]
    things[count // 2 :: 7] = things[: len(things[count // 2 :: 7])]
    floor = plane([0, -1.5 * scale, 0], [0, 1, 0], "white")
    sky = {"color": [0.5, 0.6, 0.7]}
    return scene_of([*things, floor], MATERIALS | {"lamp": lamp(6)}, background=sky)


CROWD = crowd(200, 3, KINDS * 2)
SHAPES = sum(1 for item in CROWD.objects if item.shape != "plane")


def unit(vectors: Array) -> Array:
    lengths: Array = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / lengths


def rays(kind: str) -> dict[str, Any]:
    """Origins, directions, and the shape that each ray leaves, with its side."""
    draw = np.random.default_rng(9)
    middles = np.array([item.middle for item in CROWD.objects if item.shape != "plane"])
    target = middles[draw.integers(0, SHAPES, COUNT)]
    direction = unit(draw.normal(size=(COUNT, 3)))
    origin = draw.uniform(-3, 3, (COUNT, 3))
    if kind == "along axes":
        direction = np.eye(3)[draw.integers(0, 3, COUNT)] * draw.choice([1.0, -1.0], (COUNT, 1))
        direction *= draw.choice([1.0, -1.0], (COUNT, 3))  # zeros of both signs
        origin = np.where(direction == 0, target, origin)
    if kind in ("at shapes", "from afar"):
        distance = 1e5 if kind == "from afar" else 3.0
        origin = target - distance * direction + 0.1 * draw.normal(size=(COUNT, 3))
    leaves = np.full(COUNT, -1)
    if kind == "from shapes":  # from about there, as by rounding
        leaves = draw.integers(0, SHAPES, COUNT)
        order = pack_order(CROWD)
        origin = np.array([CROWD.objects[order[k]].middle for k in leaves])
    return {"o": origin, "d": direction, "leaves": leaves, "inward": (leaves % 2).astype(int)}


def pack_order(scene: Scene) -> list[int]:
    """Places of the bounded objects in the scene, by the kernel's number."""
    kinds = ("sphere", "plane", "quad", "disk", "box", "cylinder")
    return [n for kind in kinds for n, item in enumerate(scene.objects) if item.shape == kind]


RAYS = ("anywhere", "along axes", "at shapes", "from afar", "from shapes")
HIT = """
    Ray ray = Ray(o, d, leaves, inward == 1);
    Hit hit = find_hit(ray, limit, ignored, false);
    bool hidden = occluded(ray, limit, ignored);"""


def found(call_glsl: CallGlsl, has_tree: bool, scene: Scene = CROWD, **inputs: Any) -> Array:
    """Distance, shape, shadow, and whether a loop was cut, of each ray."""
    return call_glsl(
        "vec4(hit.distance, float(hit.shape), float(hidden), float(loop_was_cut))",
        "vec4",
        setup=HIT,
        scene=scene,
        constants={"HAS_TREE": has_tree, "HAS_SPHERE_TREE": False},
        **inputs,
    )


@pytest.fixture(autouse=True)
def spheres_in_the_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    """Spheres have a tree of their own only where a test asks for it."""
    monkeypatch.setattr(facts, "SPHERES_FROM", 1 << 30)


@pytest.mark.parametrize("kind", RAYS)
@pytest.mark.parametrize("limit", [3.4e38, NEAR])
def test_a_ray_finds_by_the_tree_what_it_finds_without(
    call_glsl: CallGlsl, kind: str, limit: float
) -> None:
    given = {**rays(kind), "limit": np.array([limit]), "ignored": np.arange(COUNT) % 7}
    by_tree, without = (found(call_glsl, has_tree, **given) for has_tree in (True, False))
    assert by_tree.tobytes() == without.tobytes()
    assert not by_tree[:, 3].any()
    assert kind == "from afar" or (without[:, 1] < 0).any()
    assert limit == NEAR or (without[:, 1] >= 0).sum() > COUNT / 4


@pytest.mark.slow_cases("cylinder")
@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_alone(call_glsl: CallGlsl, kind: str) -> None:
    scene = crowd(TREE_FROM, 5, (kind,))
    given = {**rays("at shapes"), "limit": np.array([3.4e38]), "ignored": np.array([-1])}
    by_tree, without = (found(call_glsl, has_tree, scene, **given) for has_tree in (True, False))
    assert by_tree.tobytes() == without.tobytes()
    assert len(set(by_tree[:, 1])) > TREE_FROM / 4


@pytest.mark.slow_cases("40")
@pytest.mark.parametrize("count", [1, 2, 8, 9, 40])
def test_trees_of_few_levels(
    call_glsl: CallGlsl, monkeypatch: pytest.MonkeyPatch, count: int
) -> None:
    monkeypatch.setattr(facts, "TREE_FROM", 1)
    scene = crowd(count, 7)
    given = {**rays("anywhere"), "limit": np.array([3.4e38]), "ignored": np.array([-1])}
    by_tree, without = (found(call_glsl, has_tree, scene, **given) for has_tree in (True, False))
    assert by_tree.tobytes() == without.tobytes()


def test_children_that_a_node_does_not_have_are_not_visited(
    call_glsl: CallGlsl, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rays from so far meet every box: such children would lead beyond the last slot, and back."""
    monkeypatch.setattr(facts, "TREE_FROM", 1)
    scene = scene_of([disk([k, k, k], [1, 1, 1], 0.5, "white") for k in (0, 3)], MATERIALS)
    shapes = [item for item in scene.objects if isinstance(item, Disk)]
    corner = Disk.bounds(np.array([item.row for item in shapes]))[0].min(axis=0)
    direction = unit(np.random.default_rng(2).normal(size=(64, 3)))
    none = np.array([-1])
    rest = {"limit": np.array([3.4e38]), "ignored": none, "leaves": none, "inward": none}
    given = {"o": corner - 1e9 * direction, "d": direction, **rest}
    by_tree, without = (found(call_glsl, has_tree, scene, **given) for has_tree in (True, False))
    assert not by_tree[:, 3].any()
    assert by_tree.tobytes() == without.tobytes()


@pytest.mark.slow
def test_a_row_of_shapes_that_shrink_towards_a_point(call_glsl: CallGlsl) -> None:
    """Boxes of all sizes down to a millionth, in a tree of the least depth."""
    place = 0.96 ** np.arange(330)
    things = [disk([p, 0.5 * p, -2 * p], [1, 0.5, -2], 0.1 * p, "white") for p in place]
    scene = scene_of(things, MATERIALS)
    draw = np.random.default_rng(1)
    target = np.array([[p, 0.5 * p, -2 * p] for p in draw.choice(place, COUNT)])
    origin = draw.normal(size=(COUNT, 3))
    none = np.array([-1])
    rest = {"limit": np.array([3.4e38]), "ignored": none, "leaves": none, "inward": none}
    given = {"o": origin, "d": unit(target - origin), **rest}
    by_tree, without = (found(call_glsl, has_tree, scene, **given) for has_tree in (True, False))
    assert by_tree.tobytes() == without.tobytes()
    assert len(set(by_tree[:, 1])) > 150


# --- pictures --------------------------------------------------------------------------------

SETTINGS: dict[str, Any] = {"width": 24, "height": 24}


@pytest.mark.slow_cases("whitted")
@pytest.mark.parametrize("method", ["naive", "mis", "whitted"])
def test_a_picture_is_the_same_with_the_tree_and_without(
    context: Context, monkeypatch: pytest.MonkeyPatch, method: str
) -> None:
    scene = crowd(3 * TREE_FROM, 11)
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    by_tree = rendered(scene, context, 3, method=method, **SETTINGS)
    monkeypatch.setattr(facts, "TREE_FROM", 1 << 30)
    assert same(by_tree, rendered(scene, context, 3, method=method, **SETTINGS))


@pytest.mark.slow
@pytest.mark.parametrize("rest", [REST_FROM - 1, REST_FROM, 3 * REST_FROM])
def test_spheres_have_a_tree_next_to_that_of_the_others(
    context: Context, monkeypatch: pytest.MonkeyPatch, rest: int
) -> None:
    monkeypatch.setattr(facts, "SPHERES_FROM", TREE_FROM)
    balls, others = crowd(TREE_FROM, 13, ("sphere",)), crowd(rest, 17, KINDS[1:])
    scene = balls.model_copy(update={"objects": (*balls.objects, *others.objects[:-1])})
    found = SceneFacts(scene)
    assert found.has_sphere_tree
    assert bool(found.tree_kinds) == (rest >= REST_FROM)
    by_tree = rendered(scene, context, 3, **SETTINGS)
    for name in ("TREE_FROM", "SPHERES_FROM", "REST_FROM"):
        monkeypatch.setattr(facts, name, 1 << 30)
    assert same(by_tree, rendered(scene, context, 3, **SETTINGS))


def test_a_crowd_scaled_by_a_power_of_two_keeps_its_bits(context: Context) -> None:
    plain, large = (crowd(60, 19, scale=scale) for scale in (1.0, 2.0**7))
    pictures = [rendered(scene, context, 3, **SETTINGS).radiance for scene in (plain, large)]
    assert pictures[0].tobytes() == pictures[1].tobytes()


def test_a_camera_that_moves_builds_no_tree(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The picture has the bits of a render from there, and from far away."""
    scene = crowd(60, 23)
    with rendering(scene, context, **SETTINGS) as renderer:
        renderer.render(2)
        for position in ((1.0, 0.5, 6.0), (4e3, 5e3, 3e3)):
            camera = scene.camera.model_copy(update={"position": position})
            moved = scene.model_copy(update={"camera": camera})
            with monkeypatch.context() as patch:
                patch.setattr("glrt.packing.scene_tree.build", None)
                assert renderer.update(moved) is Cost.RESTART
            image = renderer.render(3).image()
            assert same(image, rendered(moved, context, 3, **SETTINGS))


@pytest.mark.parametrize(("kinds", "least"), [(1, 32), (2, 48), (3, 64)])
def test_shapes_join_the_tree_of_meshes_where_that_pays(kinds: int, least: int) -> None:
    """Each kind of shapes makes the tree of the triangles slower."""
    some = [box([0, 0, 0], [1, 1, 1], "white"), sphere([0, 0, 0], 1, "white")]
    some += [cylinder([0, 0, 0], [1, 0, 0], 1, "white")]
    things = [some[k % kinds] for k in range(least)]
    triangle = mesh((np.eye(3), np.array([[0, 1, 2]])), "white", smooth=False)
    for count in (least - 1, least):
        facts = SceneFacts(scene_of([triangle, *things[:count]], MATERIALS))
        assert len(facts.tree_kinds) == (kinds if count == least else 0)
