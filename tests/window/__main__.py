"""A window with a hand on it: a line on stdin names a check, one on stdout says what it found."""

import json
import os
import sys
import traceback
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

from imgui_bundle import hello_imgui, imgui
from imgui_bundle.immapp import testing

from glrt.image.sources import load
from glrt.settings import settings_for
from glrt.view import edit_compiler, event_wait, file_watch, window
from tests.window.hand import CHECKS, SMALL, Hand

SCENE = "cornell"
SIZE = (900, 1000)
SOON = 0.05  # seconds between looks at files and preferences, which checks wait for


def opened() -> window.Window:
    """The window that the checks are done in."""
    file_watch.INTERVAL = window.KEEP_EVERY = SOON
    vars(edit_compiler)["compile_for"] = lambda *_: (
        False
    )  # another process would take seconds each time
    event_wait.LONGEST = 0.0  # what the hand does is no event of the window
    scene = load(SCENE)
    result = window.Window(SCENE, scene, settings_for(scene.render, **SMALL))
    result.params.app_window_params.window_geometry.size = SIZE
    result.params.app_window_params.restore_previous_geometry = False
    return result


def findings(hand: Hand) -> Iterator[str]:
    """The problem that each requested check found, or ""; a missing item ends the checks."""
    for name in sys.stdin:
        try:
            hand.begin()
            CHECKS[name.strip()](hand)
        except Exception:
            yield traceback.format_exc()
        else:
            yield "an item was not found" if hand.ctx.is_error() else ""
        if hand.ctx.is_error():
            return


def main() -> None:
    """Do checks until stdin ends. The test engine's output goes to stderr."""
    with os.fdopen(os.dup(1), "w", buffering=1) as answers:
        os.dup2(2, 1)
        for file in sorted(Path(__file__).parent.glob("check_*.py")):
            import_module(f"tests.window.{file.stem}")
        shown = opened()
        hand = Hand(shown)

        def work(ctx: imgui.test_engine.TestContext) -> None:
            hand.hold(ctx)
            engine = imgui.test_engine.get_io(hello_imgui.get_imgui_test_engine())
            engine.config_watchdog_warning = engine.config_watchdog_kill_test = 1e6  # seconds
            for found in findings(hand):
                print(json.dumps(found), file=answers)

        testing.run(test_function=work, runner_params=shown.params, add_ons_params=shown.add_ons)


if __name__ == "__main__":
    main()
