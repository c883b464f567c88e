"""The changes that undo takes back, in words; no window, no OpenGL."""

from dataclasses import replace
from typing import Any

import pytest

from glrt.image.sources import load
from glrt.scene.scene import with_lights
from glrt.settings import settings_for
from glrt.view.controls import replaced
from glrt.view.edits.edited_state import State
from glrt.view.edits.new_objects import with_new
from glrt.view.edits.scene_edits import (
    with_object,
    with_own_material,
    with_renamed_material,
    with_retyped,
    without_objects,
    without_unused_materials,
)
from glrt.view.edits.state_differences import change_text

ROOM = load("cornell")
START = State(ROOM, settings_for(ROOM.render))
BALL = next(n for n, shape in enumerate(ROOM.objects) if shape.name == "glass ball")


def reshaped(**changes: Any) -> State:
    shape = replaced(ROOM.objects[BALL], **changes)
    return replace(START, scene=with_object(ROOM, BALL, shape))


@pytest.mark.parametrize(
    ("after", "told"),
    [
        (START, ""),
        (reshaped(center=(0.0, 0.0, 0.0)), "center of glass ball"),
        (reshaped(radius=0.1, hidden=True), "hidden, radius of glass ball"),
        (reshaped(name="pearl"), "name of pearl"),
        (replace(START, scene=without_objects(ROOM, {BALL})), "glass ball deleted"),
        (replace(START, scene=with_new(ROOM, "box", (0, 0, 0), 0.1)), "box added"),
        (replace(START, scene=with_retyped(ROOM, "glass", "metal")), "material glass"),
        (replace(START, scene=with_lights(ROOM, {"lamp": 2.0})), "light lamp"),
        (replace(START, by_length=True), "bounces live"),
        (replace(START, settings=settings_for(START.settings, bounces=3, seed=4)), "bounces, seed"),
    ],
)
def test_an_edit_is_reported_in_a_few_words(after: State, told: str) -> None:
    assert change_text(START, after) == told


def test_a_renamed_material_is_reported_and_not_each_of_its_objects() -> None:
    renamed = with_renamed_material(ROOM, "white", "chalk")
    assert change_text(START, replace(START, scene=renamed)) == "name of material chalk"


def test_materials_that_go_alone_are_reported() -> None:
    spare = with_own_material(with_own_material(ROOM, BALL), BALL)
    cleared = without_unused_materials(spare)
    told = change_text(replace(START, scene=spare), replace(START, scene=cleared))
    assert told == "unused materials"


def test_of_many_changes_the_first_are_reported() -> None:
    camera = replaced(ROOM.camera, fov=20.0)
    scene = ROOM.model_copy(update={"camera": camera})
    settings = settings_for(START.settings, bounces=3, seed=4, samples=9)
    told = change_text(START, replace(START, scene=scene, settings=settings))
    assert told.startswith("camera, ")
    assert told.endswith(" and 1 more")
