"""Keys of glass: what goes together, what is refused, and what lies around the camera."""

from typing import Any

import numpy as np
import pytest

from glrt.core.errors import SceneError
from glrt.plan.facts import SceneFacts
from glrt.scene.glasses import glasses_of
from glrt.scene.loading.scene_files import placing_problems
from glrt.scene.warnings import cautions
from glrt.settings import settings_for
from tests.support.builders import (
    MATTE,
    box,
    cylinder,
    disk,
    glass,
    plane,
    quad,
    scene_of,
    sphere,
)
from tests.support.meshes import icosphere, mesh

BALL = sphere([0, 0, -3], 1, "glass")


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"attenuation_color": [1, 1, 1]}, "go together"),
        ({"attenuation_distance": 1.0}, "go together"),
        ({"attenuation_color": [1, 1, 2], "attenuation_distance": 1.0}, "attenuation_color"),
        ({"attenuation_color": [1, 1, 1], "attenuation_distance": 0.0}, "attenuation_distance"),
        ({"roughness": 1.5}, "roughness"),
        ({"thin": True, "priority": 0}, "a thin pane has no priority"),
        (
            {"thin": True, "attenuation_color": [1, 1, 1], "attenuation_distance": 1.0},
            "a thin pane has no attenuation_distance",
        ),
        ({"priority": 1.5}, "priority"),
    ],
)
def test_what_does_not_go_together_is_refused(keys: dict[str, Any], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        scene_of([BALL], {"glass": glass(**keys)})


def test_a_pane_may_be_flat_and_other_glass_may_not() -> None:
    for thing in (
        quad([0, 0, 0], [1, 0, 0], [0, 1, 0], "glass"),
        disk([0] * 3, [0, 1, 0], 1, "glass"),
    ):
        scene_of([thing], {"glass": glass(thin=True)})
        with pytest.raises(SceneError, match="thin = true"):
            scene_of([thing], {"glass": glass()})
    open_mesh = mesh((np.eye(3), np.array([[0, 1, 2]])), "glass")
    for keys, count in (({"thin": True}, 0), ({}, 1)):
        assert len(list(placing_problems(scene_of([open_mesh], {"glass": glass(**keys)})))) == count


def test_more_glasses_than_can_be_counted_are_refused_by_name() -> None:
    names = [f"glass {k}" for k in range(7)]
    balls = [sphere([3 * k, 0, -9], 1, name) for k, name in enumerate(names)]
    materials = {name: glass(priority=k) for k, name in enumerate(names)}
    scene_of(balls[:6], materials)
    with pytest.raises(SceneError, match=r"glass 6.*7 materials with a priority"):
        scene_of(balls, materials)


def test_objects_that_overlap_too_often_are_refused() -> None:
    many = [sphere([0, 0, -9 + 0.01 * k], 1, "glass") for k in range(32)]
    scene_of(many[:31], {"glass": glass(priority=1)})
    scene_of([*many[:31], sphere([5, 0, 0], 1, "glass")], {"glass": glass(priority=1)})
    with pytest.raises(SceneError, match="32 objects of 'glass' may overlap, and 31 can"):
        scene_of(many, {"glass": glass(priority=1)})


def test_glass_that_crosses_is_cautioned_unless_it_has_priorities() -> None:
    things = [sphere([0, 0, -3], 1, "a"), sphere([1, 0, -3], 1, "b")]
    for keys, said in (({}, True), ({"priority": 1}, False), ({"thin": True}, False)):
        scene = scene_of(things, {"a": glass(**keys), "b": glass(**keys)})
        found = cautions(scene, settings_for(scene.render))
        assert any("are glass and cross" in text for text in found) == said


SOLIDS = [
    (sphere([1, 2, 3], 2, "glass"), [1.5, 3, 4]),
    (box([0, 0, 0], [4, 4, 4], "glass", rotate=(20, 30, 40)), [2, 2, 3.8]),
    (cylinder([0, 0, 0], [4, 0, 0], 2, "glass"), [3.9, 1.5, -1]),
    (mesh(icosphere(2), "glass", translate=[5, 0, 0], scale=3), [5, 2, 1]),
    (plane([0, 1, 0], [0, 2, 0], "glass"), [50, 0.9, -20]),
]


@pytest.mark.parametrize(("solid", "inside"), SOLIDS)
def test_solids_hold_what_lies_inside(solid: dict[str, Any], inside: list[float]) -> None:
    shape = scene_of([solid], {"glass": glass()}).objects[0]
    assert shape.holds(np.array(inside))
    for far in ([9.0, 9, 9], [1.0, 6, -1], [2.0, 4.9, 3.9]):
        assert not shape.holds(np.array(far))


def test_the_glass_around_the_camera_is_the_highest_or_else_the_smallest() -> None:
    def tinted(share: float, **more: Any) -> dict[str, Any]:
        return glass(attenuation_color=[share] * 3, attenuation_distance=1.0, **more)

    things = [sphere([0, 0, 0], radius, f"{radius}") for radius in (1, 2, 3)]
    plain = {f"{radius}": tinted(np.exp(-radius)) for radius in (1, 2, 3)}
    ranked = {f"{radius}": tinted(np.exp(-radius), priority=radius) for radius in (1, 2, 3)}
    for materials, most, counts in ((plain, 1, 0), (ranked, 3, 1 | 1 << 5 | 1 << 10)):
        scene = scene_of(things, materials, {"position": [0, 0, 0.5]})
        found = SceneFacts(scene).camera_glass
        assert found.absorption == pytest.approx([most] * 3)
        assert found.counts == counts
    outside = scene_of(things, ranked, {"position": [0, 0, 2.5]})
    assert SceneFacts(outside).camera_glass.counts == 1
    clear = scene_of([BALL], {"glass": glass(), "floor": MATTE})
    assert glasses_of(clear, clear.finishes) == {}
