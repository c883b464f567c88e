"""Lamps of one side, seen from both: mirrored and turned, each shines where its front is."""

from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.view.edits.new_objects import LAMP, with_new
from tests.support.builders import MATTE, lamp, plane, scene_of
from tests.support.meshes import mesh, quads
from tests.support.renders import rendered

SQUARE = quads([[-1, -1, 0], [2, 0, 0], [0, 2, 0]])  # its front looks along +z
FLIP_X = [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
FLIP_Z = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]
TURNED: dict[str, tuple[dict[str, Any], int]] = {
    "as it is": ({}, 1),
    "mirrored along x": ({"scale": [-1, 1, 1]}, 1),
    "mirrored along z": ({"scale": [1, 1, -1]}, -1),
    "mirrored along all": ({"scale": -1}, -1),
    "by a matrix along x": ({"matrix": FLIP_X}, 1),
    "by a matrix along z": ({"matrix": FLIP_Z}, -1),
    "turned about y": ({"rotate": [0, 180, 0]}, -1),
}


@pytest.mark.parametrize("name", TURNED)
def test_a_mesh_of_one_side_shines_from_its_front(name: str, context: Context) -> None:
    placed, side = TURNED[name]
    shining = mesh(SQUARE, "lamp", smooth=False, **placed) | {"emission_side": "front"}
    seen = {}
    for z in (3, -3):
        view = {"position": [0.2, 0.1, z], "look_at": [0.2, 0.1, 0], "fov": 1.0}
        scene = scene_of([shining], {"lamp": lamp(2.0)}, view)
        seen[z] = float(rendered(scene, context, 1, width=1, height=1).radiance.mean())
    assert seen == {3 * side: 2.0, -3 * side: 0.0}


def test_a_lamp_that_is_added_lights_what_is_below(context: Context) -> None:
    """Half a unit above a floor: almost the whole half-space, albedo 0.5 of radiance 10."""
    view = {"position": [0, 0.1, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 1.0}
    floor = scene_of([plane([0, 0, 0], [0, 1, 0], "floor")], {"floor": MATTE}, view)
    scene = with_new(floor, LAMP, (0.0, 0.5, 0.0), 5.0)
    image = rendered(scene, context, 16, width=2, height=2, bounces=1)
    assert np.mean(image.radiance) == pytest.approx(5, rel=0.05)
