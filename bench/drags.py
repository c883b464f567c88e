"""Whether the picture follows a drag: `python -m bench.drags`.

In the window each frame does a step of a drag: of the camera, of an object by its handles, of the
bounce limit, of a material's colour. The bench reports how many pictures a second differ from
the one before them on the screen, and how long one stays. Without a display a virtual X server,
Xvfb, is used.
"""

import argparse
import os
import shutil
import sys
import time
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import nullcontext
from functools import partial
from typing import Any, NamedTuple, get_args

import numpy as np

from bench.screens import screen
from bench.window_tour import play
from glrt.image.sources import load
from glrt.plan.methods import METHODS
from glrt.rendering.history.temporal import Mode
from glrt.scene.scene import Scene
from glrt.settings import Method, settings_for
from glrt.view.controls import replaced
from glrt.view.edits.scene_edits import with_material, with_object

SECONDS = 6.0  # of each drag
REST = 12  # frames between drags, and at least so many before the first
STEP = 0.004  # of a drag in a frame: widths of the window, and scene units
SETTLED = 4  # samples of the whole picture before a drag
RESET = {"temporal": "reset"}

Script = Iterator[None]
Step = Callable[[Any, int], None]


class Drag(NamedTuple):
    """The pictures that came to the screen during a drag."""

    what: str
    seconds: float
    changes: list[float]  # when each picture came that differs from the one before, in seconds

    @property
    def rate(self) -> float:
        """Distinct pictures a second."""
        return len(self.changes) / self.seconds

    @property
    def gap(self) -> float:
        """The 99th percentile of the seconds that a picture stays."""
        gaps = np.diff([0.0, *self.changes, self.seconds])
        return float(np.percentile(gaps, 99))


def main(arguments: list[str] | None = None) -> int:
    """Measure the drags; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m bench.drags", description=__doc__)
    parser.add_argument("--scene", default="cornell", help="scene to show (default: cornell)")
    parser.add_argument("--size", type=int, nargs=2, default=(640, 480), metavar=("W", "H"))
    parser.add_argument("--seconds", type=float, default=SECONDS, help="of each drag")
    modes = get_args(Mode)
    parser.add_argument("--temporal", choices=modes, default="reset", help="(default: reset)")
    parser.add_argument("--method", choices=METHODS, help="(default: the scene's)")
    parsed = parser.parse_args(arguments)
    has_display = sys.platform != "linux" or {"DISPLAY", "WAYLAND_DISPLAY"} & os.environ.keys()
    if not has_display and not shutil.which("Xvfb"):
        print("glrt: without a display the window's figures need Xvfb", file=sys.stderr)
        return 3
    with nullcontext() if has_display else screen("1280x840") as name:
        os.environ.update({"DISPLAY": name} if name else {})
        ways = {"temporal": parsed.temporal}
        measured = measure(parsed.scene, parsed.size, parsed.seconds, ways, parsed.method)
        print("\n".join(told(*measured)))
    return 0


def measure(
    scene: str,
    size: tuple[int, int],
    seconds: float,
    ways: Mapping[str, str] = RESET,
    method: Method | None = None,
) -> tuple[str, list[Drag]]:
    """Drag each for some seconds; a description with the driver, and what was seen.

    `ways` are preferences of the window.
    """
    drags: list[Drag] = []
    drawn_by: list[str] = []
    opened = load(scene)
    settings = settings_for(opened.render, **({"method": method} if method else {}))

    def script(window: Any) -> Script:
        app = window.app
        app.preferences = replaced(app.preferences, **ways)
        for what, step in steps_of(opened).items():
            window.app.session.edit(opened)
            yield from _settled(window)
            yield from _dragged(window, what, step, seconds, drags)
        drawn_by.append(window.app.session.renderer.context.renderer)

    play(scene, script, width=size[0], height=size[1], method=settings.method)
    words = scene, f"{size[0]} x {size[1]}", settings.method, *ways.values(), drawn_by[0]
    return ", ".join(words), drags


def steps_of(scene: Scene) -> dict[str, Step]:
    """The step that each drag does in a frame, by the number of the frame."""
    ball = next(n for n, shape in enumerate(scene.objects) if shape.shape == "sphere")
    matte = next(n for n, m in scene.materials.items() if m.type == "lambertian")

    def turn(app: Any, frame: int) -> None:
        app.turn(_swing(frame + 1) - _swing(frame), 0.0, about_camera=False)

    def shift(app: Any, frame: int) -> None:
        app.edit_scene(f"object {ball}", partial(_shifted, ball, _swing(frame + 1)))

    def bounce(app: Any, frame: int) -> None:
        app.session.edit(gesture="['bounces']", bounces=2 + frame % 10)

    def tint(app: Any, frame: int) -> None:
        app.edit_scene(f"{matte} color", partial(_tinted, matte, 0.5 + _swing(frame)))

    return {"camera": turn, "handles of an object": shift, "bounces": bounce, "colour": tint}


def told(place: str, drags: list[Drag]) -> Iterator[str]:
    """The results as a Markdown table."""
    yield f"| drag in {place} | distinct pictures a second | p99 of the gap |"
    yield "|---|---|---|"
    for drag in drags:
        yield f"| {drag.what} | {drag.rate:.1f} | {1e3 * drag.gap:.0f} ms |"


def _settled(window: Any) -> Script:
    """Frames until the whole picture has some samples, without edits."""
    for _ in range(REST):
        yield
    session = window.app.session
    while session.is_preview or session.is_behind or session.samples < SETTLED:
        yield


def _dragged(window: Any, what: str, step: Step, seconds: float, drags: list[Drag]) -> Script:
    """A step in each frame; the picture is looked at when the frame is on the screen."""
    start, frame, changes = time.perf_counter(), 0, list[float]()
    seen = _fingerprint(window)
    while (now := time.perf_counter() - start) < seconds:
        shown = _fingerprint(window)
        if shown != seen:
            changes.append(now)
        seen = shown
        step(window.app, frame)
        frame += 1
        yield
    drags.append(Drag(what, seconds, changes))


def _fingerprint(window: Any) -> int:
    """A checksum of the picture on the screen."""
    texture = window.app.picture._texture
    return zlib.crc32(texture.read()) if texture else 0


def _swing(frame: int) -> float:
    """To and fro, by a step a frame: what is dragged stays in sight."""
    return STEP * (20 - abs((frame + 20) % 80 - 40))


def _shifted(number: int, aside: float, scene: Scene) -> Scene:
    ball: Any = scene.objects[number]
    center = (ball.center[0] + aside, *ball.center[1:])
    return with_object(scene, number, replaced(ball, center=center))


def _tinted(name: str, red: float, scene: Scene) -> Scene:
    material: Any = scene.materials[name]
    return with_material(scene, name, color=(red, *material.color[1:]))


if __name__ == "__main__":
    raise SystemExit(main())
