"""How particles are spread over the sides of a lamp: most leave towards what is close."""

from typing import Any

import pytest

from glrt.plan.facts import SceneFacts
from glrt.plan.lamp_sides import front_shares
from tests.support.builders import MATTE, disk, lamp, plane, quad, scene_of, sphere
from tests.support.meshes import Faces, icosphere, mesh

SHINING: dict[str, Any] = {  # they face down, and are of size 0.4
    "quad": quad([-0.2, 1, -0.2], [0.4, 0, 0], [0, 0, 0.4], "lamp"),
    "disk": disk([0, 1, 0], [0, -3, 0], 0.4 / 3.14159265**0.5, "lamp"),
}


def moved(place: list[float], beyond: float = -1.0) -> Faces:
    """A ball of radius 0.4 of triangles, without triangles that do not reach `beyond` along x."""
    points, faces = icosphere(2)
    there = points[faces][..., 0].max(axis=1) > beyond
    return 0.4 * points + place, faces[there]


AROUND: dict[str, tuple[list[dict[str, Any]], float]] = {
    "nothing": ([], 0.5),
    "a far floor": ([plane([0, -1, 0], [0, 1, 0], "matte")], 0.5),
    "a near floor": ([plane([0, 0.01, 0], [0, 1, 0], "matte")], 0.9),
    "a near ceiling": ([plane([0, 1.1, 0], [0, -1, 0], "matte")], 0.1),
    "a ceiling nearer than the floor": (
        [plane([0, 1.1, 0], [0, -1, 0], "matte"), plane([0, 0.5, 0], [0, 1, 0], "matte")],
        0.1,
    ),
    "a ceiling about as near as the floor": (
        [plane([0, 1.3, 0], [0, -1, 0], "matte"), plane([0, 0.5, 0], [0, 1, 0], "matte")],
        0.5,
    ),
    "a ball below": ([sphere([0, 0.5, 0], 0.2, "matte")], 0.9),
    "a ball beside": ([sphere([0.5, 1, 0], 0.2, "matte")], 0.5),
    "a ball that is hidden": ([{**sphere([0, 0.5, 0], 0.2, "matte"), "hidden": True}], 0.5),
    "a mesh above": ([mesh(moved([0, 1.5, 0]), "matte")], 0.1),
    "a mesh beside, whose ball is above": ([mesh(moved([0, 1.5, 0], beyond=0.3), "matte")], 0.5),
}


@pytest.mark.parametrize("kind", SHINING)
@pytest.mark.parametrize("around", AROUND)
def test_most_particles_leave_the_side_that_is_close_to_something(kind: str, around: str) -> None:
    others, expected = AROUND[around]
    scene = scene_of([SHINING[kind], *others], {"lamp": lamp(2.0), "matte": MATTE})
    assert front_shares(scene, SceneFacts(scene).particles.lamps) == [pytest.approx(expected)]


@pytest.mark.parametrize("kind", SHINING)
def test_none_leaves_the_dark_side(kind: str) -> None:
    ceiling = plane([0, 1.1, 0], [0, -1, 0], "matte")
    shining = {**SHINING[kind], "emission_side": "front"}
    scene = scene_of([shining, ceiling], {"lamp": lamp(2.0), "matte": MATTE})
    assert front_shares(scene, SceneFacts(scene).particles.lamps) == [1]


def test_a_ball_has_one_side() -> None:
    scene = scene_of([sphere([0, 1, 0], 0.2, "lamp")], {"lamp": lamp(2.0)})
    assert front_shares(scene, SceneFacts(scene).particles.lamps) == [0.5]
