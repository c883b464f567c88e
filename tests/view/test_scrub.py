"""A drag on a label, as a function of pixels; and the values that a double click goes back to."""

from typing import Any

import pytest

from glrt.image.sources import load
from glrt.scene.camera import Camera
from glrt.settings import Cost
from glrt.view.controls import Control, controls_of, replaced, switch
from glrt.view.edits.scene_edits import opened_shape, with_object, without_objects
from glrt.view.widgets.reset import gesture_texts
from glrt.view.widgets.scrub import after_drag, can_scrub

ROOM = load("cornell")
FOV = next(it for it in controls_of(Camera) if it.name == "fov")


def number(**parts: Any) -> Control:
    return Control("it", parts.pop("kind", "number"), "", Cost.FREE, **parts)


@pytest.mark.parametrize(
    ("control", "value", "pixels", "after"),
    [
        (number(slider=(0, 30)), 10.0, 100, 20.0),
        (number(slider=(0, 30)), 10.0, -200, 0.0),
        (number(slider=(0, 30)), 10.0, 900, 30.0),
        (number(slider=(0, 30)), 50.0, 900, 50.0),
        (number(slider=(0, 30)), 50.0, -100, 40.0),
        (number(slider=(0.001, 1000)), 1.0, 150, 1000.0),
        (number(), 2.0, 100, 3.0),
        (number(), -2.0, 100, -1.0),
        (number(kind="integer", slider=(0, 64)), 10, 12, 13),
        (number(kind="integer"), 7, 10, 10),
        (number(kind="color"), (1.0, 0.0, 4.0), 100, (2.0, 0.0, 8.0)),
    ],
)
def test_a_drag_moves_a_value_within_its_slider(
    control: Control, value: Any, pixels: float, after: Any
) -> None:
    assert after_drag(control, value, pixels) == pytest.approx(after)
    assert after_drag(control, value, 0) == value


def test_switches_and_vectors_are_not_dragged() -> None:
    assert not can_scrub(switch("it", "", Cost.FREE))
    assert not can_scrub(number(kind="vector"))


def test_the_tooltip_says_what_a_double_click_goes_back_to() -> None:
    assert (
        gesture_texts(FOV)[-1] == f"A double click on the label sets the default: {FOV.default:g}"
    )
    assert gesture_texts(FOV.back_to(38.0))[-1].endswith("goes back to the scene's value: 38")
    assert gesture_texts(FOV.back_to(None)) == gesture_texts(FOV)
    assert gesture_texts(switch("it", "", Cost.FREE).back_to(True)) == []


def test_an_object_goes_back_to_the_one_of_its_name_or_else_of_its_number() -> None:
    objects = ROOM.objects
    plain = with_object(ROOM, 0, replaced(objects[0], name=None)).objects
    moved = with_object(ROOM, 5, replaced(objects[5], radius=0.1))
    assert opened_shape(objects, moved.objects, 5) is objects[5]
    assert opened_shape(objects, without_objects(moved, {0}).objects, 4) is objects[5]
    assert opened_shape(plain, plain, 0) is plain[0]
    assert opened_shape(plain, plain[:-1], 0) is None, "another may have its number"
    assert opened_shape((objects[5], *objects[1:]), objects, 5) is objects[5]
    twins = (objects[5], *objects[1:])
    assert opened_shape(twins, (*objects, objects[5]), 5) is None, "two have the name"
    renamed = with_object(ROOM, 5, replaced(objects[5], name="other")).objects
    assert opened_shape(objects, renamed, 5) is None
