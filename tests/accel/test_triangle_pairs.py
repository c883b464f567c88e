"""Edges that triangles share, found by sorting."""

import numpy as np
import pytest

from glrt.accel.triangle_pairs import _sorted


@pytest.mark.parametrize("most", [1, 7, 1 << 30, (1 << 63) - 1])
def test_equal_keys_keep_their_order(most: int) -> None:
    """Also where a key and its number do not fit into 63 bits."""
    rng = np.random.default_rng(3)
    key = rng.integers(0, most, 500, endpoint=True)
    key[::3] = key[1]
    in_order, number = _sorted(key)
    truth = np.argsort(key, kind="stable")
    assert np.array_equal(number, truth)
    assert np.array_equal(in_order, key[truth])


def test_no_keys_are_in_order() -> None:
    assert [len(it) for it in _sorted(np.zeros(0, np.int64))] == [0, 0]
