"""Progress of a render on a terminal: samples, seconds, estimated error, forecast."""

import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any, Protocol

from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Limits
from glrt.settings import MAX_SAMPLES

LOOK = 2.0  # seconds between estimates of the error, which read the film back
SHARE = 0.05  # largest share of the time that estimates take


class Watch(Protocol):
    """Function that is called after each dispatch."""

    def __call__(self, renderer: Renderer) -> None: ...


@contextmanager
def progress_bar(limits: Limits, begun: int = 0) -> Iterator[Watch]:
    """Yield the updater of a temporary bar on stderr; `begun`: samples at the start."""
    forecast = Forecast(limits, begun)
    with _bar() as show:
        yield lambda renderer: show(**forecast.after(renderer))


@contextmanager
def film_bar(count: int) -> Iterator["FilmWatch"]:
    """Yield the updater of a temporary bar on stderr for a film of `count` frames."""
    with _bar() as show:
        forecasts = dict[int, Forecast]()  # of the frame that is rendered

        def watch(number: int, done: int, limits: Limits, renderer: Renderer) -> None:
            if number not in forecasts:
                forecasts.clear()
                forecasts[number] = Forecast(limits)
            state = forecasts[number].after(renderer)
            place = f"frame {number} ({done + 1} of {count}), {state['done']}"
            show(**{**state, "completed": (done + state["completed"]) / count, "done": place})

        yield watch


@contextmanager
def _bar() -> Iterator[Callable[..., None]]:
    """Yield a function that updates a temporary bar on stderr by the fields of `Forecast.after`."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    columns = (TextColumn("{task.fields[done]}"), BarColumn(), TextColumn("{task.fields[rest]}"))
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("render", total=1.0, done="compiling", rest="")
        yield partial(bar.update, task)


class FilmWatch(Protocol):
    """Function that is called after each dispatch, with the frame and how many are done."""

    def __call__(self, number: int, done: int, limits: Limits, renderer: Renderer) -> None: ...


class Forecast:
    """Progress and remaining time of a render, by its limits of samples, time and error."""

    def __init__(self, limits: Limits, begun: int = 0) -> None:
        """Start the clock; `begun`: samples that the render starts with."""
        self._limits = limits
        self._begun = begun
        self._start = time.perf_counter()
        self._due = self._start + LOOK
        self._error: float | None = None

    def after(self, renderer: Renderer) -> dict[str, Any]:
        """Return the fields of the bar after a dispatch."""
        start = time.perf_counter()
        is_first = self._error is None and renderer.samples >= 2 * renderer.settings.block
        if is_first or (renderer.samples and start >= self._due):
            self._error = renderer.plain_image().error
            spent = time.perf_counter() - start
            self._due = start + spent + max(LOOK, spent / SHARE)
        seconds = start - self._start
        total = self._total_seconds(renderer.work, seconds)
        error = f"error {100 * self._error:.2g} %  " if self._error else ""
        most = self._limits.samples  # not shown where time or error ends the render
        of_all = f" of {most}" if most < MAX_SAMPLES else ""
        done = f"{renderer.samples}{of_all} samples"
        if total is None:
            rest = f"{error}{seconds:.0f} s, how long is not known yet"
            return {"completed": 0.0, "done": done, "rest": rest}
        share = min(1.0, seconds / total) if total else 1.0
        rest = f"{error}{seconds:.0f} s, {max(0.0, total - seconds):.0f} s to go"
        return {"completed": share, "done": done, "rest": rest}

    def _total_seconds(self, samples: float, seconds: float) -> float | None:
        """Return the seconds to the first limit; None if it is an error that is not known yet."""
        rate = max(samples - self._begun, 1e-9) / seconds
        candidates = []
        if self._limits.samples < MAX_SAMPLES or not self._limits.is_open:
            candidates.append((self._limits.samples - self._begun) / rate)
        if self._limits.deadline is not None:
            candidates.append(self._limits.deadline - self._start)
        if self._limits.error and self._error:
            candidates.append((self._samples_to_error(samples) - self._begun) / rate)
        return min(candidates, default=None)

    def _samples_to_error(self, samples: float) -> float:
        """Return the samples at the look that reaches the error; it falls as 1 / sqrt(samples)."""
        assert self._limits.error
        assert self._error
        needed = samples * math.pow(self._error / self._limits.error, 2)
        first = self._limits.first_look
        doublings = max(0, math.ceil(math.log2(max(needed, 1.0) / first)))
        return float(min(first * 2**doublings, self._limits.samples))
