"""The scene and the settings as they are edited, with what undo takes back."""

from dataclasses import replace
from typing import Any

from glrt.core.errors import GlrtError
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for
from glrt.view.edits.edited_state import State
from glrt.view.edits.history import History


class Editing:
    """What is wanted now. Who renders it takes it up from frame to frame."""

    def __init__(self, opened: State) -> None:
        """Nothing to take back yet."""
        self.state = self.opened = opened
        self.history: History[State] = History()
        self.problem = ""  # the last refusal

    @property
    def scene(self) -> Scene:
        """The scene as edited."""
        return self.state.scene

    @property
    def settings(self) -> Settings:
        """The settings as edited, at full size."""
        return self.state.settings

    @property
    def by_length(self) -> bool:
        """Whether the film is to keep the light of each bounce apart."""
        return self.state.by_length

    @by_length.setter
    def by_length(self, wanted: bool) -> None:
        self._take(replace(self.state, by_length=wanted))

    def edit(self, scene: Scene | None = None, gesture: str = "", **changes: Any) -> None:
        """Take another scene or settings from the next frame on; a refusal is told, not raised."""
        try:
            settings = settings_for(self.settings, **changes)
        except GlrtError as error:
            self.problem = str(error)
            return
        self._take(replace(self.state, scene=scene or self.scene, settings=settings), gesture)

    def undo(self) -> None:
        """Take back the last gesture."""
        self.state = self.history.undo(self.state)

    def redo(self) -> None:
        """Do again what was taken back."""
        self.state = self.history.redo(self.state)

    def _take(self, after: State, gesture: str = "") -> None:
        if after != self.state:
            self.history.record(self.state, gesture)
            self.state = after
