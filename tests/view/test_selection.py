"""Several objects are selected, and hidden, deleted and given a material as one."""

from typing import Any

import pytest

from glrt.view.edits.edited_state import State, plain
from glrt.view.edits.editing import Editing
from glrt.view.edits.scene_edits import with_objects, without_objects
from glrt.view.messages import Messages
from glrt.view.selection import Selection
from glrt.view.viewport.transform import with_moved
from tests.support.builders import MATTE, scene_of, sphere


@pytest.fixture
def app() -> Any:
    """A selection among four balls, without a window."""
    balls = [sphere([x, 0, -9], 0.4, "m") for x in range(4)]
    scene = scene_of(balls, {"m": MATTE, "n": MATTE}, background={"color": [1, 1, 1]})
    selection: Any = Selection()
    selection.session = Editing(State(scene, plain(scene.render)))
    selection.messages = Messages(selection.session)
    selection.select(1)
    return selection


def test_objects_are_added_to_the_selection_and_taken_out(app: Any) -> None:
    assert app.chosen == {1}
    app.select_also(3)
    assert (app.selected, app.chosen) == (3, {1, 3})
    app.select_also(0)
    assert (app.selected, app.chosen) == (0, {0, 1, 3})
    app.select_also(3)
    assert (app.selected, app.chosen) == (0, {0, 1})
    app.select_also(0)
    assert (app.selected, app.chosen) == (1, {1})
    app.select_also(1)
    assert (app.selected, app.chosen) == (None, frozenset())


@pytest.mark.parametrize("other", [2, None, 1])
def test_another_selection_forgets_the_others(app: Any, other: int | None) -> None:
    app.select_also(3)
    app.select(other)
    assert app.chosen == ({other} if other is not None else frozenset())


def test_all_selected_objects_are_deleted_and_come_back_by_one_step(app: Any) -> None:
    before = app.session.scene
    app.select_also(3)
    app.delete()
    assert app.session.scene.objects == (before.objects[0], before.objects[2])
    assert app.selected is None
    app.session.undo()
    assert app.session.scene is before
    app.session.redo()
    assert app.chosen == frozenset()


def test_a_lock_keeps_all_of_them(app: Any) -> None:
    before = app.session.scene
    app.session.lock(1, True)
    app.select_also(3)
    app.delete()
    assert app.session.scene is before
    assert "locked" in app.session.problem
    assert app.chosen == {1, 3}


def test_the_eye_of_a_selected_object_hides_all_of_them_and_another_eye_its_own(app: Any) -> None:
    app.select_also(3)
    app.show_object(1, False)
    assert [shape.hidden for shape in app.session.scene.objects] == [False, True, False, True]
    app.show_object(0, False)
    assert [shape.hidden for shape in app.session.scene.objects] == [True, True, False, True]


def test_a_move_takes_the_other_selected_objects_along(app: Any) -> None:
    scene: Any = app.session.scene
    larger = scene.objects[1].model_copy(update={"center": (1.0, 2.0, -9.0), "radius": 0.8})
    new: Any = with_moved(scene, 1, larger, frozenset({1, 3}))
    assert [shape.center[1] for shape in new.objects] == [0, 2, 0, 2]
    assert [shape.radius for shape in new.objects] == [0.4, 0.8, 0.4, 0.4]
    scaled = scene.objects[1].model_copy(update={"radius": 0.8})
    only = with_moved(scene, 1, scaled, frozenset({1, 3}))
    assert only.objects[3] is scene.objects[3]


def test_edits_of_some_objects_leave_the_others_as_they_are(app: Any) -> None:
    scene = app.session.scene
    new = with_objects(scene, {1, 2}, lambda shape: shape.model_copy(update={"material": "n"}))
    assert [shape.material for shape in new.objects] == ["m", "n", "n", "m"]
    assert new.objects[0] is scene.objects[0]
    assert without_objects(scene, {0, 1, 2}).objects == scene.objects[3:]
