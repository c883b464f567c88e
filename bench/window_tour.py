"""The window, driven by a script: `python -m bench.window_tour drag`, `rest`, `idle`.

`drag` measures frame times while the camera turns, `rest` while nothing is edited, `idle` what a
complete picture takes of the processor. Without a display a virtual X server, Xvfb, is used.
"""

import argparse
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from typing import Any, NamedTuple

import numpy as np

from bench.screens import screen
from glrt.image.sources import load
from glrt.settings import settings_for
from glrt.view.state.preferences import Preferences

DRAG = 60  # frames
WAITED = 256  # samples per pixel of a picture at rest
SETTLED, IDLE = 3.0, 20.0  # seconds after the picture is complete: let pass, and measured
WARM = 30  # frames before a drag, for compilation and for the measurement of dispatch times
STEP = 0.004  # motion per frame of a drag, in widths of the window
SHARES = (50, 95, 99)  # percentiles of frame times

Script = Iterator[None]


def main(arguments: list[str] | None = None) -> int:
    """Measure a drag, a rest or a complete picture; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m bench.window_tour", description=__doc__)
    parser.add_argument("task", choices=["drag", "rest", "idle"])
    parser.add_argument("--scene", default="cornell", help="scene to show (default: cornell)")
    parsed = parser.parse_args(arguments)
    has_display = sys.platform != "linux" or {"DISPLAY", "WAYLAND_DISPLAY"} & os.environ.keys()
    if not has_display and not shutil.which("Xvfb"):
        print("glrt: without a display the window's figures need Xvfb", file=sys.stderr)
        return 3
    with nullcontext() if has_display else screen("1280x840") as name:
        os.environ.update({"DISPLAY": name} if name else {})
        if parsed.task == "drag":
            print("\n".join(told(*measure_drag(parsed.scene))))
        elif parsed.task == "idle":
            print("\n".join(idle_text(parsed.scene, *measure_idle(parsed.scene))))
        else:
            print(
                "\n".join(
                    rest_text(
                        parsed.scene, [measure_rest(parsed.scene, rests) for rests in (False, True)]
                    )
                )
            )
    return 0


class Frame(NamedTuple):
    """A frame of a camera drag."""

    seconds: float
    size: tuple[int, int]  # pixels of the picture in the frame
    samples: float  # per pixel


def measure_drag(scene: str, width: int = 640, height: int = 480) -> tuple[str, list[Frame]]:
    """Measure a camera drag; return a description with the driver, and the frames."""
    frames: list[Frame] = []
    drawn_by: list[str] = []

    def script(window: Any) -> Script:
        for _ in range(WARM):
            yield
        renderer = window.app.session.renderer
        for _ in range(DRAG):
            start = time.perf_counter()
            window.app.turn(STEP, 0.0, about_camera=False)
            yield
            frames.append(Frame(time.perf_counter() - start, renderer.size, renderer.work))
        drawn_by.append(renderer.context.renderer)

    play(scene, script, width=width, height=height)
    return f"{scene}, {width} x {height}, {drawn_by[0]}", frames


def told(place: str, frames: list[Frame]) -> Iterator[str]:
    """The results as a Markdown table: percentiles of frame times, and size of the picture."""
    seconds = [frame.seconds for frame in frames]
    shares = [f"{1e3 * np.percentile(seconds, share):.0f} ms" for share in SHARES]
    width, height = sorted(frame.size for frame in frames)[len(frames) // 2]
    samples = sum(frame.samples for frame in frames) / len(frames)
    yield f"| camera drag of {len(frames)} frames | p50 | p95 | p99 | picture |"
    yield "|---|---|---|---|---|"
    cells = [place, *shares, f"{width} x {height} pixels, {samples:.1f} samples per frame"]
    yield f"| {' | '.join(cells)} |"


class Wait(NamedTuple):
    """The render of a picture at rest, to all its samples."""

    rests: bool  # whether the window may switch to the kernel with constants
    seconds: float  # to all samples
    rate: float  # million pixel samples per second, over the last quarter of the samples
    frames: list[float]  # seconds of each frame


def measure_rest(scene: str, rests: bool, width: int = 640, height: int = 480) -> Wait:
    """Open a scene, and measure its frames until it has all samples, without edits."""
    times: list[tuple[float, float]] = []  # with the samples per pixel at each time

    def script(window: Any) -> Script:
        if not rests:
            window.app.session.rest = None
        while not window.app.session.samples:
            yield
        while not window.app.session.is_done:
            times.append((time.perf_counter(), window.app.session.renderer.work))
            yield

    play(scene, script, width=width, height=height, samples=WAITED)
    seconds, samples = np.array(times).T
    last = np.searchsorted(samples, 0.75 * samples[-1])
    rate = (samples[-1] - samples[last]) / (seconds[-1] - seconds[last]) * width * height / 1e6
    return Wait(rests, seconds[-1] - seconds[0], rate, list(np.diff(seconds)))


def rest_text(scene: str, waits: list[Wait]) -> Iterator[str]:
    """The results as a Markdown table: percentiles of frame times, and size of the picture."""
    rates = "million samples/s, last quarter"
    yield f"| {scene} at rest | to {WAITED} samples | {rates} | frames p50 | p99 | longest |"
    yield "|---|---|---|---|---|---|"
    for wait in waits:
        shares = [f"{1e3 * np.percentile(wait.frames, share):.0f} ms" for share in (50, 99, 100)]
        name = "with the faster kernel" if wait.rests else "without"
        cells = [name, f"{wait.seconds:.1f} s", f"{wait.rate:.2f}", *shares]
        yield f"| {' | '.join(cells)} |"


def measure_idle(scene: str) -> tuple[float, float]:
    """Open a scene, and let it be once its picture is complete: processor share, and frames/s."""
    found: list[float] = []

    def script(window: Any) -> Script:
        yield from frames_until_done(window)
        for seconds in (SETTLED, IDLE):
            start, used, frames = time.perf_counter(), time.process_time(), 0
            while time.perf_counter() - start < seconds:
                frames += 1
                yield
        spent = time.perf_counter() - start
        found.extend([(time.process_time() - used) / spent, frames / spent])

    play(scene, script, width=640, height=480, samples=32)
    return found[0], found[1]


def idle_text(scene: str, share: float, rate: float) -> Iterator[str]:
    """The results as a Markdown table."""
    yield "| picture complete, nothing done | of a core | frames/s |"
    yield "|---|---|---|"
    yield f"| {scene} | {100 * share:.1f} % | {rate:.1f} |"


def frames_until_done(window: Any) -> Script:
    """Yield for each frame until the picture has all its samples and is displayed."""
    for _ in range(5):
        yield
    while not window.app.session.is_done:
        yield
    for _ in range(3):
        yield


def play(source: str, script: Callable[[Any], Script], **settings: Any) -> int:
    """Open a window, continue the script after each frame, and close the window at its end.

    Returns the window's exit code, 0 unless a signal has ended it.
    """
    from glrt.view.window import Window

    scene = load(source)
    window = Window(source, scene, settings_for(scene.render, **settings))
    window.params.ini_disable = True

    def with_defaults() -> Script:
        window.app.preferences = Preferences(tour=False)  # the defaults, not those of the user
        window.recovery.offers = []  # nor the user's lost edits
        yield from script(window)

    running = with_defaults()

    def go_on() -> None:
        if next(running, "end") == "end":
            window.params.app_shall_exit = True

    window.params.callbacks.after_swap = go_on
    return window.run()


if __name__ == "__main__":
    raise SystemExit(main())
