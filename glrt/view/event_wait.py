"""Wait for events where a frame would show what is on the screen already."""

import time
from collections.abc import Callable

from imgui_bundle import imgui

import glfw  # isort: skip

AWAKE = 1.0  # seconds after an event in which frames go on: tooltips come late, and errors
SLICE = 0.1  # seconds between looks at files, dialogs and signals, which are no events
LONGEST = 5.0  # seconds without a frame


def has_input() -> bool:
    """Whether there is input that the next frame will see."""
    return imgui.get_current_context().input_events_queue.size() > 0


class EventWait:
    """Frames go on while there is something to do, and a moment longer; then events begin them."""

    def __init__(
        self,
        pause: Callable[[float], None] = glfw.wait_events_timeout,
        has_input: Callable[[], bool] = has_input,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """`pause` waits for an event, so many seconds at most."""
        self._pause, self._has_input, self._clock = pause, has_input, clock
        self._awake = 0.0  # until when

    def wait(self, is_quiet: Callable[[], bool]) -> float:
        """Before a frame: until there is an event, or no quiet. Returns the seconds it took."""
        began = now = self._clock()
        while now - began < LONGEST and self._is_asleep(is_quiet, now):
            self._pause(SLICE)
            before, now = now, self._clock()
            if now - before < SLICE / 2:  # an event, of the mouse or of the window
                self._awake = now + AWAKE
        return now - began

    def _is_asleep(self, is_quiet: Callable[[], bool], now: float) -> bool:
        if self._has_input() or not is_quiet():
            self._awake = now + AWAKE
        return now >= self._awake
