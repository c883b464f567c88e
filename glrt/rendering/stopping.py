"""Render with limits: samples, seconds and error; the first one reached ends the render."""

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from glrt.image.image import Image
from glrt.process.signals import handled
from glrt.rendering.renderer import Renderer
from glrt.settings import MAX_SAMPLES

FIRST_LOOK = 64  # samples


@dataclass(frozen=True)
class Limits:
    """When to stop: `deadline` as a time of `time.perf_counter`, `error` as a fraction.

    The error is checked at `first_look` samples per pixel and at each doubling.
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
    for look in _looks(limits):
        if interruption.signal is not None:
            break
        if look < begun:
            continue
        renderer.render(look, goes_on)
        if renderer.samples < look:
            break
        if limits.error is not None:
            image = renderer.image()
            if _is_reached(image.error_to_reach, limits.error):
                return image
    return renderer.image() if renderer.samples else None


def _looks(limits: Limits) -> Iterator[int]:
    """The sample counts at which to check the error, and the last one."""
    look = limits.first_look
    while limits.error is not None and look < limits.samples:
        yield look
        look *= 2
    yield limits.samples


def _is_reached(error: float | None, wanted: float) -> bool:
    return error is not None and error <= wanted


def samples_limit(given: int | None, default: int, open_ended: bool) -> int:
    """Samples to take: as given; else the scene's, or 2^20 when time or error end the render."""
    return given or (MAX_SAMPLES if open_ended else default)
