"""Report of `glrt film`: progress, a line for each frame, and the film."""

import argparse
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np

from glrt.cli.options import settings_given
from glrt.cli.reports.progress import film_bar, film_lines
from glrt.cli.reports.warnings import warn
from glrt.core.text import counted
from glrt.process.command import file_names, print_figures
from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Limits
from glrt.scene.frames import with_values
from glrt.series.film import Film
from glrt.series.rendering import Frame, Watch
from glrt.series.sweeps import is_setting

MOST_NAMED = 10
_KEPT = "each frame has a file of its own, which stays"


class Reporter:
    """Prints how a film comes along: JSON on stdout, or prose on stderr."""

    def __init__(self, arguments: argparse.Namespace, film: Film) -> None:
        """Start the clock."""
        self._arguments = arguments
        self._film = film
        self._start = time.perf_counter()

    @contextmanager
    def watching(self) -> Iterator[Watch | None]:
        """Yield a function to call after each dispatch, which shows progress where it is seen."""
        is_told, is_quiet = self._arguments.progress, self._arguments.quiet
        if not is_told and (is_quiet or not sys.stderr.isatty()):
            yield None
            return
        film, shown = self._film, film_lines if is_told else film_bar
        with shown(len(film.numbers)) as show:

            def watch(number: int, limits: Limits, renderer: Renderer) -> None:
                show(number, len(film.frames), limits, renderer)

            yield watch

    def report(self, frame: Frame) -> None:
        """Print what became of a frame."""
        if frame.failure:
            print(f"glrt: frame {frame.number} failed: {frame.failure}", file=sys.stderr)
        if self._arguments.json:
            print_figures(_figures(frame), [str(frame.file)])
        elif frame.samples and not self._arguments.quiet:
            print(self._line(frame), file=sys.stderr)

    def _line(self, frame: Frame) -> str:
        film = self._film
        error = "" if frame.error is None else f", error {100 * frame.error:.2g} %"
        place = f"{len(film.frames)} of {len(film.numbers)}"
        work = f"{counted(frame.samples, 'sample')} in {frame.seconds:.1f} s"
        return f"Frame {frame.number} ({place}, {frame.label}): {work}{error}{self._to_go()}."

    def _to_go(self) -> str:
        left = len(self._film.numbers) - len(self._film.frames)
        times = [frame.seconds for frame in self._film.frames if frame.samples]
        each = float(np.median(times))
        if self._arguments.cluster:  # workers render several at once
            each = (time.perf_counter() - self._start) / len(times)
        return f"; {left * each:.0f} s to go" if left else ""

    def summarize(self) -> None:
        """Print the figures of the film, and a caution about frames that are black."""
        film, new = self._film, sum(frame.samples > 0 for frame in self._film.frames)
        name, count = str(film.output.path), len(film.frames)
        width, height = film.series.settings.size
        seconds = time.perf_counter() - self._start
        if self._arguments.json:
            figures = {"film": name, "frames": count, "rendered": new, "fps": film.fps}
            size = {"width": width, "height": height}
            print_figures({**figures, **size, "seconds": round(seconds, 6)}, [name])
        elif not self._arguments.quiet:
            print(
                f"Wrote {file_names([name])}: {counted(count, 'frame')} of {width} x {height}, "
                f"{new or 'none'} of them rendered now, in {seconds:.1f} s.",
                file=sys.stderr,
            )
        if black := [frame for frame in film.frames if frame.is_black]:
            text = f"{named(black)}: all is black. Does a wall stand before the camera?"
            print(f"glrt: caution: {text}", file=sys.stderr)


def warn_of(arguments: argparse.Namespace, film: Film) -> None:
    """Print the cautions of a series and of its first frame."""
    series = film.series
    scene, settings, *_ = series.still(0)
    idle = [
        f"{option} has no effect here: {why}."
        for option, is_idle, why in (
            ("--fps", film.own_fps and film.output.kind != "container", "no film is written"),
            ("--keep-frames", arguments.keep_frames and film.output.kind == "frames", _KEPT),
            ("--chunk", arguments.chunk != 1, "no --export divides the frames into tasks"),
        )
        if is_idle
    ]
    for text in filter(None, [*idle, series.idle_shutter]):
        print(f"glrt: caution: {text}", file=sys.stderr)
    if series.idle_shutter:
        scene = with_values(scene, {("camera", "shutter"): 0.0}, "")
    given = {
        *settings_given(arguments),
        *(it.keys[-1] for it in series.sweeps if is_setting(it.keys)),
    }
    warn(scene, settings, given, arguments.quiet)


def named(frames: Sequence[Frame]) -> str:
    """Return the numbers of frames for a message, at most MOST_NAMED of them."""
    some = ", ".join(str(frame.number) for frame in frames[:MOST_NAMED])
    rest = f" and {len(frames) - MOST_NAMED} more" if len(frames) > MOST_NAMED else ""
    return f"{'frame' if len(frames) == 1 else 'frames'} {some}{rest}"


def _figures(frame: Frame) -> dict[str, Any]:
    return {
        "frame": frame.number,
        "file": str(frame.file),
        "label": frame.label,
        "kept": bool(frame.record and not frame.samples),
        "failure": frame.failure or None,
        "reached": None if frame.record is None else frame.record.reached,
        "samples": frame.samples or None,
        "error": frame.error,
        "seconds": round(frame.seconds, 6),
    }
