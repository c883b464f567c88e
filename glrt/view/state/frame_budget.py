"""Choose how long a frame may render, so that the frame rate is kept."""

LEAST = 0.25  # of a frame's time for the picture, however busy the machine
MEMORY = 0.2  # weight of the newest frame in the time that the window itself takes


class FrameBudget:
    """Divides the time of a frame between the window and the picture."""

    def __init__(self, frames_per_second: float) -> None:
        """Assume that the window needs no time, until it is measured."""
        self.frames_per_second = frames_per_second
        self._window = 0.0

    @property
    def seconds(self) -> float:
        """Seconds that the next frame may render."""
        whole = 1 / self.frames_per_second
        return max(LEAST * whole, whole - self._window)

    def record(self, frame: float, rendering: float) -> None:
        """Learn from a frame: its seconds, and those of its edits and samples."""
        window = max(0.0, frame - rendering)
        self._window += MEMORY * (min(window, 1.0) - self._window)
