"""Flat lamps that share a place with other surfaces are found, and neighbours are not."""

from typing import Any

import numpy as np
import pytest

from glrt.core.box_pairs import box_pairs
from glrt.scene.coincidence import TOGETHER, _lie_together, coincidence_of
from glrt.scene.shapes.flat_polygons import Polygons
from glrt.scene.warnings import cautions
from glrt.settings import settings_for
from tests.support.builders import (
    MATTE,
    box,
    box_of_quads,
    cylinder,
    disk,
    lamp,
    plane,
    quad,
    scene_of,
    sphere,
)
from tests.support.meshes import blob, mesh, quads

MATERIALS = {"matte": MATTE, "lamp": lamp(2.0)}
LAMP = quad([0, 0, 0], [0, 0, 1], [1, 0, 0], "lamp")


def pairs(things: list[dict[str, Any]]) -> list[tuple[int, int]]:
    return list(coincidence_of(scene_of(things, MATERIALS)).pairs)


def moved(thing: dict[str, Any], by: Any, turn: Any = None) -> dict[str, Any]:
    """A quad elsewhere, turned by a matrix before."""
    matrix = np.eye(3) if turn is None else turn
    vectors = {key: matrix @ np.array(thing[key]) for key in ("corner", "edge_u", "edge_v")}
    vectors["corner"] = vectors["corner"] + np.array(by)
    return {**thing, **{key: vector.tolist() for key, vector in vectors.items()}}


SHARED = {
    "a ceiling": quad([-9, 0, -9], [20, 0, 0], [0, 0, 20], "matte"),
    "a ceiling behind by rounding": quad([-9, 1e-7, -9], [20, 0, 0], [0, 0, 20], "matte"),
    "an endless ceiling": plane([7, 0, 7], [0, -1, 0], "matte"),
    "a corner of another": quad([0.99, 0, 0.99], [1, 0, 0], [0, 0, 1], "matte"),
    "a disk within": disk([0.5, 0, 0.5], [0, 1, 0], 0.1, "matte"),
    "a box below": box([-1, -1, -1], [0.5, 0, 0.5], "matte"),
    "a cylinder on it": cylinder([0.5, 0, 0.5], [0.5, 1, 0.5], 0.1, "matte"),
    "a mesh": mesh(quads([[0.5, 0, 0.5], [1, 0, 0], [0, 0, 1]]), "matte"),
    "another lamp": quad([0.5, 0, 0], [0, 0, 1], [1, 0, 0], "lamp"),
}
APART = {
    "a ceiling 2^-10 above": quad([-9, 2**-10, -9], [20, 0, 0], [0, 0, 20], "matte"),
    "a wall along an edge": quad([0, 0, 0], [0, 0, 1], [0, 1, 0], "matte"),
    "a neighbour": quad([1, 0, 0], [0, 0, 1], [1, 0, 0], "matte"),
    "one across a corner": quad([1, 0, 1], [0, 0, 1], [1, 0, 0], "matte"),
    "one that crosses it": quad([0.5, -1, 0], [0, 2, 0], [0, 0, 1], "matte"),
    "one tilted on an edge": quad([0, 0, 0], [0, 0, 1], [1, 0.01, 0], "matte"),
    "a ball that touches": sphere([0.5, 1, 0.5], 1.0, "matte"),
    "an open cylinder": cylinder([0.5, 0, 0.5], [0.5, 1, 0.5], 0.1, "matte", capped=False),
    "a disk beyond": disk([2, 0, 2], [0, 1, 0], 1.2, "matte"),
    "a wall without end": plane([0, 0, 0], [1, 0, 0], "matte"),
}


@pytest.mark.parametrize("case", SHARED)
def test_what_overlaps_in_one_plane_is_found(case: str) -> None:
    assert pairs([LAMP, SHARED[case]]) == [(0, 1)]
    assert pairs([SHARED[case], sphere([9, 9, 9], 1, "matte"), LAMP]) == [(0, 2)]


@pytest.mark.parametrize("case", APART)
def test_neighbours_are_not(case: str) -> None:
    assert pairs([LAMP, APART[case]]) == []


def test_surfaces_that_do_not_emit_are_not_compared() -> None:
    assert pairs([{**LAMP, "material": "matte"}, SHARED["a ceiling"]]) == []


@pytest.mark.parametrize("seed", range(4))
def test_they_are_found_wherever_they_lie(seed: int) -> None:
    """Turned at random, large or small, and a thousand sizes from the origin."""
    rng = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    size = 2.0 ** rng.integers(-20, 20)
    by = 1000 * size * rng.normal(size=3)
    half = quad([0.5, 0, 0], [0, 0, 1], [1, 0, 0], "matte")
    beside = quad([1.0, 0, 0], [0, 0, 1], [1, 0, 0], "matte")
    things = [moved(thing, by, size * turn) for thing in (LAMP, half, beside)]
    assert pairs(things) == [(0, 1)]


def test_triangles_of_a_lamp_are_neighbours_unless_they_lie_on_each_other() -> None:
    assert pairs([mesh(blob(2), "lamp")]) == []
    assert pairs([mesh(quads([[0, 0, 0], [1, 0, 0], [0, 0, 1]]), "lamp")]) == []
    folded = quads([[0, 0, 0], [1, 0, 0], [0, 0, 1]], [[0.5, 0, 0.5], [0, 0, 1], [1, 0, 0]])
    assert pairs([mesh(folded, "lamp")]) == [(0, 0)]
    assert pairs([mesh(blob(2), "lamp"), mesh(blob(2), "matte", translate=[1e-9, 0, 0])]) == [
        (0, 1)
    ]


def test_an_endless_lamp_is_compared_with_all_that_is_flat() -> None:
    ground = plane([0, 0, 0], [0, 1, 0], "lamp")
    lying = quad([5, 0, 5], [1, 0, 0], [0, 0, 1], "matte")
    assert pairs([ground, lying, moved(lying, [0, 1, 0])]) == [(0, 1)]


def test_the_scenes_that_come_with_a_room_have_none() -> None:
    inside = quad([-0.4, 0.999, -0.4], [0.8, 0, 0], [0, 0, 0.8], "lamp")
    assert pairs([*box_of_quads("matte"), inside]) == []


def test_boxes_that_touch_are_found_as_by_comparing_all() -> None:
    rng = np.random.default_rng(3)
    low = rng.uniform(-1, 1, (600, 3))
    high = low + 10.0 ** rng.uniform(-4, 0.5, (600, 1)) * rng.uniform(0.5, 1, (600, 3))
    some = low[:50], high[:50]
    every = box_pairs(some, (low, high), TOGETHER)
    found = {pair for a, b in every for pair in zip(a, b, strict=True)}
    touch = (some[0][:, None] <= high).all(axis=2) & (low <= some[1][:, None]).all(axis=2)
    assert {(a, b) for a, b in zip(*np.nonzero(touch), strict=True)} <= found
    assert len(found) < 1.1 * touch.sum()


def test_shared_places_are_reported() -> None:
    scene = scene_of([{**LAMP, "name": "panel"}, SHARED["a ceiling"]], MATERIALS)
    (text,) = cautions(scene, settings_for(scene.render))
    assert text.startswith("objects[0] 'panel' overlaps objects[1] in one plane")


def test_a_round_lamp_on_a_large_floor_shares_no_plane_with_it() -> None:
    """A triangle at the pole of a ball of triangles leans on the floor and touches it."""
    floor = np.array([[-18.0, 0, -18], [18, 0, -18], [18, 0, 18], [-18, 0, 18]])
    lamp_at = np.array([[0.0, 3e-4, 0.01], [0.01, 3e-4, 0], [0, 0, 0]])
    flat = np.array([[0.0, 3e-4, 0.01], [0.01, 3e-4, 0], [0, 3e-4, 0]])
    ground = Polygons(floor[None], np.array([0]))
    for corners, shares in ((lamp_at, False), (flat, True)):
        lamp = Polygons(corners[None], np.array([1]))
        assert _lie_together(ground, lamp, (ground.normals, lamp.normals))[0] == shares
