"""The tree of 8 children a node, decoded: what it holds, and how tight its boxes are."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from glrt.accel import binary_tree, shape_tree
from glrt.accel.shape_tree import MOST_HEIGHT, Boxes, ShapeTree
from glrt.accel.wide_tree import GRID_BITS, LEAF, LINK_BITS, WIDTH, grid_of

Array = np.ndarray[Any, Any]


def boxes(count: int, spread: float = 10.0) -> tuple[Array, Array]:
    """Corners of random boxes of very different sizes."""
    rng = np.random.default_rng(count)
    center = rng.uniform(-spread, spread, (count, 3))
    half = rng.uniform(0.01, 1, (count, 3)) * 10 ** rng.uniform(-4, 1, (count, 1))
    return center - half, center + half


def row(count: int, ratio: float) -> tuple[Array, Array]:
    """Boxes that come nearer and nearer to a point, each smaller than the one before."""
    place = ratio ** np.arange(count)
    corner = place[:, None] * [1.0, 0.5, -2.0]
    return corner - 0.1 * place[:, None], corner + 0.1 * place[:, None]


TREES = {
    **{f"{count} boxes": boxes(count) for count in (1, 2, 7, 8, 9, 17, 1000)},
    "a pile": (np.zeros((33, 3)), np.ones((33, 3))),
    "points on a line": (np.outer(np.arange(50), [1.0, 0, 0]),) * 2,
    "one point": (np.zeros((1, 3)),) * 2,
    "a row": row(300, 0.9),
    "far away": tuple(corner + 1e6 for corner in boxes(100)),
    "tiny": tuple(1e-20 * corner for corner in boxes(100)),
    "huge": tuple(1e20 * corner for corner in boxes(100)),
}


def tree_over(lower: Array, upper: Array) -> ShapeTree:
    half = len(lower) // 2  # two kinds; the first may have no member
    quads = Boxes("Quad", 5, lower[:half], upper[:half])
    disks = Boxes("Disk", 9, lower[half:], upper[half:])
    grid = grid_of(lower.min(axis=0), upper.max(axis=0))
    return shape_tree.build((quads, disks) if half else (disks,), grid)


def children(slot: Array) -> Iterator[tuple[int, Array, Array]]:
    """Each child's slot and the corners of its box on the grid."""
    corner = (slot[:3] & (1 << GRID_BITS) - 1).astype(float)
    cell = 2.0 ** ((slot[:3] >> GRID_BITS).astype(float) - 127)
    bounds = slot[3:15].copy().view(np.uint8).reshape(3, 2, WIDTH)
    first, last = int(slot[15]) & (1 << LINK_BITS) - 1, int(slot[15]) >> LINK_BITS & 7
    for k in range(last + 1):
        yield first + k, corner + cell * bounds[:, 0, k], corner + cell * bounds[:, 1, k]


def nodes(tree: ShapeTree) -> list[int]:
    """The slots that are no leaves."""
    return sorted(set(range(len(tree.wide.slots))) - set(tree.place.tolist()))


def below(tree: ShapeTree, place: int) -> list[int]:
    """The leaves below a slot, in their slots."""
    if place in set(tree.place.tolist()):
        return [place]
    found = [below(tree, child) for child, _, _ in children(tree.wide.slots[place])]
    return [leaf for part in found for leaf in part]


@pytest.mark.parametrize("name", TREES)
def test_every_box_is_one_leaf_and_every_slot_is_used_once(name: str) -> None:
    tree = tree_over(*TREES[name])
    count = len(TREES[name][0])
    assert len(set(tree.place.tolist())) == count
    met = [child for node in nodes(tree) for child, _, _ in children(tree.wide.slots[node])]
    assert sorted(met) == list(range(1, len(tree.wide.slots)))
    assert sorted(below(tree, 0)) == sorted(tree.place.tolist())


@pytest.mark.parametrize("name", TREES)
def test_the_box_of_a_child_holds_all_below_it_and_little_more(name: str) -> None:
    lower, upper = TREES[name]
    tree = tree_over(lower, upper)
    low, high = tree.grid.cells(lower), tree.grid.cells(upper)
    item = np.full(len(tree.wide.slots), -1)
    item[tree.place] = np.arange(len(lower))
    for node in nodes(tree):
        found = list(children(tree.wide.slots[node]))
        size = np.max([end for *_, end in found], axis=0) - np.min([s for _, s, _ in found], axis=0)
        room = 1 + 2 * (size + 1) / 127  # cells are powers of two
        for child, start, end in found:
            items = item[below(tree, child)]
            least, most = low[items].min(axis=0), high[items].max(axis=0)
            assert (start <= least).all()
            assert (end >= most).all()
            assert (start >= least - room).all()
            assert (end <= most + room).all()


@pytest.mark.parametrize("name", TREES)
def test_coordinates_have_room_on_the_grid(name: str) -> None:
    lower, upper = TREES[name]
    grid = grid_of(lower.min(axis=0), upper.max(axis=0))
    cells = np.concatenate([grid.cells(lower), grid.cells(upper)])
    assert cells.min() >= 2
    assert cells.max() <= 2**GRID_BITS - 2
    assert np.log2(grid.cell) % 1 == 0
    if (upper > lower).any() and np.ptp(cells) > 0:
        assert np.ptp(cells, axis=0).max() > 2 ** (GRID_BITS - 2)


def test_a_tree_that_would_be_too_deep_is_divided_into_halves(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    built = []
    build = binary_tree.build

    def noted(*args: Any, **options: Any) -> Any:
        built.append(options.get("halves", False))
        return build(*args, **options)

    monkeypatch.setattr(binary_tree, "build", noted)
    tree = tree_over(*row(2000, 0.8))
    assert built == [False, True]
    assert tree.wide.height <= MOST_HEIGHT
    assert len(below(tree, 0)) == 2000
    assert tree_over(*boxes(1000)).wide.height <= 6
    assert built == [False, True, False]


def test_splits_are_better_than_halves() -> None:
    """The measure is the surface area heuristic: the area of all nodes, relative to the root."""
    areas = []
    for halves in (False, True):
        tree = binary_tree.build(*boxes(1000), halves=halves)
        size = tree.upper - tree.lower
        area = size[:, 0] * size[:, 1] + size[:, 1] * size[:, 2] + size[:, 2] * size[:, 0]
        areas.append(area[tree.left >= 0].sum() / area[0])
    assert areas[0] < 0.8 * areas[1]


def test_a_leaf_says_what_it_is() -> None:
    tree = tree_over(*boxes(9))
    dtype = np.dtype([("center", "f4", 3), ("radius", "f4"), ("code", "i4")])
    rows = {name: np.zeros(count, dtype) for name, count in (("Quad", 4), ("Disk", 5))}
    rows["Disk"]["center"] = np.arange(15).reshape(5, 3)
    rows["Disk"]["code"] = np.arange(5) - 2
    families = {
        "Quad": shape_tree.Family(2, ("center",)),
        "Disk": shape_tree.Family(3, ("center", "code")),
    }
    slots = shape_tree.slots_of(tree, rows, families)
    leaves = slots[tree.place]
    assert (leaves[:, 15] >= LEAF).all()
    assert (leaves[:, 15] >> LINK_BITS & 7).tolist() == [2] * 4 + [3] * 5
    assert (leaves[:, 15] & (1 << LINK_BITS) - 1).tolist() == [5, 6, 7, 8, *range(9, 14)]
    assert leaves[4:, :3].view(np.float32).tolist() == rows["Disk"]["center"].tolist()
    assert leaves[4:, 3].view(np.int32).tolist() == [-2, -1, 0, 1, 2]
    assert (slots[nodes(tree)] == tree.wide.slots[nodes(tree)]).all()
    assert not tree.wide.slots[tree.place].any(), "the tree itself is not written to"
