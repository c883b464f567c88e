"""Tiny lamps in view: for them, too, the pilot of `--caustics auto` runs."""

import pytest

from glrt.analysis.method_choice.caustics import may_gain, particles_worth
from glrt.gpu.context import Context
from glrt.settings import settings_for
from tests.support.builders import MATTE, lamp, plane, scene_of, sphere

CAMERA = {"position": [0, 0, 0], "look_at": [0, 0, -1], "fov": 40}
FLOOR = plane([0, -1, 0], [0, 1, 0], "matte")


@pytest.mark.parametrize(
    ("radius", "place", "expected"),
    [(0.002, 0.0, True), (0.5, 0.0, False), (0.002, 2.5, False), (0.002, -9.0, False)],
)
def test_a_tiny_lamp_in_view_is_worth_a_pilot(radius: float, place: float, expected: bool) -> None:
    """In a matte scene: not a large one, nor one out of the frame or behind the camera."""
    center = [place, 0, 9] if place < 0 else [place, 0, -4]
    things = [sphere(center, radius, "lamp"), FLOOR]
    scene = scene_of(things, {"lamp": lamp(5.0), "matte": MATTE}, CAMERA)
    settings = settings_for(scene.render, width=64, height=64, samples=1 << 20)
    assert may_gain(scene, settings) == expected


@pytest.mark.slow
def test_a_tiny_lamp_in_view_gets_particles(context: Context) -> None:
    things = [sphere([0, 0, -4], 0.01, "lamp"), FLOOR]
    scene = scene_of(things, {"lamp": lamp(5e4), "matte": MATTE}, CAMERA)
    found = particles_worth(
        scene, settings_for(scene.render, width=64, height=64, samples=1 << 20), context
    )
    assert found
    assert (found.settings.caustics, found.gain > 3) == ("on", True)
