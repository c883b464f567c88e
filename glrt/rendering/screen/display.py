"""The display pass: expose, tone-map and encode a film's mean, on any framebuffer."""

from typing import Any, get_args

import moderngl
import numpy as np

from glrt.gpu.glsl import Source
from glrt.gpu.program import drawing
from glrt.settings import Settings, ToneMap

_VERSION = "410 core"


class Display:
    """A full-screen quad that shows a texture of radiance."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Compile the pass; RenderError says where the driver refuses it."""
        self._gl = gl
        self._program = drawing(
            gl, Source("display.vert", version=_VERSION), Source("display.frag", version=_VERSION)
        )
        self._quad = gl.vertex_array(self._program, [])

    def draw(self, picture: moderngl.Texture, settings: Settings) -> None:
        """Draw over the framebuffer in use."""
        picture.use(0)
        self._program["exposure"] = settings.exposure
        self._program["tonemap"] = get_args(ToneMap).index(settings.tonemap)
        self._quad.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def read(self, picture: moderngl.Texture, settings: Settings) -> np.ndarray[Any, Any]:
        """The picture as it is drawn, (H, W, 3) uint8, row 0 on top."""
        width, height = picture.size
        target = self._gl.simple_framebuffer((width, height), 3)
        with self._gl.scope(target):
            self.draw(picture, settings)
        codes = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
        target.release()
        return codes.reshape(height, width, 3)[::-1].copy()

    def release(self) -> None:
        """Release program and quad."""
        self._quad.release()
        self._program.release()


def displayed(
    gl: moderngl.Context, picture: moderngl.Texture, settings: Settings
) -> np.ndarray[Any, Any]:
    """Read a picture as `Display.read` does, with a pass for this call alone."""
    display = Display(gl)
    codes = display.read(picture, settings)
    display.release()
    return codes
