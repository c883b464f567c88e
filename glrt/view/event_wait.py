"""Wait for events while a new frame would show the same as the screen."""

import time
from collections.abc import Callable

from imgui_bundle import imgui

import glfw  # isort: skip

AWAKE = 1.0  # seconds of frames after an event: tooltips and errors appear late
SLICE = 0.1  # seconds between checks of files, dialogs and signals, which are no events
LONGEST = 5.0  # seconds without a frame, at most


def has_input() -> bool:
    """Whether the next frame has input to handle."""
    return imgui.get_current_context().input_events_queue.size() > 0


class EventWait:
    """Lets frames continue while there is work and AWAKE seconds longer; then waits for events."""

    def __init__(
        self,
        pause: Callable[[float], None] = glfw.wait_events_timeout,
        has_input: Callable[[], bool] = has_input,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """`pause` waits for an event, at most for the given seconds."""
        self._pause, self._has_input, self._clock = pause, has_input, clock
        self._awake = 0.0  # time until which frames continue

    def wait(self, is_quiet: Callable[[], bool]) -> float:
        """Wait before a frame for events or work, LONGEST at most; returns the seconds waited."""
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
