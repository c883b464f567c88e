"""The tree over boxes: its shape, how good it is, and when it is built."""

from typing import Any

import numpy as np
import pytest

from glrt.accel.bvh import Tree, build, refit
from glrt.gpu.context import Context
from glrt.settings import Cost
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.renders import rendered, rendering, same

Array = np.ndarray[Any, Any]
WHITE = {"color": [1.0, 1.0, 1.0]}


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


@pytest.mark.slow
def test_a_camera_that_moves_builds_no_tree_again(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The picture has the bits of a render from there."""
    rng = np.random.default_rng(5)
    balls = [sphere(p.tolist(), 0.3, "m") for p in rng.uniform(-2, 2, (200, 3))]
    near, far = (
        scene_of(balls, {"m": MATTE}, {"position": [0.3, 0, z]}, background=WHITE)
        for z in (5.0, 6.0)
    )
    with rendering(near, context, width=32, height=32) as renderer:
        renderer.render(1)
        with monkeypatch.context() as patch:
            patch.setattr("glrt.accel.bvh.build", None)
            assert renderer.update(far) is Cost.RESTART
        assert same(renderer.render(4).image(), rendered(far, context, 4, width=32, height=32))
        others = [sphere([0.1, 0.2, 1.0], 0.5, "m"), *balls[1:]]
        moved = scene_of(others, {"m": MATTE}, {"position": [0.3, 0, 6.0]}, background=WHITE)
        with monkeypatch.context() as patch:
            patch.setattr("glrt.accel.bvh.build", None)
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
