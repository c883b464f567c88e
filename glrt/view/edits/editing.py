"""Editing of a scene and its settings, with undo."""

from dataclasses import replace
from typing import Any

from glrt.core.errors import GlrtError
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for
from glrt.view.edits.edited_state import State
from glrt.view.edits.history import History


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

    def edit(self, scene: Scene | None = None, gesture: str = "", **changes: Any) -> None:
        """Change scene or settings from the next frame on; a refusal sets `problem`, not raises."""
        try:
            settings = settings_for(self.settings, **changes)
        except GlrtError as error:
            self.problem = str(error)
            return
        self._take(replace(self.state, scene=scene or self.scene, settings=settings), gesture)

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
