"""Comparison of two pictures: A gathers samples while B is edited."""

from collections.abc import Callable
from typing import Literal

import moderngl

from glrt.core.errors import GlrtError
from glrt.settings import Settings
from glrt.view.edits.edited_state import State
from glrt.view.state.error_history import Progress
from glrt.view.state.session import Session
from glrt.view.viewport.picture import Picture
from glrt.view.viewport.picture_view import PictureView

Pairing = Literal["equal time", "equal samples"]


class Slot:
    """Picture A with a session of its own, on the same driver; B is the window's session."""

    def __init__(self, state: State, other: Session, gl: moderngl.Context) -> None:
        """Compile nothing yet; the first frames announce that a kernel will be compiled."""
        self.session = Session(state.scene, state.settings, other.context, pipeline=other.pipeline)
        self.picture = Picture(gl)
        self.progress = Progress(in_thread=True)
        self._shown: object = None

    def has_turn(self, other: Session, pairing: Pairing) -> bool:
        """Whether this frame renders A, so that A and B get the same time, or the same samples."""
        own = self.session
        own.paused = other.paused
        if own.is_done or other.is_behind or other.is_preview:
            return False
        if other.is_done:
            return True
        if pairing == "equal samples":
            return own.samples < other.samples
        return own.rendering < other.rendering

    def advance(self, seconds: float, count: int) -> None:
        """Render a frame of A; RenderError if the driver has no room for a second film."""
        self.session.advance(seconds, count)

    def draw(self, display: Settings) -> None:
        """Draw A's newest samples, exposed and tone-mapped as B."""
        session = self.session
        if not session.renderer or not session.is_shown:
            return
        content = session.samples, session.restarts, display.exposure, display.tonemap
        if content != self._shown:
            self.picture.draw(session.renderer.weighed(session.weights), display)
            self._shown = content

    def release(self) -> None:
        """Release all OpenGL objects."""
        self.picture.release()
        self.session.release()


class Pair:
    """Picture A, kept or gathering samples, and picture B, which the window edits."""

    def __init__(self, session: Session, show: PictureView, restart: Callable[[], None]) -> None:
        """`restart` restarts picture B."""
        self._session, self._show, self._restart = session, show, restart
        self.slot: Slot | None = None  # A, while it gathers samples
        self.pairing: Pairing = "equal time"
        self.is_beside = False  # side by side, else divided by a line

    @property
    def picture(self) -> tuple[Picture, bool] | None:
        """Picture that holds A, and whether A is its kept part; None without A."""
        if self.slot:
            return (self.slot.picture, False) if self.slot.picture.name else None
        kept = self._show.picture
        return (kept, True) if kept.kept_name else None

    @property
    def is_done(self) -> bool:
        """Whether A needs no more rendering."""
        slot = self.slot
        return slot is None or (slot.session.is_done and not slot.progress.is_looking)

    def advance(self, seconds: float, count: int) -> bool:
        """Render a frame of A on its turn, and return whether; RenderError without GPU memory."""
        slot = self.slot
        if not slot or self._show.view == "difference":
            return False
        has_turn = slot.has_turn(self._session, self.pairing)
        if has_turn:
            try:
                slot.advance(seconds, count)
            except GlrtError:  # reported once: B continues alone
                self.go_on(False)
                raise
        slot.draw(self._session.settings)
        return has_turn

    def look(self, now: float) -> None:
        """Estimate the error of A if that is due."""
        if self.slot:
            self.slot.progress.follow(self.slot.session, now)

    def go_on(self, wanted: bool) -> None:
        """Let A gather samples together with B, both from the start; or stop that."""
        if self.slot:
            self.slot.release()
            self.slot = None
        if wanted and self._show.kept:
            gl = self._session.context.gl
            self.slot = Slot(self._show.kept.state, self._session, gl)
            self._restart()

    def swap(self) -> None:
        """Edit A, and compare it with the former B; both pictures restart."""
        kept, goes_on = self._show.kept, self.slot is not None
        if not kept:
            return
        before, wanted = self._session.state, kept.state
        self._session.edit(wanted.scene, **dict(wanted.settings))
        kept.take(before)
        self.go_on(goes_on)
