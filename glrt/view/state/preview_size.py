"""Choose how coarsely a moving camera is rendered, so that the frame rate is kept."""

from collections.abc import Callable

STILL = 0.25  # seconds without a move after which the full size is rendered
COARSEST = 8  # pixels of the frame, in width and height, that share one of a preview
MEMORY = 0.3  # weight of the newest frame in what a sample of a pixel takes


class Preview:
    """Learns what a sample takes, and chooses a size by it when the camera moves."""

    def __init__(self, clock: Callable[[], float]) -> None:
        """Nothing has been measured yet: the full size is shown."""
        self._clock = clock
        self._moved = -STILL
        self._factor = 1
        self._pixel_seconds = 0.0  # for a sample of a pixel

    @property
    def factor(self) -> int:
        """The pixels of the frame, in width and height, that share one: 1 while nothing moves."""
        return self._factor if self._clock() - self._moved < STILL else 1

    def move(self, pixels: int, budget: float) -> None:
        """The camera moved: make a sample of the whole frame fit into `budget` seconds."""
        self._moved, self._factor = self._clock(), 1
        while self._factor < COARSEST and self._pixel_seconds * pixels > budget * self._factor**2:
            self._factor *= 2

    def record(self, seconds: float) -> None:
        """Learn from a frame what a sample of a pixel took."""
        known = self._pixel_seconds or seconds
        self._pixel_seconds = known + MEMORY * (seconds - known)
