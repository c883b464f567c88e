"""Editing of a scene and its settings, with undo."""

from dataclasses import replace
from typing import Any, Generic, TypeVar

from glrt.core.errors import GlrtError
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for
from glrt.view.edits.edited_state import State
from glrt.view.edits.locks import followed
from glrt.view.edits.state_differences import change_text

Value = TypeVar("Value")

MOST = 500  # steps that can be undone


class History(Generic[Value]):
    """The states before and after the present one; a gesture, such as a drag, is one step."""

    def __init__(self) -> None:
        """Begin with an empty history."""
        self._past: list[Value] = []
        self._future: list[Value] = []
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
    def steps(self) -> int:
        """Number of steps that can be undone, at most MOST."""
        return len(self._past)

    @property
    def before(self) -> Value | None:
        """Value that undo would restore; None if there is none."""
        return self._past[-1] if self._past else None

    @property
    def undone(self) -> Value | None:
        """Value that redo would restore; None if there is none."""
        return self._future[-1] if self._future else None

    def record(self, before: Value, gesture: str = "") -> None:
        """Remember the state before an edit.

        Consecutive edits of one gesture are one step, until `settle` ends it; "" is no gesture.
        """
        if not (gesture and gesture == self._gesture):
            self._past = [*self._past[-MOST + 1 :], before]
        self._gesture = gesture
        self._future.clear()

    def forget(self) -> None:
        """Begin again, with an empty history."""
        self._past, self._future = [], []
        self.settle()

    def settle(self) -> None:
        """End the gesture, as when the mouse is released."""
        self._gesture = ""

    def undo(self, present: Value) -> Value:
        """Return the state before the present one; `present` if there is none."""
        return self._step(self._past, self._future, present)

    def redo(self, present: Value) -> Value:
        """Return the state that was undone last; `present` if there is none."""
        return self._step(self._future, self._past, present)

    def _step(self, source: list[Value], target: list[Value], present: Value) -> Value:
        self.settle()
        if not source:
            return present
        target.append(present)
        return source.pop()


class Editing:
    """The requested scene and settings, which a renderer follows from frame to frame."""

    def __init__(self, opened: State) -> None:
        """Begin with the opened state and an empty history."""
        self.state = self.opened = opened
        self.history: History[State] = History()
        self.problem = ""  # message of the last refused edit

    @property
    def scene(self) -> Scene:
        """The edited scene."""
        return self.state.scene

    @property
    def settings(self) -> Settings:
        """The edited settings, at full picture size."""
        return self.state.settings

    @property
    def by_length(self) -> bool:
        """Whether the film keeps the light of each bounce in a separate layer."""
        return self.state.by_length

    @by_length.setter
    def by_length(self, wanted: bool) -> None:
        self._take(replace(self.state, by_length=wanted))

    @property
    def undoes(self) -> str:
        """Edit that undo would take back, in a few words; "" if there is none."""
        before = self.history.before
        return f"Undo: {change_text(before, self.state)}" if before else ""

    @property
    def redoes(self) -> str:
        """Edit that redo would make again, in a few words; "" if there is none."""
        after = self.history.undone
        return f"Redo: {change_text(self.state, after)}" if after else ""

    def edit(self, scene: Scene | None = None, gesture: str = "", **changes: Any) -> None:
        """Change scene or settings from the next frame on; a refusal sets `problem`, not raises."""
        try:
            settings = settings_for(self.settings, **changes)
        except GlrtError as error:
            self.problem = str(error)
            return
        self._take(self._with(scene or self.scene, settings), gesture)

    def open(self, opened: State) -> None:
        """Begin with another scene, without locks; undo leads back."""
        self.opened = opened
        self._take(replace(opened, by_length=self.by_length))

    def show(self, scene: Scene) -> None:
        """Show another moment of the scene: no edit, and no step of undo."""
        self.state = replace(self.state, scene=scene)

    def lock(self, number: int, wanted: bool) -> None:
        """Lock an object against edits, or unlock it; this is a step of undo."""
        rest = self.state.locked - {number}
        self._take(replace(self.state, locked=rest | {number} if wanted else rest))

    def _with(self, scene: Scene, settings: Settings) -> State:
        """Return the state with another scene and settings; locks stay with their objects."""
        locked = followed(self.state.locked, self.scene.objects, scene.objects)
        return replace(self.state, scene=scene, settings=settings, locked=locked)

    def undo(self) -> None:
        """Undo the last gesture."""
        self.state = self.history.undo(self.state)

    def redo(self) -> None:
        """Redo the gesture that was undone last."""
        self.state = self.history.redo(self.state)

    def _take(self, after: State, gesture: str = "") -> None:
        if after != self.state:
            self.history.record(self.state, gesture)
            self.state = after
