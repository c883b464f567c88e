"""A render with limits: samples, seconds and error; the first one reached ends it."""

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import NamedTuple

from glrt.error.reliability import error_ratio
from glrt.image.image import Image, Pixels
from glrt.rendering.renderer import Renderer
from glrt.settings import MAX_SAMPLES
from glrt.signals import handled

FIRST_LOOK = 64  # samples


@dataclass(frozen=True)
class Limits:
    """When to stop: `deadline` as a time of `time.perf_counter`, `error` as a fraction.

    The error is judged at `first_look` samples and at each doubling.
    """

    samples: int
    deadline: float | None = None
    error: float | None = None
    first_look: int = FIRST_LOOK

    @property
    def is_open(self) -> bool:
        """Whether time or error may end the render before the samples do."""
        return self.deadline is not None or self.error is not None


class Ending(NamedTuple):
    """The picture at the end of a render, and what else is known of its error."""

    image: Image | None  # None if there is no sample
    # The error seen between two parts of the samples over the estimate (glrt/error/reliability.py),
    # where the error that was asked for was judged reached.
    error_ratio: float | None = None


class Interruption:
    """Remembers SIGINT or SIGTERM, so that a dispatch ends and the picture is saved."""

    def __init__(self) -> None:
        """Nothing has happened yet."""
        self.signal: int | None = None

    @contextmanager
    def watched(self) -> Iterator["Interruption"]:
        """Catch the two signals inside; a second one ends the process at once."""
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
) -> Ending:
    """Render to the first limit.

    `watch` is called after each dispatch, to show progress. Each pixel gets a sample at least,
    unless the interruption comes before; a frame that is not complete at the end is left out.
    """

    def goes_on(renderer: Renderer) -> bool:
        if watch:
            watch(renderer)
        late = limits.deadline is not None and time.perf_counter() >= limits.deadline
        return interruption.signal is None and not (late and renderer.samples > begun)

    part: tuple[Pixels, int] | None = None
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
            is_judged = look >= limits.first_look or look == limits.samples
            if is_judged and _is_reached(image.error, limits.error):
                return Ending(image, _error_ratio(part, image))
            part = image.radiance, image.samples
    return Ending(renderer.image() if renderer.samples else None)


def _error_ratio(part: tuple[Pixels, int] | None, image: Image) -> float | None:
    if part is None:
        return None
    return error_ratio(*part, image.radiance, image.samples, image.error)


def _looks(limits: Limits) -> Iterator[int]:
    """The sample counts at which to look at the error, one before the first, and the last one."""
    look = max(limits.first_look // 2, 1)
    while limits.error is not None and look < limits.samples:
        yield look
        look *= 2
    yield limits.samples


def _is_reached(error: float | None, wanted: float) -> bool:
    return error is not None and error <= wanted


def samples_limit(given: int | None, default: int, open_ended: bool) -> int:
    """Samples to take: as given; else the scene's, or 2^20 when time or error end the render."""
    return given or (MAX_SAMPLES if open_ended else default)
