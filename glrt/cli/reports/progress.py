"""Progress of a render, on a terminal or as lines: samples, seconds, error, forecast."""

import json
import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any, NamedTuple, Protocol

from glrt.core.text import counted
from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Limits
from glrt.settings import MAX_SAMPLES

LOOK = 2.0  # seconds between estimates of the error, which read the film back
SHARE = 0.05  # largest share of the time that estimates take
BETWEEN = 0.5  # seconds between two lines


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
def progress_lines(limits: Limits, begun: int = 0) -> Iterator[Watch]:
    """Yield a function that prints progress as lines of JSON; `begun`: samples at the start.

    It raises BrokenPipeError where nobody reads them any more.
    """
    forecast, lines = Forecast(limits, begun), _Lines()

    def watch(renderer: Renderer) -> None:
        if lines.is_due():
            state = forecast.state(renderer)
            lines.put(state.share, state.left, samples=state.samples, error=state.error)

    yield watch


@contextmanager
def film_lines(count: int) -> Iterator["FilmWatch"]:
    """Yield a function that prints progress of a film of `count` frames as lines of JSON."""
    lines, forecasts = _Lines(), dict[int, Forecast]()
    first: tuple[float, float] | None = None  # share and time of the first line

    def watch(number: int, done: int, limits: Limits, renderer: Renderer) -> None:
        nonlocal first
        if number not in forecasts:
            forecasts.clear()
            forecasts[number] = Forecast(limits)
        if not lines.is_due():
            return
        share, now = (done + forecasts[number].state(renderer).share) / count, time.perf_counter()
        first = first or (share, now)  # frames that were kept took no time
        gained, spent = share - first[0], now - first[1]
        left = spent * (1 - share) / gained if gained > 0 else None
        lines.put(share, left, frame=number, frames=count, done=done)

    yield watch


@contextmanager
def progress_of_all(unit: str, as_lines: bool) -> Iterator[Callable[[int, int, int], None]]:
    """Yield a function of tasks done, tasks in all, and workers, which shows how far all are.

    It prints lines of JSON, or updates a bar on stderr that names tasks by their `unit`.
    """
    start, lines = time.perf_counter(), _Lines()

    def left(done: int, count: int) -> float | None:
        return (time.perf_counter() - start) * (count - done) / done if done else None

    def line(done: int, count: int, workers: int) -> None:
        if lines.is_due():
            own = {f"{unit}s": count, "done": done, "workers": workers}
            lines.put(done / count, left(done, count), **own)

    if as_lines:
        yield line
        return
    with _bar() as show:

        def bar(done: int, count: int, workers: int) -> None:
            seconds = left(done, count)
            place = f"{done} of {counted(count, unit)}, {counted(workers, 'worker')}"
            rest = "how long is not known yet" if seconds is None else f"{seconds:.0f} s to go"
            show(completed=done / count, done=place, rest=rest)

        yield bar


class _Lines:
    """Lines of JSON on standard output, BETWEEN seconds apart."""

    def __init__(self) -> None:
        self._due = 0.0

    def is_due(self) -> bool:
        return time.perf_counter() >= self._due

    def put(self, share: float, left: float | None, **figures: Any) -> None:
        """Print a share of the work that is done, seconds to go if they are known, and figures."""
        self._due = time.perf_counter() + BETWEEN
        seconds = None if left is None else round(left, 1)
        line = {"progress": round(share, 4), "seconds_left": seconds, **figures}
        print(json.dumps(line), flush=True)


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


class State(NamedTuple):
    """How far a render is."""

    samples: int  # of a pixel
    share: float  # of the work that is done; 0 while that is unknown
    seconds: float  # since the start
    left: float | None  # seconds to the first limit; None while that is unknown
    error: float | None  # estimate; None while it is unknown


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
        state = self.state(renderer)
        error = f"error {100 * state.error:.2g} %  " if state.error else ""
        most = self._limits.samples  # not shown where time or error ends the render
        of_all = f" of {most}" if most < MAX_SAMPLES else ""
        unknown = "how long is not known yet"
        to_go = unknown if state.left is None else f"{state.left:.0f} s to go"
        rest = f"{error}{state.seconds:.0f} s, {to_go}"
        done = f"{state.samples}{of_all} samples"
        return {"completed": state.share, "done": done, "rest": rest}

    def state(self, renderer: Renderer) -> State:
        """Return the progress after a dispatch; from time to time that estimates the error."""
        start = time.perf_counter()
        is_first = (
            self._error is None and renderer.samples >= renderer.settings.division.least_known
        )
        if is_first or (renderer.samples and start >= self._due):
            self._error = renderer.plain_image().error
            spent = time.perf_counter() - start
            self._due = start + spent + max(LOOK, spent / SHARE)
        seconds = start - self._start
        total = self._total_seconds(renderer.work, seconds)
        if total is None:
            return State(renderer.samples, 0.0, seconds, None, self._error)
        share = min(1.0, seconds / total) if total else 1.0
        return State(renderer.samples, share, seconds, max(0.0, total - seconds), self._error)

    def _total_seconds(self, samples: float, seconds: float) -> float | None:
        """Return the seconds to the first limit; None if it is an error that is not known yet."""
        rate = max(samples - self._begun, 1e-9) / max(seconds, 1e-9)
        candidates = []
        if self._limits.samples < MAX_SAMPLES or not self._limits.is_open:
            candidates.append((self._limits.samples - self._begun) / rate)
        if self._limits.deadline is not None:
            candidates.append(self._limits.deadline - self._start)
        if self._limits.error and self._error:
            candidates.append((self._samples_to_error(samples) - self._begun) / rate)
        return min(candidates, default=None)

    def _samples_to_error(self, samples: float) -> float:
        """Return the samples that reach the error; it falls as 1 / sqrt(samples)."""
        assert self._limits.error
        assert self._error
        needed = samples * math.pow(self._error / self._limits.error, 2)
        return float(min(max(needed, self._limits.first_look), self._limits.samples))
