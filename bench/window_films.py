"""Animations of the window for the documentation: `python -m bench.window_films FILM FILE.webp`.

`editor` adds a metal ball to a room; `paths` shows why a pixel on the floor is bright; `pair` sets
ten bounces beside one. Without a display a virtual X server, Xvfb, is used.
"""

import argparse
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from bench.screens import screen
from bench.window_tour import MOST_BYTES, Script, frames_until_done, play
from glrt.image.sources import load

SIZE = (868, 560)  # pixels, of 1240 x 800
PIXEL = (0.645, 0.935)  # of the picture: on the floor, under the glass ball
Frames = list[Image.Image]


def editor(window: Any, frames: Frames) -> Script:
    """A ball is added, becomes metal, is moved; another is selected and duplicated."""
    from glrt.view.controls import replaced
    from glrt.view.edits.scene_edits import with_object, with_retyped

    app = window.app
    yield from shown(window, frames)
    app.add("sphere")
    yield from shown(window, frames)
    app.edit_scene("", partial(with_retyped, name="sphere", kind="metal"))
    yield from shown(window, frames)
    number = app.selected
    for center in ((-0.1, 0.2, 0.1), (-0.2, 0.4, 0.1)):
        ball = replaced(app.session.scene.objects[number], center=center)
        app.edit_scene("", partial(with_object, index=number, shape=ball))
        yield from shown(window, frames)
    app.select(5)
    yield from shown(window, frames)
    app.delete()
    yield from shown(window, frames)
    app.undo()
    yield from shown(window, frames)


def paths(window: Any, frames: Frames) -> Script:
    """A pixel is asked for; some of its samples; the view from outside turns; its particles."""
    app = window.app
    yield from shown(window, frames)
    app.choose_paths()
    app.ask_paths(*PIXEL)
    while app.paths.is_waiting:
        yield
    app.choose_paths()
    yield from shown(window, frames)
    for path in app.paths.found.paths[1:4]:
        app.paths.show(path.sample)
        yield from shown(window, frames)
    app.paths.show(app.paths.found.paths[0].sample)
    for yaw in (60.0, 90.0, 120.0, 35.0):
        app.outside = (yaw, 25.0)
        yield from shown(window, frames)
    app.paths.with_particles = True
    app.ask_paths(*PIXEL)
    while app.paths.is_waiting:
        yield
    app.paths.shown = app.paths.found.particles.paths[0]
    yield from shown(window, frames)


def pair(window: Any, frames: Frames) -> Script:
    """Ten bounces and one: behind a line, side by side, swapped."""
    app = window.app
    yield from shown(window, frames)
    app.keep()
    app.session.edit(bounces=1)
    app.pair.go_on(True)
    for change in (
        lambda: None,
        lambda: setattr(app.show, "wipe", 0.75),
        lambda: setattr(app.pair, "is_beside", True),
        app.pair.swap,
    ):
        change()
        yield
        while not app.pair.is_done:
            yield
        yield from shown(window, frames)


def shown(window: Any, frames: Frames) -> Script:
    """Wait for the picture; then the window as it is."""
    yield from frames_until_done(window)
    gl = window.app.session.renderer.context.gl
    width, height = gl.screen.size
    pixels = np.frombuffer(gl.screen.read(components=3, alignment=1), np.uint8)
    shot = Image.fromarray(pixels.reshape(height, width, 3)[::-1])
    frames.append(shot.resize(SIZE, Image.Resampling.LANCZOS))


FILMS: dict[str, Callable[[Any, Frames], Iterator[None]]] = {
    "editor": editor,
    "paths": paths,
    "pair": pair,
}


def main(arguments: list[str] | None = None) -> int:
    """Make a film; RuntimeError if the file is too large. Returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m bench.window_films", description=__doc__)
    parser.add_argument("film", choices=FILMS)
    parser.add_argument("file", type=Path)
    parsed = parser.parse_args(arguments)
    has_display = sys.platform != "linux" or {"DISPLAY", "WAYLAND_DISPLAY"} & os.environ.keys()
    frames: Frames = []
    with nullcontext() if has_display else screen("1280x840") as name:
        os.environ.update({"DISPLAY": name} if name else {})
        film = FILMS[parsed.film]
        play(
            load("cornell"), lambda window: film(window, frames), width=320, height=320, samples=96
        )
    first, *rest = frames
    options: dict[str, Any] = {"duration": 1200, "loop": 0, "quality": 50, "method": 6}
    first.save(parsed.file, save_all=True, append_images=rest, **options)
    if parsed.file.stat().st_size > MOST_BYTES:
        raise RuntimeError(f"{parsed.file} has more than {MOST_BYTES} bytes")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
