"""The list of what a scene holds, and locks of objects; no window, no OpenGL."""

from dataclasses import replace

import pytest

from glrt.core.errors import UsageError
from glrt.image.sources import load
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from glrt.view.controls import replaced
from glrt.view.edits.edited_state import State
from glrt.view.edits.editing import Editing
from glrt.view.edits.locks import check_locks, followed
from glrt.view.edits.scene_edits import with_duplicate, with_object, without_objects
from glrt.view.edits.state_differences import change_text
from glrt.view.outliner.contents import Entry, entries_of, text_of

ROOM = load("cornell")
START = State(ROOM, settings_for(ROOM.render))
BALL = next(n for n, shape in enumerate(ROOM.objects) if shape.name == "glass ball")
LAMP = next(n for n, shape in enumerate(ROOM.objects) if shape.name == "lamp")


def numbers(words: str, scene: Scene = ROOM) -> list[int]:
    found = entries_of(scene, words, ())
    return [entry.number for entry in found if entry.kind == "object"]


def refusal(locks: frozenset[int], after: Scene) -> str:
    try:
        check_locks(locks, ROOM, after)
    except UsageError as error:
        return str(error)
    return ""


def test_camera_light_objects_and_media_are_listed_in_groups() -> None:
    fog = load("fog")
    found = entries_of(fog, "", ())
    assert [it.name for it in found if it.kind != "object"] == [
        *("camera", "light", "background", "sun", "objects", "media", "fog")
    ]
    assert sorted(numbers("", fog)) == list(range(len(fog.objects)))
    assert entries_of(ROOM, "", ())[1:3] == [Entry("group", "light", 1), Entry("object", "", LAMP)]


def test_a_folded_group_counts_its_rows() -> None:
    folded = entries_of(ROOM, "", {"objects"})
    assert folded[-1] == Entry("group", "objects", len(ROOM.objects) - 1)


@pytest.mark.parametrize("words", ["ball GLASS", "sphere glass", f"{BALL} ball"])
def test_rows_are_found_by_all_of_the_words(words: str) -> None:
    assert numbers(words) == [BALL]
    assert numbers(f"{words} nothing") == []


def test_words_find_rows_of_folded_groups_and_the_camera() -> None:
    assert Entry("object", "", BALL) in entries_of(ROOM, "glass", {"objects"})
    assert entries_of(ROOM, "came", ()) == [Entry("camera", "camera")]


def test_objects_without_a_name_and_those_of_one_name_stay_apart() -> None:
    plain = with_object(ROOM, BALL, replaced(ROOM.objects[BALL], name=None))
    twins = replaced(plain, objects=(*plain.objects, ROOM.objects[0]))
    last = len(twins.objects) - 1
    texts = {n: text_of(Entry("object", "", n), twins.objects) for n in (0, BALL, last)}
    assert texts == {0: "floor", BALL: "sphere of glass", last: "floor"}
    assert Entry("object", "", 0).key != Entry("object", "", last).key


def test_a_lock_stays_with_its_object_when_others_come_and_go() -> None:
    edits = Editing(START)
    edits.lock(BALL, True)
    edits.edit(without_objects(ROOM, {0}))
    assert edits.state.locked == {BALL - 1}
    edits.edit(with_duplicate(edits.scene, 0))
    assert edits.state.locked == {BALL - 1}
    edits.undo()
    edits.undo()
    assert edits.state.locked == {BALL}
    edits.undo()
    assert not edits.state.locked


def test_another_scene_begins_without_locks() -> None:
    edits = Editing(START)
    edits.lock(0, True)
    edits.open(replace(START, scene=with_object(ROOM, 0, ROOM.objects[1])))
    assert not edits.state.locked
    edits.undo()
    assert edits.state.locked == {0}


def test_edits_of_a_locked_object_are_refused_by_its_name() -> None:
    locks = frozenset({BALL})
    moved = with_object(ROOM, BALL, replaced(ROOM.objects[BALL], radius=0.1))
    for after in (moved, without_objects(ROOM, {BALL})):
        assert refusal(locks, after).startswith("glass ball (object 6) is locked.")
    for after in (without_objects(ROOM, {0}), with_object(ROOM, 0, ROOM.objects[1])):
        assert refusal(locks, after) == ""


def test_a_lock_is_no_edit_of_the_scene_and_told_by_undo() -> None:
    locked = replace(START, locked=frozenset({BALL}))
    assert change_text(START, locked) == "lock of glass ball"
    assert followed(locked.locked, ROOM.objects, ROOM.objects) == locked.locked
