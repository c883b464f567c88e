"""Undo and redo."""

from glrt.view.edits.editing import MOST, History


def test_undo_and_redo_walk_through_the_states() -> None:
    history: History[int] = History()
    for before in (1, 2):
        history.record(before)
    assert history.undo(3) == 2
    assert history.undo(2) == 1
    assert not history.can_undo
    assert history.undo(1) == 1
    assert history.redo(1) == 2
    assert history.redo(2) == 3
    assert not history.can_redo
    assert history.redo(3) == 3


def test_edits_of_one_gesture_are_one_step() -> None:
    history: History[int] = History()
    for before in (1, 2, 3):
        history.record(before, "drag")
    assert history.undo(4) == 1


def test_a_gesture_ends_when_it_settles_and_when_another_begins() -> None:
    history: History[int] = History()
    history.record(1, "drag")
    history.settle()
    history.record(2, "drag")
    history.record(3, "wheel")
    history.record(4)
    history.record(5)
    assert [history.undo(n) for n in (6, 5, 4, 3, 2)] == [5, 4, 3, 2, 1]


def test_a_new_edit_forgets_what_was_undone() -> None:
    history: History[int] = History()
    history.record(1)
    history.undo(2)
    history.record(1, "drag")
    assert not history.can_redo
    history.undo(7)
    history.record(7, "drag")
    assert history.undo(8) == 7, "undo ends a gesture"


def test_old_states_are_forgotten() -> None:
    history: History[int] = History()
    for before in range(2 * MOST):
        history.record(before)
    undone = 0
    while history.can_undo:
        history.undo(0)
        undone += 1
    assert undone == MOST


def test_a_forgotten_history_leads_nowhere() -> None:
    history: History[int] = History()
    history.record(1)
    history.record(2, "drag")
    history.undo(3)
    history.forget()
    assert not history.can_undo
    assert not history.can_redo
    history.record(4, "drag")
    history.record(5, "drag")
    assert history.steps == 1
