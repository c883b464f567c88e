"""The lattices of coarse pictures: which pixel of each k x k is sampled in which frame."""

from typing import NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from glrt.rendering.pass_film import Size

FACTORS = (2, 4, 8)  # pixels between sampled pixels, in width and height


def corner_of(number: int, factor: int) -> tuple[int, int]:
    """The first sampled pixel (x, y) of frame `number`, each below `factor`, a power of 2.

    Over factor^2 frames, each pixel is sampled once. The order halves the distances as soon as it
    can: after the first 4 frames, sampled pixels form a lattice of half the distance; after 16,
    of a quarter. Bits of the number, from the lowest, choose halves of cells, diagonals first.
    """
    x = y = 0
    step, number = factor, number % factor**2
    while step > 1:
        step //= 2
        number, quarter = number // 4, number % 4
        x += step * (quarter in (1, 2))
        y += step * (quarter in (1, 3))
    return x, y


class Cycle(NamedTuple):
    """Lattices that sample each pixel once, at most: each cycle of a view has its own samples."""

    number: int  # of the cycle in its view
    factor: int  # distance of sampled pixels; 0 before the first lattice
    shift: int  # number, in the order of `corner_of`, of the place that the cycle begins at
    frames: int = 0  # lattices so far

    @property
    def step(self) -> int:
        """The distance of sampled pixels in all lattices of the cycle together."""
        return self.factor >> ((self.frames.bit_length() - 1) // 2)

    @property
    def corner(self) -> tuple[int, int]:
        """The first sampled pixel (x, y) of the next lattice."""
        start, own = corner_of(self.shift, self.factor), corner_of(self.frames, self.factor)
        return (start[0] + own[0]) % self.factor, (start[1] + own[1]) % self.factor

    def followed_by(self, factor: int) -> "Cycle":
        """The cycle of the next lattice: this one, or a new one with an order of its own."""
        if self.factor in (0, factor) and self.frames < factor**2:
            return self._replace(factor=factor)
        return Cycle(self.number + 1, factor, self.shift + self.frames)


def lattice_of(size: Size, factor: int, corner: tuple[int, int]) -> NDArray[np.uint32]:
    """Numbers x + width y of the pixels that are sampled, as shaders_glsl/more.comp takes them."""
    width, height = size
    across, down = np.arange(corner[0], width, factor), np.arange(corner[1], height, factor)
    return (across[None, :] + width * down[:, None]).astype(np.uint32).ravel()


def list_of(gl: moderngl.Context, pixels: NDArray[np.uint32]) -> moderngl.Buffer:
    """The buffer of a list of pixels: their number, and the pixels."""
    return gl.buffer(np.concatenate([[np.uint32(pixels.size)], pixels]).astype("u4").tobytes())
