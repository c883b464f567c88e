"""Where a copy of an object stands; no window, no OpenGL."""

import numpy as np
import pytest

from glrt.scene.shapes.kinds import Shape
from glrt.view.viewport.transform import clear_of
from tests.support.builders import box, disk, plane, quad, scene_of, sphere

PIVOT = (0.0, 0.0, 0.0)


def made(shape: dict[str, object]) -> Shape:
    return scene_of([shape], {"white": {"type": "lambertian", "color": [0.5, 0.5, 0.5]}}).objects[0]


@pytest.mark.parametrize("height", [-0.6, 0.6])
@pytest.mark.parametrize("kind", ["sphere", "box"])
def test_a_copy_of_a_solid_stands_clear_of_it_towards_the_pivot(kind: str, height: float) -> None:
    place = (0.3, height, -0.2)
    low, high = (tuple(part + side * 0.25 for part in place) for side in (-1, 1))
    shape = made(sphere(place, 0.25, "white") if kind == "sphere" else box(low, high, "white"))
    copy = clear_of(shape, PIVOT, 0.1)
    step = np.subtract(copy.middle, shape.middle)
    assert np.sign(step[1]) == -np.sign(height)
    assert 0.5 < abs(step[1]) < 0.6, "no point is in both, and no gap is wide"
    assert step[0] == step[2] == 0
    assert copy.reach == pytest.approx(shape.reach)


@pytest.mark.parametrize(
    "shape",
    [
        quad([-9, -1, -9], [18, 0, 0], [0, 0, 18], "white"),
        disk([0, -1, 0], [0, 1, 0], 9.0, "white"),
        plane([0, -1, 0], [0, 2, 0], "white"),
        plane([-1, 0, 0], [3, 0, 0], "white"),
    ],
)
def test_a_copy_of_what_is_flat_stays_in_sight_off_its_surface(shape: dict[str, object]) -> None:
    """However wide it is: two surfaces in one place shade each other at random."""
    before = made(shape)
    after = clear_of(before, PIVOT, 0.1)
    assert np.linalg.norm(np.subtract(after.middle, before.middle)) == pytest.approx(0.1)
    normal = np.array(getattr(before, "normal", (0, 1, 0)), float)
    along = np.dot(np.subtract(after.middle, before.middle), normal / np.linalg.norm(normal))
    assert along == pytest.approx(0.1)
