"""Render with limits: samples, seconds and error; the first one reached ends the render."""

import math
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from glrt.image.image import Image
from glrt.process.signals import handled
from glrt.rendering.renderer import Renderer
from glrt.settings import MAX_SAMPLES, Settings

FIRST_LOOK = 64  # samples
AHEAD = 1.02  # times the samples of a forecast: its own noise lets few looks come too early


@dataclass(frozen=True)
class Limits:
    """When to stop: `deadline` as a time of `time.perf_counter`, `error` as a fraction.

    The error is checked at `first_look` samples per pixel, and then as `look_after` says.
    """

    samples: int
    deadline: float | None = None
    error: float | None = None
    first_look: int = FIRST_LOOK

    @property
    def is_open(self) -> bool:
        """Whether time or error may end the render before the samples do."""
        return self.deadline is not None or self.error is not None


class Interruption:
    """Remembers SIGINT or SIGTERM, so that the dispatch ends and the picture is saved."""

    def __init__(self) -> None:
        """Begin without a signal."""
        self.signal: int | None = None

    @contextmanager
    def watched(self) -> Iterator["Interruption"]:
        """Catch both signals inside a with statement; a second one ends the process at once."""
        with handled(self._remember):
            yield self

    def _remember(self, number: int, _frame: object) -> None:
        self.signal = number
        signal.signal(number, signal.SIG_DFL)


def render_to_limit(
    renderer: Renderer,
    limits: Limits,
    interruption: Interruption,
    watch: Callable[[Renderer], None] | None = None,
) -> Image | None:
    """Render to the first limit that is reached; None if there is no sample.

    `watch` is called after each dispatch, to show progress. Each pixel gets at least one sample,
    unless an interruption comes first. A frame that is incomplete at the end is left out.
    """

    def goes_on(renderer: Renderer) -> bool:
        if watch:
            watch(renderer)
        late = limits.deadline is not None and time.perf_counter() >= limits.deadline
        return interruption.signal is None and not (late and renderer.samples > begun)

    begun = renderer.samples
    look = first_look(limits, begun)
    while interruption.signal is None and renderer.render(look, goes_on).samples >= look:
        if limits.error is None or look == limits.samples:
            break
        image = renderer.image()
        error = image.error_to_reach
        if error is not None and error <= limits.error:
            return image
        look = look_after(look, error, limits, renderer.settings)
    return renderer.image() if renderer.samples else None


def first_look(limits: Limits, begun: int) -> int:
    """Return the samples per pixel at which to check the error first, or the last ones.

    A picture with `begun` samples goes on to the next of those at which one render might have
    looked: `Limits.first_look` and its doublings.
    """
    look = limits.first_look
    while look < begun:
        look *= 2
    return limits.samples if limits.error is None else min(look, limits.samples)


def look_after(samples: float, error: float | None, limits: Limits, settings: Settings) -> int:
    """Return the samples per pixel at which to look again, after so many with this error.

    The error falls as 1 / sqrt(samples). The next look is at the end of the block in which the
    limit is reached, or at the next doubling if that comes first. Denoised pictures have looks at
    doublings, whose first halves are kept.
    """
    look = 2 * samples
    if error is not None and limits.error and settings.denoise == "none":
        needed = AHEAD * samples * (error / limits.error) ** 2
        look = min(look, settings.block * math.ceil(max(needed, samples + 1) / settings.block))
    return int(min(look, limits.samples))


def samples_limit(given: int | None, default: int, open_ended: bool) -> int:
    """Samples to take: as given; else the scene's, or 2^20 when time or error end the render."""
    return given or (MAX_SAMPLES if open_ended else default)
