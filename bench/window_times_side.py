"""One window for `window_times`: `python -m bench.window_times_side BEGAN WxH SCENE` prints JSON.

BEGAN is when the command was given, in seconds since 1970.
"""

import json
import sys
import time
from typing import Any

from bench.window_tour import Script
from glrt.cli.main import main as glrt
from glrt.view import window as module
from glrt.view.state.preferences import Preferences

DRAG, STEP = 30, 0.004  # frames, and motion per frame in widths of the window
COUNTED = 3.0  # seconds in which frames are counted


def measure(window: Any, began: float, found: dict[str, float]) -> Script:
    """Note the times of a window that has just drawn its first frame; see `Times`."""
    found["window"] = time.time() - began
    app = window.app
    app.preferences = Preferences(tour=False)
    while app.shows_start or not app.session.samples:
        yield
    yield
    found["picture"] = time.time() - began
    for _ in range(DRAG):
        app.turn(STEP, 0.0, about_camera=False)
        yield
    dragged = time.time()
    while app.session.is_behind or app.session.is_preview or not app.session.samples:
        yield
    found["full"] = time.time() - dragged
    app.session.edit(samples=1 << 20)  # so that it does not come to rest
    begun, frames = time.time(), 0
    while time.time() - begun < COUNTED:
        frames += 1
        yield
    found["rate"] = frames / (time.time() - begun)


def main() -> int:
    """Open the window as `glrt view` does; returns its exit code."""
    began, size, source = sys.argv[1:]
    width, height = map(int, size.split("x"))
    module.SIZE = width, height
    run, found = module.Window.run, dict[str, float]()

    def watched(window: module.Window) -> int:
        running = iter(measure(window, float(began), found))

        def go_on() -> None:
            if next(running, "end") == "end":
                window.params.app_shall_exit = True

        window.params.callbacks.after_swap = go_on
        window.params.ini_disable = True
        return run(window)

    module.Window.run = watched  # type: ignore[method-assign, assignment]
    code = glrt(["view", source])
    print(json.dumps(found))
    return code


if __name__ == "__main__":
    raise SystemExit(main())
