"""The film as a texture that Dear ImGui can show."""

from collections.abc import Callable

import moderngl
import numpy as np
from numpy.typing import NDArray

from glrt.gpu.canvas import Canvas
from glrt.rendering.screen.display import Display
from glrt.rendering.screen.magnifier import Magnifier
from glrt.settings import Settings

Part = tuple[float, float, float, float]  # left, top, width, height, in pixels from the upper left


class Picture:
    """The last result of the display pass; it stays until the film has something new."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Compile the display pass; there is no picture yet."""
        self._gl = gl
        self._display = Display(gl)
        self._canvas = Canvas(gl)
        self._kept: moderngl.Texture | None = None
        self._magnifiers = Magnifier(gl), Magnifier(gl)

    @property
    def _texture(self) -> moderngl.Texture | None:
        return self._canvas.texture

    @property
    def name(self) -> int:
        """OpenGL name of the texture; 0 if there is none."""
        return self._texture.glo if self._texture else 0

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self._texture.size if self._texture else (0, 0)

    def draw(self, film: moderngl.Texture, settings: Settings, is_preview: bool = False) -> None:
        """Expose, tone-map and encode a film, whose row 0 is shown on top."""
        self.paint(film.size, lambda: self._display.draw(film, settings), is_preview)

    def paint(
        self, size: tuple[int, int], draw: Callable[[], None], is_preview: bool = False
    ) -> None:
        """Let `draw` fill the whole picture, of this width and height in pixels."""
        target = self._canvas.sized(size)
        assert self._texture
        magnify = moderngl.LINEAR if is_preview else moderngl.NEAREST
        self._texture.filter = (moderngl.LINEAR, magnify)
        with self._gl.scope(target):
            draw()

    def codes(self) -> NDArray[np.uint8]:
        """Return the picture as on the screen, (H, W, 4) uint8 sRGB; rows may be upside down."""
        assert self._texture
        width, height = self.size
        return np.frombuffer(self._texture.read(), np.uint8).reshape(height, width, 4)

    def part(self, part: Part, size: tuple[int, int], is_kept: bool = False) -> int:
        """Return the OpenGL name of a magnified part of the picture, or of the kept picture."""
        texture = self._kept if is_kept else self._texture
        assert texture
        magnifier = self._magnifiers[is_kept]
        return magnifier.draw(texture, part, size).glo

    @property
    def kept_name(self) -> int:
        """OpenGL name of the kept picture, which others are compared with; 0 if there is none."""
        return self._kept.glo if self._kept else 0

    def keep(self) -> None:
        """Keep a copy of the picture, to compare it with later ones."""
        self.forget()
        if self._texture:
            self._kept = self._gl.texture(self._texture.size, 4)
            target = self._gl.framebuffer([self._kept])
            self._gl.copy_framebuffer(target, self._canvas.sized(self.size))
            target.release()

    def forget(self) -> None:
        """Release the kept picture."""
        if self._kept:
            self._kept.release()
        self._kept = None

    def reload_shaders(self) -> None:
        """Compile the display pass again, as `Session.reload_shaders` does for the kernel."""
        fresh = Display(self._gl)
        self._display.release()
        self._display = fresh

    def release(self) -> None:
        """Release all OpenGL objects."""
        self._display.release()
        for magnifier in self._magnifiers:
            magnifier.release()
        self.forget()
        self._canvas.release()
