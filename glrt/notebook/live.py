"""A picture that refines, follows the mouse and obeys sliders, without any notebook.

A page asks for each picture when it has drawn the one before. So there is no loop and no thread
here, a slow page gets fewer pictures, and nothing is rendered once the page is closed.
"""

import time
from collections.abc import Callable
from contextlib import suppress
from math import inf
from typing import Any

from glrt.core.errors import GlrtError, UsageError
from glrt.image.image import Image
from glrt.notebook.encoding import encoded
from glrt.notebook.messages import NOTHING, Asked, Reply, asked_of
from glrt.notebook.rows import rows_of
from glrt.notebook.shared_context import HOLD, SHARED, SharedContext
from glrt.rendering.history.temporal import Way
from glrt.rendering.screen.display import Display
from glrt.scene.scene import Scene, with_lights
from glrt.settings import Settings
from glrt.view.edits.edited_state import State
from glrt.view.figure_texts import error_text, forecast, samples_text, unknown_text
from glrt.view.state.error_history import PAUSE, Progress
from glrt.view.state.frame_budget import FrameBudget
from glrt.view.state.idle_kernel import IdleKernel
from glrt.view.state.preferences import Preferences
from glrt.view.state.session import Session
from glrt.view.viewport import orbit

RATES = {True: 12, False: 30}  # pictures a second without a GPU, and with one
MOST_WAITS = 4  # replies that wait for the error of a picture that is done: it may have none
STILL = 0.5  # seconds of a still picture
HABITS = Preferences()


class Live:
    """A scene, its settings and its picture so far; the OpenGL objects can go and come again."""

    def __init__(
        self,
        scene: Scene,
        settings: Settings,
        target: float = HABITS.target_error,
        shared: SharedContext = SHARED,
        clock: Callable[[], float] = time.perf_counter,
        at_rest: Callable[[], IdleKernel | None] = IdleKernel,
    ) -> None:
        """Compile nothing yet; `target` is the relative error of the forecast.

        `at_rest` makes what takes a faster kernel into use while nothing moves, or None.
        """
        self._state, self._first = State(scene, settings), scene.camera
        self._target, self._shared, self._clock, self._at_rest = target, shared, clock, at_rest
        self._session: Session | None = None
        self._display: Display | None = None
        self._content: object = None  # what the last picture was drawn from
        self._asked: float | None = None  # when the page asked last, if it asks on and on
        self._forget()

    @property
    def state(self) -> State:
        """Scene and settings as they are now, with the moved camera and other lights."""
        return self._session.state if self._session else self._state

    def image(self) -> Image:
        """Return the picture so far, with its error; UsageError if it has no sample yet."""
        with self._shared.turn():
            if self._session is None or not self._session.samples:
                raise UsageError("The picture has no sample yet: it gets them while it is shown.")
            return self._session.image()

    def still(self) -> Reply | None:
        """Render for about `STILL` seconds after the kernel is there; return the picture so far.

        The next question of a page gets it, too. None where there is no picture.
        """
        found, end = None, inf
        while self._clock() < end:
            reply = self.answer({})
            if reply.picture:
                found, end = reply, min(end, self._clock() + STILL)
            if reply.content["wait"] != 0:
                break
        self._content = None
        return found

    def rest(self) -> None:
        """Release all OpenGL objects. The next question begins again, from the same view."""
        if self._session is None:
            return  # so that no context is opened for this
        with self._shared.turn():
            if self._session is None:  # another thread was faster
                return
            self._state = self.state
            self._session.release()
            if self._display:
                self._display.release()
            self._session = self._display = None
            self._forget()

    def answer(self, message: Any) -> Reply:
        """Obey the input in a message, render for a frame's time, and return what is new.

        An error becomes a notice, which stays until the next input. While another picture of the
        context follows the mouse, this one waits.
        """
        try:
            asked = asked_of(message)
        except UsageError as error:
            asked, self._problem = NOTHING, str(error)
        if asked != NOTHING:
            self._shared.hold(self, self._clock())
        elif self._session and self._shared.is_held(self, self._clock()):
            self._asked = None
            return Reply({"wait": HOLD})
        try:
            with self._shared.turn():
                session = self._opened()
                picture = self._advance(session, asked)
                return self._reply(session, picture)
        except GlrtError as error:  # no OpenGL, or a scene that the driver cannot render
            return Reply({"notice": str(error), "is_problem": True, "wait": None})

    def _forget(self) -> None:
        self._progress, self._problem = Progress(), ""
        self._content = None
        self._asked = None
        self._rendered, self._waits = 0.0, 0
        self._pivot = self._state.scene.camera.look_at

    def _opened(self) -> Session:
        if self._session is None:
            with self._shared.turn() as context:
                opened = self._state.scene, self._state.settings, context, self._clock
                self._session = Session(*opened, rest=self._at_rest())
                self._display = Display(context.gl)
                self._pace = FrameBudget(RATES[context.is_software])
                self._session.moving.use(Way(HABITS.temporal, HABITS.predictor))
        return self._session

    def _advance(self, session: Session, asked: Asked) -> Any:
        """Render a frame; return its codes, (H, W, 3) uint8, or None for nothing new."""
        now = self._clock()
        if self._asked is not None:
            self._pace.record(now - self._asked, self._rendered)
        if asked != NOTHING:
            session.problem = self._problem = ""
            self._waits = 0
            self._obey(session, asked)
        session.advance(self._pace.seconds)
        self._progress.follow(session, self._clock())
        self._asked, self._rendered = now, self._clock() - now
        return self._drawn(session)

    def _obey(self, session: Session, asked: Asked) -> None:
        scene, camera = session.scene, self._first if asked.home else session.scene.camera
        if asked.home:
            self._pivot = camera.look_at
        with suppress(UsageError):  # a view that cannot be: the camera stays
            if any(asked.turn):
                yaw, pitch = (-HABITS.turn_speed * share for share in asked.turn)
                camera = orbit.orbited(camera, self._pivot, yaw, pitch)
            if asked.wheel:
                camera = orbit.dollied(camera, self._pivot, HABITS.wheel_speed * asked.wheel)
        try:
            lit = with_lights(scene, asked.lights) if asked.lights else scene
        except UsageError as error:
            self._problem, lit = str(error), scene
        if camera is not scene.camera:
            lit = lit.model_copy(update={"camera": camera})
        session.edit(lit, gesture="live", **asked.settings)

    def _drawn(self, session: Session) -> Any:
        renderer = session.renderer
        if not (renderer and self._display and session.is_shown):
            return None
        weights, settings = session.weights, session.settings
        has_history = session.moving.is_shown(renderer, settings.samples)
        progress = renderer.shown, session.restarts, session.moving.progress, session.is_done
        if (content := (*progress, weights, has_history)) == self._content:
            return None
        self._content = content
        light = renderer.weighed(weights)
        return self._display.read(session.moving.texture(renderer, weights) or light, settings)

    def _reply(self, session: Session, codes: Any) -> Reply:
        problem = self._problem or session.problem
        wait = self._wait(session)
        self._asked = self._asked if wait == 0 else None
        content = {
            "size": session.settings.size,
            "figures": self._figures(session),
            "rows": rows_of(session),
            "notice": problem or session.busy,
            "is_problem": bool(problem),
            "wait": wait,
        }
        if codes is None:
            return Reply(content)
        picture, content["type"] = encoded(codes, session.is_done)
        return Reply(content, picture)

    def _figures(self, session: Session) -> list[str]:
        last = self._progress.last
        coarse = ", coarse while it moves" if session.is_preview else ""
        return [
            samples_text(session.samples, session.settings.samples) + coarse,
            f"error {error_text(last) if last else unknown_text(session)}",
            forecast(self._progress, self._target, session.settings.samples),
        ]

    def _wait(self, session: Session) -> float | None:
        """Return seconds until the page is to ask again; None if nothing will be new."""
        if not session.is_done:
            return 0.0
        last, has_error = self._progress.last, session.samples >= session.known_from
        is_known = not has_error or (last is not None and last.samples == session.samples)
        self._waits += 1
        return None if is_known or self._waits > MOST_WAITS else PAUSE
