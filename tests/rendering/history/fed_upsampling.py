"""Upsampling of given pictures: its passes without a kernel of paths."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import moderngl
import numpy as np

from glrt.analysis.motion.playing import read_texture
from glrt.gpu.context import Context
from glrt.rendering.history.lattice import lattice_of
from glrt.rendering.history.upsample import Upsample
from glrt.rendering.renderer import Renderer
from tests.rendering.history.twins import Array

Pictures = Callable[[], Array]  # pairs of samples, (2, H, W, 3), of the next frame


class Fed(Upsample):
    """Upsampling whose samples come from given pictures, not from a kernel."""

    def __init__(self, gl: moderngl.Context, pictures: Pictures, factor: int) -> None:
        super().__init__(gl, factor)
        self.pictures, self.corners = pictures, list[tuple[int, int]]()
        self._fed: list[moderngl.Texture] = []

    def _samples_of(
        self, renderer: Renderer, size: tuple[int, int], corner: tuple[int, int]
    ) -> list[moderngl.Texture]:
        self.corners.append(corner)
        places = lattice_of(size, self.last_factor, corner)
        self.release_fed()
        for picture in self.pictures():
            texels = np.zeros((size[0] * size[1], 4), np.float32)
            texels[places, :3] = picture.reshape(-1, 3)[places]
            texels[places, 3] = 1
            self._fed.append(self._gl.texture(size, 4, texels.tobytes(), dtype="f4"))
        return self._fed

    def release_fed(self) -> None:
        for texture in self._fed:
            texture.release()
        self._fed = []

    def frame(self, now: Any) -> tuple[Array, Array, Array]:
        """The next coarse picture: own samples, means around, and what is shown, (H, W, 4)."""
        with self._gl:
            nothing: Any = None
            self.trace(nothing, now)
            own, guess, shown = (read_texture(one).copy() for one in self._made[0].textures)
        return own, guess, shown


@contextmanager
def fed(context: Context, pictures: Pictures, factor: int) -> Iterator[Fed]:
    with context.gl:
        found = Fed(context.gl, pictures, factor)
    yield found
    with context.gl:
        found.release_fed()
        found.release()


@contextmanager
def flat(context: Context, objects: Array) -> Iterator[Any]:
    """Surfaces of a plane that faces the eye, of these objects (H, W); all are within sight."""
    height, width = objects.shape
    position = np.zeros((height, width, 4), np.float32)
    position[..., 2], position[..., 3] = -1.0, 1 + objects
    facing = np.zeros_like(position)
    facing[..., 2] = 1.0
    size = width, height
    with context.gl:
        textures = [
            context.gl.texture(size, 4, one.tobytes(), dtype="f4") for one in (position, facing)
        ]
    yield SimpleNamespace(position=textures[0], normal=textures[1], size=size)
    with context.gl:
        for texture in textures:
            texture.release()
