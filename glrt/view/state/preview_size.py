"""Choose how coarsely the picture follows edits in a row, so that the frame rate is kept."""

from collections.abc import Callable

STILL = 0.25  # seconds without an edit after which the full size is rendered
COARSEST = 8  # pixels of the frame, in width and height, that share one of a preview
MEMORY = 0.3  # weight of the newest frame in what a sample of a pixel takes


class Preview:
    """Learns what a sample takes, and chooses a size by it when an edit begins the picture anew.

    A picture that an edit has begun is owed to the screen: it is not given up for a later edit
    before it has a sample, however slow the machine, unless a coarser one is called for.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        """Nothing has been measured yet: the full size is shown."""
        self._clock = clock
        self._edited = -STILL
        self._factor = 1
        self._pixel_seconds = 0.0  # for a sample of a pixel
        self._uncounted = 0.0  # seconds of frames that brought no sample, as those of AOVs
        self._is_owed = False

    @property
    def factor(self) -> int:
        """The pixels of the frame, in width and height, that share one: 1 while nothing changes."""
        return self._factor if self.is_under_way else 1

    @property
    def is_under_way(self) -> bool:
        """Whether edits come in a row, or the picture of the last one has no sample yet."""
        return self._is_owed or self._clock() - self._edited < STILL

    def goes_on(self, pixels: int, budget: float) -> bool:
        """Whether the picture of the edit before is to get a sample before another one begins."""
        return self._is_owed and self._fitting(pixels, budget) <= self._factor

    def begin(self, pixels: int, budget: float) -> None:
        """An edit begins a picture: make a sample of the whole frame fit into `budget` seconds."""
        self._edited, self._is_owed = self._clock(), True
        self._factor = self._fitting(pixels, budget)

    def record(self, seconds: float, samples: float) -> None:
        """Learn from a frame what a sample of a pixel took; one without any counts to the next."""
        self._uncounted += seconds
        if samples > 0:
            newest, self._uncounted = self._uncounted / samples, 0.0
            known = self._pixel_seconds or newest
            self._pixel_seconds = known + MEMORY * (newest - known)

    def deliver(self) -> None:
        """The picture has a sample."""
        self._is_owed = False

    def end(self) -> None:
        """The full size is wanted at once."""
        self._is_owed, self._factor = False, 1

    def _fitting(self, pixels: int, budget: float) -> int:
        factor = 1
        while factor < COARSEST and self._pixel_seconds * pixels > budget * factor**2:
            factor *= 2
        return factor
