"""The part of a window that keeps unsaved edits, without a window."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from glrt.image.sources import load
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from glrt.view.edits.edited_state import State
from glrt.view.edits.editing import Editing
from glrt.view.edits.new_objects import with_new_near
from glrt.view.files import Files
from glrt.view.messages import Messages
from glrt.view.recovery.keeper import SOON, Recovery
from tests.support.sessions import Clock

WINDOWS: list["Opened"] = []  # of a test


class Opened:
    """The part of a window that keeps a scene and its files, on a clock that tests set."""

    def __init__(self, place: Path, source: str = "cornell", piped: Scene | None = None) -> None:
        scene = piped or load(source)
        self.session = Editing(State(scene, settings_for(scene.render)))
        session: Any = self.session
        recent, self.shown = place / "recent.json", list[Scene]()
        messages = Messages(session)
        self.files = Files(session, messages, source, recent, self.shown.append, lambda _: None)
        self.clock = Clock()
        self.recovery = Recovery(self.files, place / "recovery", self.clock)
        WINDOWS.append(self)

    @property
    def file(self) -> Path:
        return self.recovery.file

    def edit(self, make: Callable[[Scene], Scene] | None = None) -> None:
        """Make an edit, by default an added ball, and let the window look."""
        ball = partial(with_new_near, kind="sphere", pivot=(0.0, 0.0, 0.0), size=0.1)
        self.session.edit((make or ball)(self.session.scene))
        self.look()

    def look(self, seconds: float = SOON) -> None:
        self.clock.now += seconds
        self.recovery.follow()

    def die(self) -> None:
        """End as a killed process does: the system opens its locks."""
        claims = [offer.claim for offer in self.recovery.offers]
        for claim in (*claims, self.recovery._claim):
            if claim:
                claim.release()


def next_to(opened: Opened, source: str = "cornell", piped: Scene | None = None) -> Opened:
    """Another window, started later; `piped`: the scene from its standard input."""
    return Opened(opened.file.parents[1], source, piped)


def files_of(opened: Opened) -> list[str]:
    return sorted(file.name for file in opened.file.parent.glob("*"))


def let_all_die() -> None:
    """End all windows of a test."""
    while WINDOWS:
        WINDOWS.pop().die()
