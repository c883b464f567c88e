"""How the boxes of a node are divided, and that threads do not change a tree."""

import os
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from glrt.accel import binary_tree
from glrt.accel.binned_splits import FEW, are_right, surface
from glrt.core.threads import concurrently

Array = np.ndarray[Any, Any]


def boxes(count: int, seed: int) -> tuple[Array, Array]:
    """Corners of boxes on a coarse grid, so that some centres coincide along an axis."""
    rng = np.random.default_rng(seed)
    lower = rng.integers(0, 4, (count, 3)).astype(float)
    return lower, lower + rng.integers(1, 4, (count, 3))


def cost(lower: Array, upper: Array, right: Array) -> float:
    """Surface area times number of boxes, summed over both sides."""
    sides = [(lower[side], upper[side]) for side in (right, ~right)]
    return float(sum(len(a) * surface(b.max(axis=0) - a.min(axis=0)) for a, b in sides))


def splits(lower: Array, upper: Array) -> Iterator[Array]:
    """All divisions between different centres along an axis."""
    for centre in (lower + upper).T:
        yield from (centre > place for place in np.unique(centre)[:-1])


@pytest.mark.parametrize("count", range(2, FEW + 1))
def test_few_boxes_have_the_best_of_all_splits(count: int) -> None:
    """Nodes of other numbers of boxes stand next to them."""
    rng = np.random.default_rng(count)
    size = np.array([1, count, 2, count, 3, 40, count])
    start, node = np.cumsum(size) - size, np.repeat(np.arange(len(size)), size)
    for seed in rng.integers(1 << 30, size=20):
        lower, upper = boxes(int(size.sum()), int(seed))
        right = are_right(start, size, node, lower, upper)
        for number in np.flatnonzero(size == count):
            own = slice(start[number], start[number] + count)
            low, high = lower[own], upper[own]
            assert 0 < right[own].sum() < count
            if count > 2:
                best = min(cost(low, high, each) for each in splits(low, high))
                assert cost(low, high, right[own]) == pytest.approx(best)


def test_boxes_of_one_centre_are_divided_into_halves() -> None:
    for count in (3, 5, FEW, FEW + 1, 33):
        lower = np.zeros((count, 3))
        given = np.zeros(1, int), np.array([count]), np.zeros(count, int)
        assert are_right(*given, lower, lower + 1).sum() == count // 2


def test_threads_and_portions_do_not_change_a_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    given = boxes(3000, 1)
    whole = binary_tree.build(*given)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: range(3), raising=False)
    monkeypatch.setattr(binary_tree, "PORTION", 100)
    parted = binary_tree.build(*given)
    for one, other in zip(whole, parted, strict=True):
        assert np.array_equal(one, other)


def test_an_error_in_a_thread_is_raised(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: range(2), raising=False)

    def work(part: int) -> int:
        if part == 3:
            raise ValueError("part 3")
        return 2 * part

    assert concurrently(work, range(3)) == [0, 2, 4]
    with pytest.raises(ValueError, match="part 3"):
        concurrently(work, range(5))
