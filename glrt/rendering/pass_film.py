"""The film of a pass: outputs of two textures each, by name, and the number of their samples.

A pass reads one texture and writes the other; then they swap. A frame takes several dispatches.
The output of an incomplete frame is never read.
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
    """Pairs of RGBA32F textures, by the names of their outputs.

    The samples are numbered from `first_sample`: 0, unless the film holds a part of a render.
    """

    def __init__(self, gl: moderngl.Context, what: str, sizes: dict[str, Size]) -> None:
        """Allocate the textures; RenderError names `what` if the driver has no room."""
        self.samples = self.first_sample = 0  # per pixel
        self._gl, self._what = gl, what
        self._pairs: list[dict[str, moderngl.Texture]] = [{}, {}]
        try:
            for pair in self._pairs:
                for name, size in sizes.items():
                    self._check(size)
                    pair[name] = self._texture(size)
        except RenderError:
            self.release()
            raise

    def images(self) -> dict[str, moderngl.Texture]:
        """The textures by the names of the kernel's images: `source_NAME` and `target_NAME`."""
        return {
            f"{side}_{name}": texture
            for side, textures in zip(("source", "target"), self._pairs, strict=True)
            for name, texture in textures.items()
        }

    @property
    def next_sample(self) -> int:
        """The number of the next sample, which determines its random numbers."""
        return self.first_sample + self.samples

    def restart(self, first_sample: int = 0) -> None:
        """Discard all samples; the next dispatch ignores what the textures hold."""
        self.samples, self.first_sample = 0, first_sample

    def copy_to_targets(self) -> None:
        """Copy the last complete frame to the textures of the next; needs a current context."""
        for source, target in zip(*(pair.values() for pair in self._pairs), strict=True):
            ends = [self._gl.framebuffer([texture]) for texture in (target, source)]
            self._gl.copy_framebuffer(*ends)
            for end in ends:
                end.release()

    def advance(self, samples: int) -> None:
        """Complete a frame of `samples` per pixel: the target textures become the sources."""
        self._pairs.reverse()
        self.samples += samples

    @property
    def sources(self) -> dict[str, moderngl.Texture]:
        """The textures of the last complete frame."""
        return self._pairs[0]

    def read_output(self, name: str, first: int, end: int) -> Array:
        """Rows `first` to `end` of a source, (rows, width, 4), read in part by a framebuffer."""
        return self._rows(self._pairs[0][name], first, end)

    def _rows(self, texture: moderngl.Texture, first: int, end: int) -> Array:
        rows = self._gl.framebuffer([texture])
        part = (0, first, texture.width, end - first)
        data = rows.read(part, components=4, alignment=1, dtype="f4")
        rows.release()
        return np.frombuffer(data, np.float32).reshape(end - first, texture.width, 4)

    def release(self) -> None:
        """Release the textures."""
        for pair in self._pairs:
            for texture in pair.values():
                texture.release()

    def _check(self, size: Size) -> None:
        """Raise RenderError for a texture with edges that the driver does not allow."""
        most = int(self._gl.info["GL_MAX_TEXTURE_SIZE"])
        if max(size) > most:
            raise RenderError(
                f"{self._what} takes a texture of {size[0]:,} x {size[1]:,} texels, and this "
                f"driver allows {most:,} along an edge. Render it piece by piece with --crop."
            )

    def _texture(self, size: Size) -> moderngl.Texture:
        with ExitStack() as refused:
            with checked(self._gl, self._what):
                texture = self._gl.texture(size, 4, dtype="f4")
                refused.callback(texture.release)
            refused.pop_all()
        return texture
