"""Objects in the place of another one: which of them is seen, and what is reported."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from glrt.scene.meshes.checked_meshes import MeshArrays, checked
from glrt.scene.meshes.repeated_triangles import _keys, repeated
from glrt.scene.twins import Twin, twins
from glrt.scene.warnings import cautions
from glrt.settings import settings_for
from tests.support.builders import MATTE, box, cylinder, disk, glass, lamp, plane, quad, sphere
from tests.support.builders import scene_of as scene_from
from tests.support.meshes import icosphere, mesh

MATERIALS = {
    "matte": MATTE,
    "lamp": lamp(2.0),
    "bright": lamp(6.0),
    "glass": glass(),
    "water": glass(1.33),
    "net": {"type": "principled", "color": [0.5] * 3, "alpha": 0.5},
}
FAR = [1e6, -1e6, 1e6]  # from the origin, where float32 has steps of 1/16


def quad_of(material: str, turned: bool = False, **more: Any) -> dict[str, Any]:
    """One quad; turned, it is given from another corner, and its normal points down."""
    if turned:
        return {**quad([1, 0, 1], [-1, 0, 0], [0, 0, -1], material), **more}
    return {**quad([0, 0, 0], [0, 0, 1], [1, 0, 0], material), **more}


def found(things: list[dict[str, Any]]) -> list[Twin]:
    scene = scene_from(things, MATERIALS)
    return list(twins(scene.objects, scene.materials))


FRONT: dict[str, Any] = {"emission_side": "front"}
SHAPES: dict[str, Callable[[str], dict[str, Any]]] = {
    "sphere": lambda m: sphere([1, 2, 3], 0.5, m),
    "plane": lambda m: plane([1, 2, 3], [0, 1, 1], m),
    "quad": quad_of,
    "disk": lambda m: disk([1, 2, 3], [0, 1, 1], 0.5, m),
    "box": lambda m: box([0, 0, 0], [1, 2, 3], m, rotate=(10, 20, 30)),
    "cylinder": lambda m: cylinder([0, 0, 0], [1, 2, 3], 0.5, m),
    "mesh": lambda m: mesh(icosphere(1), m),
}


@pytest.mark.parametrize("kind", SHAPES)
@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        ("matte", "matte", [(1, 0)]),
        ("matte", "lamp", [(0, 1)]),
        ("lamp", "matte", [(1, 0)]),
        ("lamp", "bright", [(1, 0)]),
        ("bright", "lamp", [(1, 0)]),
    ],
)
def test_the_emitter_is_seen_then_the_first(
    kind: str, first: str, second: str, expected: list[Any]
) -> None:
    assert found([SHAPES[kind](first), SHAPES[kind](second)]) == expected


@pytest.mark.parametrize("kind", ["sphere", "box", "mesh"])
def test_glass_and_nets_cover_their_own_material_alone(kind: str) -> None:
    make = SHAPES[kind]
    assert found([make("glass"), make("glass")]) == [(1, 0)]
    assert found([make("glass"), make("water")]) == []
    assert found([make("net"), make("net")]) == [(1, 0)]
    assert found([make("net"), make("matte")]) == []


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        (quad_of("lamp", **FRONT), quad_of("matte"), [(1, 0)]),
        (quad_of("matte"), quad_of("lamp", **FRONT), []),  # the matte one is seen from behind
        (quad_of("lamp", **FRONT), quad_of("bright", **FRONT), [(1, 0)]),
        (quad_of("lamp", **FRONT), quad_of("bright", turned=True, **FRONT), []),
        (quad_of("lamp", **FRONT), quad_of("bright"), []),
        (quad_of("lamp"), quad_of("bright", turned=True, **FRONT), [(1, 0)]),
    ],
)
def test_each_side_shows_one(first: Any, second: Any, expected: list[Any]) -> None:
    assert found([first, second]) == expected


def test_two_seen_from_their_sides_cover_a_third() -> None:
    up, down = quad_of("lamp", **FRONT), quad_of("bright", turned=True, **FRONT)
    assert [twin.unseen for twin in found([quad_of("matte"), up, down])] == [0]


@pytest.mark.parametrize("by", [1e-6, 1.0])
def test_shapes_that_differ_are_no_twins(by: float) -> None:
    """Far from the origin, too: places are compared relative to each other."""
    one = quad(FAR, [0, 0, 1], [1, 0, 0], "matte")
    other = quad([FAR[0] + by, *FAR[1:]], [0, 0, 1], [1, 0, 0], "matte")
    assert found([one, other]) == []
    assert found([one, one]) == [(1, 0)]


def test_hidden_objects_cover_nothing() -> None:
    hidden = {**quad_of("lamp"), "hidden": True}
    assert found([hidden, quad_of("matte")]) == []
    scene = scene_from([quad_of("matte"), quad_of("lamp"), hidden], MATERIALS)
    assert scene.shown == (1,)
    assert [thing.material for thing in scene.visible] == ["lamp"]


def test_what_is_left_out_is_reported() -> None:
    named = {**quad_of("lamp"), "name": "panel"}
    scene = scene_from([quad_of("matte"), named, sphere([0, 3, 0], 1, "matte")], MATERIALS)
    (text,) = cautions(scene, settings_for(scene.render))
    assert text.startswith("objects[0] (in the place of objects[1] 'panel')")
    assert "left out" in text


# --- triangles ----------------------------------------------------------------------------------


def test_triangles_of_equal_corners_are_found_whatever_comes_first() -> None:
    points, faces = icosphere(2)
    again = np.roll(faces[[3, 7, 11]], 1, axis=1) + len(points)  # by corners of their own
    turned = faces[[5]][:, ::-1]
    everything = np.concatenate([faces, again, turned])
    rows = np.flatnonzero(repeated(np.concatenate([points, points]), everything, None))
    assert rows.tolist() == [len(faces) + n for n in range(3)]


def test_corners_that_differ_in_signs_alone_have_other_keys() -> None:
    """Equal keys cost a comparison each: a symmetric mesh must not be slow to load."""
    points, faces = icosphere(4)
    assert len(np.unique(_keys(points, faces))) == len(faces)


def test_labels_keep_triangles_apart() -> None:
    points, faces = icosphere(0)
    twice = np.concatenate([faces, faces])
    labels = np.repeat([0, 1], len(faces))
    assert not repeated(points, twice, labels).any()
    assert repeated(points, twice, 0 * labels).sum() == len(faces)


def test_a_mesh_keeps_each_triangle_once_and_reports_it() -> None:
    points, faces = icosphere(1)
    twice = np.concatenate([faces, faces[:2]])
    made = checked(MeshArrays(points, twice))
    assert (len(made.faces), made.repeated) == (len(faces), 2)
    scene = scene_from([mesh((points, twice), "matte"), quad_of("lamp")], MATERIALS)
    texts = cautions(scene, settings_for(scene.render))
    assert any("2 triangles repeat others" in text for text in texts)
