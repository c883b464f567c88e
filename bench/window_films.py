"""The films of the window in README and docs: `python -m bench.window_films [NAME...]`.

Each is a series of stills, written to FOLDER/NAME.webp. Without a display a virtual X server, Xvfb,
is used.
"""

import os
import shutil
import sys
from argparse import ArgumentParser
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from bench.screens import screen
from bench.window_tour import Script, frames_until_done, play
from glrt.scene.scene import with_lights
from glrt.view.controls import replaced
from glrt.view.edits.ready_materials import with_ready
from glrt.view.edits.scene_edits import with_object

ROOM = "cornell"
BRIGHT = (0.69, 0.915)  # place of a pixel under the glass ball, from (0, 0) to (1, 1)
MOST_BYTES = 300_000  # of a film
SHOWN = 2500  # milliseconds for which a film shows each still: a reader needs them
Stills = Callable[[Any], Script]  # a script that yields where a still is taken


def lamps(window: Any) -> Script:
    """Lamps are dimmed and turned off."""
    scene = window.app.session.scene
    _show_tab(window, "Light")
    yield
    for blue, amber in ((0.0, 1.5), (2.5, 0.3)):
        window.app.session.edit(with_lights(scene, {"blue": blue, "amber": amber}))
        yield


def editor(window: Any) -> Script:
    """A metal ball is added and moved; another ball is deleted, and comes back."""
    app, session = window.app, window.app.session
    _show_tab(window, "Scene")
    yield
    app.add("sphere")
    yield
    number = app.selected
    session.edit(with_ready(session.scene, app.selected_shape.material, "gold"))
    yield
    moved = replaced(session.scene.objects[number], center=(-0.45, 0.35, 0.1), radius=0.3)
    session.edit(with_object(session.scene, number, moved))
    yield
    app.select(5)
    yield
    app.delete()
    yield
    app.undo()
    yield


def pair(window: Any) -> Script:
    """Picture A is kept, B has one bounce; both go on, and are shown in three ways."""
    app = window.app
    _show_tab(window, "Compare")
    yield
    app.keep()
    app.session.edit(bounces=1)
    yield
    app.pair.go_on(True)
    yield
    app.pair.is_beside = True
    yield
    app.pair.is_beside = False
    app.pair.swap()
    yield


def paths(window: Any) -> Script:
    """The paths of a bright pixel, from several sides, and a particle that reaches it."""
    app = window.app
    yield
    app.ask_paths(*BRIGHT)
    yield
    order = np.argsort(-app.paths.found.radiances.sum(axis=1))
    for rank in (3, 4, 0):
        app.paths.show(int(order[rank]))
        yield
    across, up = app.outside
    for turn in (40.0, 80.0):
        app.outside = across + turn, up
        yield
    app.outside, app.paths.with_particles = (across, up), True
    app.ask_paths(*BRIGHT)
    yield
    app.paths.shown = app.paths.found.particles.paths[0]
    yield


FILMS: dict[str, tuple[str, Stills, dict[str, int]]] = {  # scene, script and settings of each
    "window": ("lamps", lamps, {"width": 320, "height": 320, "samples": 512}),
    "editor": (ROOM, editor, {"width": 400, "height": 400, "samples": 96}),
    "pair": (ROOM, pair, {"width": 400, "height": 400, "samples": 96}),
    "paths": (ROOM, paths, {"width": 512, "height": 512, "samples": 96}),
}


def main(arguments: list[str] | None = None) -> int:
    """Make films; returns the exit code."""
    parser = ArgumentParser(prog="python -m bench.window_films", description=__doc__)
    parser.add_argument("names", nargs="*", help=f"default: {', '.join(FILMS)}")
    parser.add_argument("-o", "--output", type=Path, default=Path("docs/pictures"))
    parsed = parser.parse_args(arguments)
    if unknown := [name for name in parsed.names if name not in FILMS]:
        print(f"glrt: there is no film {unknown[0]!r}: {', '.join(FILMS)}", file=sys.stderr)
        return 2
    has_display = sys.platform != "linux" or {"DISPLAY", "WAYLAND_DISPLAY"} & os.environ.keys()
    if not has_display and not shutil.which("Xvfb"):
        print("glrt: without a display the window's films need Xvfb", file=sys.stderr)
        return 3
    with nullcontext() if has_display else screen("1280x840") as name:
        os.environ.update({"DISPLAY": name} if name else {})
        for film in parsed.names or FILMS:
            make_film(film, parsed.output / f"{film}.webp")
    return 0


def make_film(name: str, file: Path) -> None:
    """Write a film of stills; raises RuntimeError if the file is too large."""
    from PIL import Image

    from glrt.view import event_wait

    event_wait.LONGEST = 0.0  # what the script does is no event of the window
    source, stills, settings = FILMS[name]
    pictures = []

    def script(window: Any) -> Script:
        for _ in stills(window):
            yield from _waiting(window)
            pixels = window.app.session.context.gl.screen
            size = pixels.size
            codes = np.frombuffer(pixels.read(components=3, alignment=1), np.uint8)
            pictures.append(Image.fromarray(codes.reshape(size[1], size[0], 3)[::-1]))

    if code := play(source, script, **settings):
        raise SystemExit(code)  # a signal: the film has no end
    first, *rest = pictures
    options: dict[str, Any] = {"duration": SHOWN, "loop": 0, "quality": 60, "method": 6}
    first.save(file, save_all=True, append_images=rest, **options)
    if file.stat().st_size > MOST_BYTES:
        raise RuntimeError(f"{file} has {file.stat().st_size} bytes, more than {MOST_BYTES}")


def _waiting(window: Any) -> Script:
    """Yield for each frame until the picture has all samples, and its error is known."""
    app = window.app
    yield from frames_until_done(window)
    while not app.pair.is_done or app.paths.is_waiting or app.progress.last is None:
        yield
    for _ in range(5):
        yield


def _show_tab(window: Any, tab: str) -> None:
    window.app.preferences = replaced(window.app.preferences, tab=tab)


if __name__ == "__main__":
    raise SystemExit(main())
