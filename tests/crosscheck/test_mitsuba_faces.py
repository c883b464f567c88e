"""Which faces coincide, and which balls are seen from inside: input that Mitsuba needs."""

from contextlib import nullcontext
from typing import Any

import pytest

from glrt.core.errors import SceneError
from glrt.scene.export.faces import is_seen_from_inside
from glrt.scene.shapes.sphere import Sphere
from tests.mitsuba.coincident import refuse_coincident
from tests.mitsuba.planes import OF_A_ROOM, TO_THE_HORIZON, reach_of_planes
from tests.support.builders import MATTE, box, cylinder, disk, plane, quad, scene_of, sphere

SHEET = quad([0, 0, 0], [1, 0, 0], [0, 0, 1], "white")


@pytest.mark.parametrize(
    ("objects", "reason"),
    [
        ([plane([0, 0, 0], [0, 1, 0], "white"), plane([5, 0, 1], [0, -2, 0], "white")], ""),  # one
        ([plane([0, 0, 0], [0, 1, 0], "white"), SHEET], "plane"),
        ([SHEET, quad([0.9, 0, 0.9], [0, 0, 1], [1, 0, 0], "white")], "plane"),
        ([SHEET, quad([1.0, 0, 0.0], [0, 0, 1], [1, 0, 0], "white")], ""),
        ([SHEET, quad([0, 0.01, 0], [0, 0, 1], [1, 0, 0], "white")], ""),
        ([SHEET, quad([0, 0, 0], [0, 1, 0], [1, 0, 0], "white")], ""),
        ([SHEET, disk([0.5, 0, 0.5], [0, -3, 0], 0.1, "white")], "plane"),
        ([SHEET, disk([0.5, 0, 0.5], [0, 3, 1], 0.1, "white")], ""),
        ([SHEET, box([0.1, 0, 0.1], [0.5, 1, 0.5], "white", [0, 30, 0])], "plane"),
        ([SHEET, box([0.1, 0.01, 0.1], [0.5, 1, 0.5], "white", [0, 30, 0])], ""),
        ([SHEET, cylinder([0.5, 1, 0.5], [0.5, 0, 0.5], 0.2, "white")], "plane"),
        ([SHEET, cylinder([0.5, 1, 0.5], [0.5, 0, 0.5], 0.2, "white", capped=False)], ""),
    ],
)
def test_faces_in_one_plane_are_refused(objects: list[dict[str, Any]], reason: str) -> None:
    scene = scene_of(objects, {"white": MATTE})
    with pytest.raises(SceneError, match=reason) if reason else nullcontext():
        refuse_coincident(scene)


@pytest.mark.parametrize(
    ("item", "seen"),
    [
        (sphere([0, 2, 0], 1.0, "white"), False),  # touches
        (sphere([0, 1.9, 0], 1.0, "white"), True),
        (sphere([0, 0.5, 0], 0.1, "white"), True),  # within
        (sphere([0, 0.5, 0], 3.0, "white"), False),  # around
        (plane([0, 1, 0], [0, 1, 0], "white"), False),
        (plane([5, 0.9, 5], [0, 1, 0], "white"), True),
        (quad([-1, 0.5, -1], [2, 0, 0], [0, 0, 2], "white"), True),
        (quad([4, 0.5, -1], [2, 0, 0], [0, 0, 2], "white"), False),
    ],
)
def test_inside_of_a_ball_is_seen_if_something_is_there(item: dict[str, Any], seen: bool) -> None:
    objects = [sphere([0, 0, 0], 1.0, "white"), item]
    scene = scene_of(objects, {"white": MATTE}, {"position": [0, 0, 9]})
    ball = scene.objects[0]
    assert isinstance(ball, Sphere)
    assert is_seen_from_inside(ball, scene) == seen
    inside = scene_of(objects, {"white": MATTE}, {"position": [0, 0, 0.9]})
    assert is_seen_from_inside(ball, inside)


SIDES = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
PYRAMID = [[0, 1, 0], [-1, -1, 0], [1, -1, 1], [1, -1, -1]]


@pytest.mark.parametrize(
    ("normals", "is_room"),
    [
        (SIDES, True),
        (SIDES[:5], False),  # without a front
        (SIDES[:4], False),  # a corridor
        (SIDES[2:4], False),  # a floor and a ceiling
        ([], False),
        (PYRAMID, True),
        (PYRAMID[1:], False),
        ([*PYRAMID[:3], [1, -1, 0]], False),  # a gutter
    ],
)
def test_planes_of_a_room_end_near_it(normals: list[list[float]], is_room: bool) -> None:
    walls = [plane([-part for part in normal], normal, "white") for normal in normals]
    scene = scene_of([*walls, sphere([0, 0, 0], 0.1, "white")], {"white": MATTE})
    assert reach_of_planes(scene) == (OF_A_ROOM if is_room else TO_THE_HORIZON)
    turned = [plane(item["point"], [-part for part in item["normal"]], "white") for item in walls]
    backs = scene_of([*turned, sphere([0, 0, 0], 0.1, "white")], {"white": MATTE})
    assert reach_of_planes(backs) == reach_of_planes(scene)
