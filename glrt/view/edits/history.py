"""Undo and redo of values that are never changed in place."""

from typing import Generic, TypeVar

State = TypeVar("State")

MOST = 500  # steps that can be undone


class History(Generic[State]):
    """The states before and after the present one; a gesture, such as a drag, is one step."""

    def __init__(self) -> None:
        """Begin with an empty history."""
        self._past: list[State] = []
        self._future: list[State] = []
        self._gesture = ""

    @property
    def can_undo(self) -> bool:
        """Whether there is a state before this one."""
        return bool(self._past)

    @property
    def can_redo(self) -> bool:
        """Whether there is a state that was undone."""
        return bool(self._future)

    @property
    def before(self) -> State | None:
        """State that undo would restore; None if there is none."""
        return self._past[-1] if self._past else None

    @property
    def undone(self) -> State | None:
        """State that redo would restore; None if there is none."""
        return self._future[-1] if self._future else None

    def record(self, before: State, gesture: str = "") -> None:
        """Remember the state before an edit.

        Consecutive edits of one gesture are one step, until `settle` ends it; "" is no gesture.
        """
        if not (gesture and gesture == self._gesture):
            self._past = [*self._past[-MOST + 1 :], before]
        self._gesture = gesture
        self._future.clear()

    def settle(self) -> None:
        """End the gesture, as when the mouse is released."""
        self._gesture = ""

    def undo(self, present: State) -> State:
        """Return the state before the present one; `present` if there is none."""
        return self._step(self._past, self._future, present)

    def redo(self, present: State) -> State:
        """Return the state that was undone last; `present` if there is none."""
        return self._step(self._future, self._past, present)

    def _step(self, source: list[State], target: list[State], present: State) -> State:
        self.settle()
        if not source:
            return present
        target.append(present)
        return source.pop()
