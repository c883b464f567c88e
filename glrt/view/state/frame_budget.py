"""Choose how long a frame may render, so that the frame rate is kept."""

LEAST = 0.25  # of a frame's time: however busy the machine, the picture gets on
MEMORY = 0.2  # weight of the newest frame in what the window itself takes


class FrameBudget:
    """Shares the time of a frame between the window and the picture."""

    def __init__(self, frames_per_second: float) -> None:
        """Nothing has been measured yet: the window is taken to need no time."""
        self.frames_per_second = frames_per_second
        self._window = 0.0

    @property
    def seconds(self) -> float:
        """How long the next frame may render."""
        whole = 1 / self.frames_per_second
        return max(LEAST * whole, whole - self._window)

    def record(self, frame: float, rendering: float) -> None:
        """Learn from a frame: how long it took, and how much of that edits and samples took."""
        window = max(0.0, frame - rendering)
        self._window += MEMORY * (min(window, 1.0) - self._window)
