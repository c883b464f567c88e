"""A hand on the window: it clicks, drags and types as a user does, by the test engine.

The engine runs a check on a thread of its own, in turns with the window's frames. OpenGL belongs to
the window's thread: `Hand.there` runs something on that.
"""

import math
import time
from collections.abc import Callable
from typing import Any, TypeVar

import moderngl
import numpy as np
from imgui_bundle import imgui
from numpy.typing import NDArray

from glrt.view.controls import replaced
from glrt.view.panels.navigation import navigate
from glrt.view.state.preferences import Preferences, Tab
from glrt.view.state.session import Session
from glrt.view.state.zoom import FIT
from glrt.view.viewport.picture import Picture
from glrt.view.widgets.steady_widget import ANCHOR
from glrt.view.window import Window
from tests.window.tabbed import TabbedContext

Result = TypeVar("Result")
Check = Callable[["Hand"], None]

CHECKS: dict[str, Check] = {}
WAIT = 120.0  # seconds for what ends by itself, on a machine that has more to do
DRAWN = 8  # one frame of so many is drawn: pixels take most of a frame's time
SMALL: dict[str, Any] = {"width": 40, "height": 40, "samples": 1 << 16}


def check(function: Check) -> Check:
    """Register a check; each begins with the window as it was opened."""
    CHECKS[function.__name__] = function
    return function


class Hand:
    """The actions of a check on the window, and its view of it."""

    def __init__(self, window: Window) -> None:
        self.window = window
        self.ctx: Any  # of the engine
        self._preferences = Preferences(samples_per_frame=2, tour=False)
        self._errands: list[Callable[[], None]] = []
        self._wanted: list[list[NDArray[np.uint8]]] = []  # where pictures of the window go
        self._is_drawn = True
        callbacks = window.params.callbacks
        before = callbacks.pre_new_frame

        def run_errands() -> None:
            while self._errands:
                self._errands.pop(0)()
            before()

        callbacks.pre_new_frame = run_errands
        callbacks.before_imgui_render = self._draw
        callbacks.after_swap = self._shoot

    @property
    def session(self) -> Session:
        return self.window.app.session

    def hold(self, ctx: imgui.test_engine.TestContext) -> None:
        """Take the engine's context."""
        self.ctx = TabbedContext(ctx, self.turn_to, lambda: self.window.app.preferences.tab)

    def turn_to(self, tab: Tab) -> None:
        """Show a tab of the panel."""
        app = self.window.app
        self.there(lambda: app.prefer(replaced(app.preferences, tab=tab)))
        self.ctx.yield_(3)

    def there(self, errand: Callable[[], Result]) -> Result:
        """The result of a function that runs on the window's thread, between two frames."""
        results: list[Result] = []
        self._errands.append(lambda: results.append(errand()))
        self.until(lambda: bool(results))
        return results[0]

    def until(self, condition: Callable[[], bool], frames: int = 0) -> None:
        """Let frames pass until the condition holds: so many at most, or as many as take WAIT."""
        deadline, seen = time.monotonic() + WAIT, 0
        while not condition():
            problem = f"problem: {self.session.problem!r}"
            assert not frames or seen < frames, f"not within {frames} frames; {problem}"
            assert frames or time.monotonic() < deadline, f"not within {WAIT} s; {problem}"
            self.ctx.yield_()
            seen += 1

    def settle(self) -> None:
        """Let the window take in all edits, and get samples."""
        self.ctx.yield_(2)
        session = self.session
        self.until(lambda: not session.busy and session.samples > 0 and not session.is_preview)
        self.ctx.yield_()

    def begin(self) -> None:
        """The window as it was opened."""

        def reset() -> None:
            app = self.window.app
            self.session.paused, self.session.problem = False, ""
            self.session.by_length = False
            self.session.rest = None  # no other process, but where a check wants it
            app.preferences = replaced(self._preferences, temporal="reset")  # the film alone
            self.session.edit(self.session.opened.scene, **dict(self.session.opened.settings))
            app.files._mark_saved(self.session.scene)
            app.files.dialogs.close()
            app.messages.question, app.messages.told = None, -math.inf
            app.paths.forget()
            app.paths.with_particles = False
            app.pivot, app.selected = app.camera.look_at, None
            app.zoom, app.inspects = FIT, False
            navigate(app, False)
            ANCHOR.forget()
            app.pair.go_on(False)
            app.pair.is_beside, app.pair.pairing = False, "equal time"
            app.show.forget()
            app.show.view, app.show.wipe = "picture", 0.5

        self.there(reset)
        self.settle()

    def pixels(self) -> NDArray[np.uint8]:
        """The picture as the window shows it, (H, W, 4), row 0 on top."""
        return self.there(lambda: _read(self.window.app.picture))

    def screen(self) -> NDArray[np.uint8]:
        """The window as it is drawn next, (H, W, 3), row 0 on top."""
        shots: list[NDArray[np.uint8]] = []
        self._wanted.append(shots)
        self.until(lambda: bool(shots))
        return shots[0]

    def _draw(self) -> None:
        """Spare most frames their pixels; the session draws before, and is not touched."""
        self._is_drawn = bool(self._wanted) or imgui.get_frame_count() % DRAWN == 0
        if not self._is_drawn:
            self._gl.enable(moderngl.RASTERIZER_DISCARD)

    def _shoot(self) -> None:
        self._gl.disable(moderngl.RASTERIZER_DISCARD)
        while self._is_drawn and self._wanted:
            width, height = self._gl.screen.size
            codes = np.frombuffer(self._gl.screen.read(components=3, alignment=1), np.uint8)
            self._wanted.pop().append(codes.reshape(height, width, 3)[::-1].copy())

    @property
    def _gl(self) -> moderngl.Context:
        return self.session.context.gl


def _read(picture: Picture) -> NDArray[np.uint8]:
    assert picture._texture
    width, height = picture.size
    codes = np.frombuffer(picture._texture.read(), np.uint8)
    return codes.reshape(height, width, 4)[::-1].copy()
