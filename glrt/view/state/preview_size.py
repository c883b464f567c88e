"""Choose how coarse the picture is during consecutive edits, so that the frame rate is kept."""

from collections.abc import Callable

from glrt.rendering.renderer import Renderer

STILL = 0.25  # seconds without an edit after which the full size is rendered
FACTORS = tuple(2 ** (n / 4) for n in range(13))  # sizes of previews, from the whole one on
COARSEST = round(FACTORS[-1])  # pixels of the frame per pixel of the preview, in width and height
FINER = (
    0.8  # of a frame's time: a finer picture is to fit into that, so that sizes do not alternate
)
MEMORY = 0.3  # weight of the newest frame in what is learnt
LEAST = 0.25  # of a frame's time for samples, however long edits take
OVERRUN = 2.0  # of a frame's time to the first sample: a frame that brings none shows nothing new
FIRST_SAMPLES = 8  # of a picture, as a moving camera shows them: later ones take less time each


class Preview:
    """Learns the time of a sample, and chooses a size by it when an edit restarts the picture.

    The picture of an edit is owed to the screen: however slow the machine, a later edit does not
    replace it before it has a sample, unless a coarser picture is needed.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        """Begin with the full size, as nothing has been measured yet."""
        self._clock = clock
        self._edited = -STILL
        self._factor = 1.0
        self._edit_seconds = 0.0  # for bringing an edit to the renderer
        self._making_seconds = 0.0  # for the picture that is made of the samples, whatever its size
        self._pixel_seconds = 0.0  # for a sample of a pixel
        self._uncounted = 0.0  # seconds of frames without a sample, as those of AOVs
        self._is_owed = False

    @property
    def factor(self) -> float:
        """Pixels of the frame per preview pixel, in width and height: 1 while nothing changes."""
        return self._factor if self.is_under_way else 1.0

    @property
    def is_under_way(self) -> bool:
        """Whether edits follow one another, or the picture of the last one has no sample yet."""
        return self._is_owed or self._clock() - self._edited < STILL

    def goes_on(self, pixels: int, budget: float) -> bool:
        """Whether the picture of the last edit is to get a sample before another one begins."""
        return self._is_owed and self._fitting(pixels, budget) <= self._factor

    def begin(self, pixels: int, budget: float) -> None:
        """Begin the picture of an edit, at a size whose first sample fits into `budget` seconds."""
        self._edited, self._is_owed = self._clock(), True
        self._factor = self._fitting(pixels, budget)

    def edited(self, seconds: float) -> None:
        """Learn the seconds in which an edit reached the renderer, without compilations."""
        self._edit_seconds += MEMORY * (seconds - self._edit_seconds)

    def expect(self, seconds: float) -> None:
        """Learn before the first edit that it takes about `seconds` to reach the renderer."""
        self._edit_seconds = self._edit_seconds or seconds

    def reconstructed(self, seconds: float) -> None:
        """Learn the seconds in which a full picture was made of samples of some pixels."""
        self._making_seconds += MEMORY * (seconds - self._making_seconds)

    def record(self, seconds: float, samples: float) -> None:
        """Learn the seconds of a sample of a pixel; a frame without samples adds to the next."""
        self._uncounted += seconds
        if samples > 0:
            newest, self._uncounted = self._uncounted / samples, 0.0
            known = self._pixel_seconds or newest
            self._pixel_seconds = known + MEMORY * (newest - known)

    def deliver(self) -> None:
        """Note that the picture has a sample on the screen."""
        self._is_owed = False

    def end(self) -> None:
        """Return to the full size at once."""
        self._is_owed, self._factor = False, 1.0

    def work(self, renderer: Renderer, target: int, seconds: float, edit: float) -> None:
        """Render up to `target` samples in a frame of `seconds`; an edit took `edit` seconds of it.

        The first sample may take longer, and AOVs follow it at once.
        """
        start, before, held = self._clock(), renderer.work, renderer.samples
        self._making_seconds = 0.0
        left = max(seconds - edit, LEAST * seconds)
        if self.is_under_way and not held:
            renderer.advance(max(OVERRUN * seconds - edit, LEAST * seconds), min(target, 1))
            left -= self._clock() - start
        if left > 0.0:
            renderer.advance(left, target)
        if held < FIRST_SAMPLES and (self.factor > 1 or not renderer.is_baked):
            width, height = renderer.size
            self.record(self._clock() - start, (renderer.work - before) * width * height)

    def seconds_of(self, samples: float) -> float:
        """Return the seconds that so many samples of a pixel take, as far as is known."""
        return self._pixel_seconds * samples

    def _fitting(self, pixels: int, budget: float) -> float:
        left = max(budget - self._edit_seconds - self._making_seconds, LEAST * budget)
        fitting = (factor for factor in FACTORS if self._takes(pixels, factor) <= left)
        return next(fitting, FACTORS[-1])

    def _takes(self, pixels: int, factor: float) -> float:
        """Return the seconds for a sample at a factor; with a margin if it is finer than now."""
        margin = 1.0 / FINER if factor < self._factor else 1.0
        return margin * self._pixel_seconds * pixels / factor**2
