"""The picture on the screen while the camera moves: see glrt/rendering/history/temporal.py."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import moderngl

from glrt.core.errors import RenderError
from glrt.plan.plan import Weights
from glrt.rendering.history.temporal import END, Mode, Temporal, Way
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.false_colors import Number, Told
from glrt.settings import Cost, Settings, settings_for
from glrt.view.edits.edited_state import State

OWN_NUMBERS: dict[Number, Mode] = {"weight": "wrls", "mask": "ataa"}
MOST_SEED = 0xFFFFFFFF
GOLDEN = 0x9E3779B1  # from one seed to the next: far from those that users choose


class MovingPicture:
    """History of a session's picture. Where the driver has no room for it, there is none."""

    def __init__(self, gl: moderngl.Context, mode: Mode = "reset") -> None:
        """Nothing is compiled or allocated before it is needed."""
        self._gl = gl
        self._wanted = Way(mode)
        self._temporal = Temporal(gl, self._wanted)
        self._begun = 0

    def begin(self) -> None:
        """Another picture begins while edits come in a row."""
        self._begun += 1

    def reseeded(self, state: State) -> State:
        """With random numbers that no view before had: noise that is the same does not cancel.

        Once edits rest the picture begins anew, with its own seed and the bits of `reset`.
        """
        seed = self._other_seed(state.settings.seed)
        return replace(state, settings=settings_for(state.settings, seed=seed))

    def alike(self, wanted: State, given: Settings, seed: int) -> State:
        """What is wanted, in the size of a renderer, and with its seed if it comes from `seed`."""
        sized = wanted.sized(*given.size)
        if given.seed not in (seed, self._other_seed(seed)):
            return sized
        return replace(sized, settings=settings_for(sized.settings, seed=given.seed))

    def _other_seed(self, seed: int) -> int:
        is_needed = self._wanted.mode != "reset"
        return (seed + self._begun * GOLDEN) & MOST_SEED if is_needed else seed

    def use(self, way: Way) -> None:
        """Another way begins without history."""
        if way != self._wanted:
            self._temporal.release()
            self._temporal, self._wanted = Temporal(self._gl, way), way

    def leave(self, renderer: Renderer, weights: Weights) -> str:
        """Before an edit; returns what the driver refused, "" for nothing."""
        try:
            self._temporal.leave(renderer, weights)
        except RenderError as error:
            return self._left_out(error)
        return ""

    def prepare(self, renderer: Renderer, weights: Weights) -> str:
        """While nothing moves, so that no edit waits for it; returns what the driver refused."""
        try:
            self._temporal.prepare(renderer, weights)
        except RenderError as error:
            return self._left_out(error)
        return ""

    def arrive(self, renderer: Renderer, cost: Cost | None) -> str:
        """After an edit of a cost; returns what the driver refused, "" for nothing."""
        if cost is Cost.RELIGHT:
            self._temporal.forget()
        if cost not in (Cost.RESTART, Cost.RECOMPILE):
            return ""
        try:
            self._temporal.arrive(renderer)
        except RenderError as error:
            return self._left_out(error)
        return ""

    def _left_out(self, error: RenderError) -> str:
        self._temporal.release()
        self._temporal = Temporal(self._gl, Way("reset"))
        return f"{error} History of earlier views is left out (temporal reset)."

    def forget(self) -> None:
        """The picture is shown without history from now on."""
        self._temporal.forget()

    def is_shown(self, renderer: Renderer | None, wanted: int) -> bool:
        """Whether history is shown: not once the film has END samples, or all that are wanted."""
        self._temporal.end = float(min(END, wanted))
        return renderer is not None and self._temporal.is_shown(renderer)

    def reports(self, renderer: Renderer | None, wanted: int, number: Number) -> bool:
        """Whether there is a number of the history that is shown."""
        is_one = number == "history" or self._wanted.mode == OWN_NUMBERS[number]
        return is_one and self.is_shown(renderer, wanted)

    def told(self, renderer: Renderer, weights: Weights, number: Number) -> Told | None:
        """That number, valid until the next call; RenderError as `texture`."""
        with self._left_out_if_refused():
            return self._temporal.told(renderer, number, weights)

    @property
    def end(self) -> int:
        """The samples of the film from which on it is shown alone."""
        return int(self._temporal.end)

    def texture(self, renderer: Renderer, weights: Weights) -> moderngl.Texture | None:
        """Film and history, valid until the next call; None: the film alone is to be shown.

        RenderError if the driver has no room: from then on there is no history.
        """
        with self._left_out_if_refused():
            return self._temporal.show(renderer, weights)

    @contextmanager
    def _left_out_if_refused(self) -> Iterator[None]:
        try:
            yield
        except RenderError as error:
            raise RenderError(self._left_out(error)) from error

    def release(self) -> None:
        """Free what the driver holds."""
        self._temporal.release()
