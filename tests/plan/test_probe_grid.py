"""Where probes stand: as scene and settings say, or around what is lit."""

from typing import Any

import numpy as np
import pytest

from glrt.image.sources import load
from glrt.plan.probe_grid import extent_of, grid_of
from glrt.settings import settings_for
from tests.support.builders import MATTE, box_of_quads, plane, room_of_planes, scene_of, sphere

SMALL: dict[str, Any] = {"min": [-1.0, 0.0, 2.0], "max": [1.0, 1.0, 4.0]}
THINGS = [sphere([0, 0, -3], 1, "m"), sphere([1, 2, -6], 0.5, "m")]


def test_the_box_of_the_scene_file_is_divided_into_cells() -> None:
    scene = scene_of(THINGS, {"m": MATTE}, probes={**SMALL, "counts": [4, 2, 2]})
    grid = grid_of(scene, settings_for(scene.render))
    assert grid.counts == (4, 2, 2)
    np.testing.assert_allclose(grid.cell, [0.5, 0.5, 1])
    places = grid.places()
    np.testing.assert_allclose(places[0], [-0.75, 0.25, 2.5])
    np.testing.assert_allclose(places[1], [-0.25, 0.25, 2.5])
    np.testing.assert_allclose(places[-1], [0.75, 0.75, 3.5])


def test_the_command_line_overrides_the_counts_of_the_scene() -> None:
    scene = scene_of(THINGS, {"m": MATTE}, probes=SMALL)
    assert grid_of(scene, settings_for(scene.render)).counts == (5, 5, 5)
    assert grid_of(scene, settings_for(scene.render, probes=3)).counts == (3, 3, 3)


def test_bounded_shapes_are_held_by_the_box() -> None:
    low, high = extent_of(scene_of(THINGS, {"m": MATTE}))
    np.testing.assert_allclose(low, [-1, -1, -6.5])
    np.testing.assert_allclose(high, [1.5, 2.5, -2])


@pytest.mark.parametrize("walls", [room_of_planes("m"), box_of_quads("m")], ids=["planes", "quads"])
def test_a_closed_room_is_its_own_box(walls: list[dict[str, Any]]) -> None:
    low, high = extent_of(scene_of(walls, {"m": MATTE}, {"position": [0.3, -0.2, 0.2]}))
    np.testing.assert_allclose([low, high], [[-1] * 3, [1] * 3], atol=1e-3)


def test_both_rooms_of_a_house_of_planes_are_in_the_box() -> None:
    low, high = extent_of(load("methods/two_rooms"))
    np.testing.assert_allclose([low, high], [[-1, -1, -1], [3, 1, 4]], atol=0.05)


def test_a_floor_without_end_does_not_make_the_box_endless() -> None:
    floor = plane([0, -1, 0], [0, 1, 0], "m")
    scene = scene_of([floor, *THINGS], {"m": MATTE}, {"position": [0, 1, 3]})
    low, high = extent_of(scene)
    assert (low <= [-1, -1, -6.5]).all()
    assert (high >= [1.5, 2.5, -2]).all()
    assert (high - low).max() < 100
    assert low[1] == pytest.approx(-1)
