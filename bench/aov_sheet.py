"""The picture of docs/how-to/aovs.md: a render and its AOVs as the window shows them."""

import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.contact_sheet import check_sheet, save_sheet
from bench.program import exit_code_of, parser_of
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.aov_view import AovView
from glrt.settings import Aov

SCENE, SIZE, SAMPLES = "weekend", (480, 270), 128
SHOWN: tuple[Aov, ...] = ("albedo", "normal", "depth", "position", "object")


def aov_codes(renderer: Renderer, aov: Aov) -> NDArray[np.uint8]:
    """An AOV of a render as the window shows it, (H, W, 3) uint8 sRGB."""
    gl, (width, height) = renderer.context.gl, renderer.size
    mean = renderer.aov_mean(aov)
    assert mean
    with gl:
        view, target = AovView(gl), gl.simple_framebuffer((width, height), 3)
        with gl.scope(target):
            view.draw(aov, mean, renderer.scene.camera)
        codes = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
        view.release()
        target.release()
    return codes.reshape(height, width, 3)[::-1].copy()


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.aov_sheet -o FILE`; returns the exit code."""
    parser = parser_of("aov_sheet", __doc__)
    parser.add_argument("-o", dest="output", metavar="FILE", required=True, type=Path)
    given = parser.parse_args(arguments)
    return exit_code_of(lambda: _make(given))


def _make(given: argparse.Namespace) -> None:
    check_sheet(given.output)
    width, height = SIZE
    frame: dict[str, Any] = {"width": width, "height": height, "samples": SAMPLES}
    renderer = Renderer(load(SCENE), tier="baked", aov=SHOWN, **frame)
    renderer.render().image()
    codes = [renderer.display(), *(aov_codes(renderer, aov) for aov in SHOWN)]
    renderer.release()
    save_sheet(codes, given.output)


if __name__ == "__main__":
    sys.exit(main())
