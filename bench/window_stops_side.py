"""One window for `window_times --stops`: `python -m bench.window_stops_side WxH SCENE`.

It prints the longest stop of each action as JSON: its seconds, and the processor seconds of the
busiest frame, which a loaded machine does not lengthen. With GLRT_STOPS in the environment, stderr
says where the window was in each frame that took longer than MOST.
"""

import faulthandler
import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.window_tour import Script
from glrt.cli.main import main as glrt
from glrt.view import event_wait
from glrt.view import window as module
from glrt.view.state.preferences import Preferences

MOST = 0.25  # seconds: the aim for each stop
DRAG, STEP = 40, 0.002  # frames, there and back, and motion per frame in widths of the window
METHODS = "nee", "phong", "mis"
FIRST = "lamps"  # the scene of the window before it opens another one
AFTER = 1.0  # seconds for which frames are watched once an action is done
PATIENCE = 30.0  # seconds for an action

Stop = tuple[float, float]
Action = tuple[str, Callable[[], object], Callable[[], bool]]  # its name, act, whether it is done


class Watch:
    """Times from frame to frame."""

    def __init__(self) -> None:
        """Begin without a frame."""
        self.traces = "GLRT_STOPS" in os.environ
        self.begin()

    def begin(self) -> None:
        """Begin to watch an action."""
        self.longest = self.busiest = 0.0
        self._before, self._used = time.perf_counter(), time.process_time()

    def frame(self) -> None:
        """Note the end of a frame."""
        now, used = time.perf_counter(), time.process_time()
        self.longest = max(self.longest, now - self._before)
        self.busiest = max(self.busiest, used - self._used)
        self._before, self._used = now, used
        if self.traces:
            faulthandler.dump_traceback_later(MOST)


def actions(app: Any, source: str, folder: Path) -> Iterator[Action]:
    """Yield the actions, one after the other: each begins where the one before has ended."""
    session, show, picture = app.session, app.show, folder / "picture.png"
    steps = iter(range(1 << 30))

    def has_samples() -> bool:
        return not (session.is_behind or session.is_preview) and session.samples >= 2

    def turn() -> None:
        app.turn(STEP if next(steps) % DRAG < DRAG / 2 else -STEP, 0.0, about_camera=False)

    def look(view: str) -> Callable[[], None]:
        return lambda: setattr(show, "view", view)

    yield (
        "open",
        lambda: app.files.open(source),
        lambda: app.files.source == source and has_samples(),
    )
    yield "first drag", turn, has_samples
    for method in METHODS:
        yield f"method {method}", partial(session.edit, method=method), has_samples
    yield "drag", turn, has_samples
    yield "denoised", look("denoised"), lambda: show.drawn == "denoised"
    yield "view depth", look("depth"), lambda: show.drawn == "depth"
    yield "view picture", look("picture"), has_samples
    yield (
        "save",
        lambda: app.files.save_picture(str(picture)),
        lambda: picture.exists() and app.files.writer is None,
    )


def measure(window: Any, source: str, folder: Path, found: dict[str, Stop]) -> Script:
    """Do each action in a window that has drawn its first frame, and note its longest stop."""
    app, watch = window.app, Watch()
    app.preferences = Preferences(tour=False)
    while not app.session.samples:
        yield
    for name, act, is_done in actions(app, source, folder):
        watch.begin()
        begun = time.perf_counter()
        for _ in range(DRAG if "drag" in name else 1):
            act()
            yield
            watch.frame()
        while not is_done() and time.perf_counter() - begun < PATIENCE:
            yield
            watch.frame()
        done = time.perf_counter()
        while time.perf_counter() - done < AFTER:
            yield
            watch.frame()
        faulthandler.cancel_dump_traceback_later()
        found[name] = watch.longest, watch.busiest
        if watch.traces:
            print(f"{name}: {watch.longest:.2f} s, {watch.busiest:.2f} s busy", file=sys.stderr)


def main() -> int:
    """Open the window as `glrt view` does; returns its exit code."""
    size, source = sys.argv[1:]
    width, height = map(int, size.split("x"))
    module.SIZE = width, height
    event_wait.LONGEST = 0.0  # a window that waits for events does not stop
    run, found = module.Window.run, dict[str, Stop]()
    with TemporaryDirectory() as folder:

        def watched(window: module.Window) -> int:
            running = measure(window, source, Path(folder), found)

            def go_on() -> None:
                if next(running, "end") == "end":
                    window.params.app_shall_exit = True

            window.params.callbacks.after_swap = go_on
            window.params.ini_disable = True
            return run(window)

        module.Window.run = watched  # type: ignore[method-assign, assignment]
        code = glrt(["view", FIRST])
    print(json.dumps(found))
    return code


if __name__ == "__main__":
    raise SystemExit(main())
