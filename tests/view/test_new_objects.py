"""Where the window puts new objects: not inside of what is there."""

from typing import Any

import numpy as np
import pytest

import glrt
from glrt.image.sources import load
from glrt.scene.camera import Camera
from glrt.scene.shapes.quad import Quad
from glrt.view.controls import replaced
from glrt.view.edits.new_objects import ADDED, LAMP, with_new, with_new_near
from tests.support.builders import MATTE, box, scene_of, sphere
from tests.support.meshes import icosphere

BALL = sphere([0.0, 0.0, 0.0], 1.0, "matte")
EYE: Any = Camera(position=(0.0, 1.0, 6.0), look_at=(0.0, 0.0, 0.0))
MIDDLE = 0.0, 0.0, 0.0
SIZE = 0.5


def seen_by(camera: Any, *things: dict[str, Any]) -> Any:
    return replaced(scene_of([*things], {"matte": MATTE}), camera=camera)


def test_a_lamp_hangs_above_the_object_to_the_left_and_faces_it() -> None:
    lamp = with_new_near(seen_by(EYE, BALL), LAMP, MIDDLE, SIZE).objects[-1]
    assert isinstance(lamp, Quad)
    middle = np.array(lamp.middle)
    assert middle[1] > 1
    assert middle[0] < -0.5
    assert middle[2] > 0.3
    assert np.linalg.norm(middle) > 1 + SIZE
    normal = np.cross(lamp.edge_u, lamp.edge_v)
    normal /= np.linalg.norm(normal)
    assert normal @ (-middle / np.linalg.norm(middle)) > 0.999
    sides = np.linalg.norm(lamp.edge_u), np.linalg.norm(lamp.edge_v)
    assert sides == pytest.approx((sides[0],) * 2, rel=1e-5)
    assert abs(np.dot(lamp.edge_u, lamp.edge_v)) < 1e-5


@pytest.mark.slow
def test_a_lamp_above_a_model_makes_it_brighter() -> None:
    """Inside, where it hung before, it changed nothing."""
    vertices, faces = icosphere(2)
    mesh = glrt.Mesh(vertices, faces, material="matte")
    dark = replaced(seen_by(EYE, BALL), objects=(mesh,))
    bright = with_new_near(dark, LAMP, MIDDLE, SIZE)
    within = with_new(dark, LAMP, MIDDLE, SIZE)
    means = [
        glrt.render(scene, width=16, height=16, samples=16).radiance.mean()
        for scene in (within, bright)
    ]
    assert means[0] == 0
    assert means[1] > 0.01


@pytest.mark.parametrize("kind", [kind for kind in ADDED if kind not in (LAMP, "plane")])
def test_other_objects_stand_on_top(kind: str) -> None:
    added = with_new_near(seen_by(EYE, BALL), kind, MIDDLE, SIZE).objects[-1]
    assert added.middle[1] > 1
    assert added.middle[0] == added.middle[2] == 0


@pytest.mark.parametrize("kind", ADDED)
def test_in_a_room_objects_are_put_at_the_pivot(kind: str) -> None:
    """A room of quads, and a box that contains the camera."""
    cornell = load("cornell")
    pivot = cornell.camera.look_at
    assert with_new_near(cornell, kind, pivot, SIZE) == with_new(cornell, kind, pivot, SIZE)
    inside = seen_by(EYE, box([-9, -9, -9], [9, 9, 9], "matte"))
    assert with_new_near(inside, kind, MIDDLE, SIZE) == with_new(inside, kind, MIDDLE, SIZE)
