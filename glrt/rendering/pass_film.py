"""What a pass adds samples to: named outputs, each two textures, and how many samples they hold.

A pass reads the one texture and writes the other; then they swap. A frame takes several dispatches;
what has been written of one that is not complete is never read.
"""

from contextlib import ExitStack
from typing import Any

import moderngl
import numpy as np

from glrt.core.errors import RenderError
from glrt.gpu.context import checked

Array = np.ndarray[Any, np.dtype[np.float32]]
Size = tuple[int, int]  # width and height


class PassFilm:
    """RGBA32F textures by the names of their outputs.

    Its samples are those from number `first_sample` on: 0, unless it holds a part of a render.
    """

    def __init__(self, gl: moderngl.Context, what: str, sizes: dict[str, Size]) -> None:
        """`what` is told if there is no room for them: RenderError."""
        self.samples = self.first_sample = 0  # of each pixel
        self._gl, self._what = gl, what
        self._pairs: list[dict[str, moderngl.Texture]] = [{}, {}]
        try:
            for pair in self._pairs:
                for name, size in sizes.items():
                    pair[name] = self._texture(size)
        except RenderError:
            self.release()
            raise

    def images(self) -> dict[str, moderngl.Texture]:
        """The textures under the names of the kernel's images: `source_NAME` and `target_NAME`."""
        return {
            f"{side}_{name}": texture
            for side, textures in zip(("source", "target"), self._pairs, strict=True)
            for name, texture in textures.items()
        }

    @property
    def next_sample(self) -> int:
        """The number of the sample that comes next, by which its random numbers are drawn."""
        return self.first_sample + self.samples

    def restart(self, first_sample: int = 0) -> None:
        """Forget everything. The textures keep what they hold: the first dispatch ignores it."""
        self.samples, self.first_sample = 0, first_sample

    def advance(self, samples: int) -> None:
        """A frame is complete: what was target becomes source."""
        self._pairs.reverse()
        self.samples += samples

    @property
    def sources(self) -> dict[str, moderngl.Texture]:
        """The textures of the last complete frame."""
        return self._pairs[0]

    def read_output(self, name: str, first: int, end: int) -> Array:
        """Rows of a source, (rows, width, 4): by a framebuffer, of which a part can be read."""
        texture = self._pairs[0][name]
        rows = self._gl.framebuffer([texture])
        part = (0, first, texture.width, end - first)
        data = rows.read(part, components=4, alignment=1, dtype="f4")
        rows.release()
        return np.frombuffer(data, np.float32).reshape(end - first, texture.width, 4)

    def release(self) -> None:
        """Free the textures."""
        for pair in self._pairs:
            for texture in pair.values():
                texture.release()

    def _texture(self, size: Size) -> moderngl.Texture:
        with ExitStack() as refused:
            with checked(self._gl, self._what):
                texture = self._gl.texture(size, 4, dtype="f4")
                refused.callback(texture.release)
            refused.pop_all()
        return texture
