"""The drags of the bench report how many pictures came, and how long one stayed."""

from functools import partial

import pytest

from bench.drags import Drag, _swing, steps_of, told
from glrt.image.sources import load


def test_a_drag_is_reported_by_its_rate_and_its_longest_gaps() -> None:
    steady = Drag("camera", 2.0, [0.1 * n for n in range(1, 20)])
    none = Drag("bounces", 2.0, [])
    head, _, *rows = told("cornell", [steady, none])
    assert head.startswith("| drag in cornell |")
    assert rows == ["| camera | 9.5 | 100 ms |", "| bounces | 0.0 | 2000 ms |"]


def test_a_gap_counts_up_to_the_end_of_the_drag() -> None:
    assert Drag("camera", 6.0, [1.0]).gap == pytest.approx(5.0, rel=0.02)


def test_what_is_dragged_goes_to_and_fro() -> None:
    places = [_swing(frame) for frame in range(160)]
    assert places[:80] == places[80:]
    assert places[0] == 0.0
    assert max(places) == pytest.approx(-min(places))
    assert len(set(map(partial(round, ndigits=6), places))) > 40 // 2


def test_every_scene_with_a_ball_and_matte_things_can_be_dragged() -> None:
    assert {*steps_of(load("cornell"))} == {"camera", "handles of an object", "bounces", "colour"}
