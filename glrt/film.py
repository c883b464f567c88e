"""What has been gathered: running mean and variance of each pixel, in ping-pong textures."""

from typing import Any, NamedTuple

import moderngl
import numpy as np

from glrt.errors import RenderError

Array = np.ndarray[Any, np.dtype[np.float32]]


class Exposure(NamedTuple):
    """A film read back: arrays (H, W, 3) float32, row 0 on top."""

    mean: Array
    variance: Array  # of one sample
    dropped: Array  # (H, W): samples that were not finite


class Film:
    """Two RGBA32F textures for the mean and two for the variance: one pair is read, one written."""

    def __init__(self, gl: moderngl.Context, width: int, height: int) -> None:
        """Allocate; RenderError if the driver has no room for this size."""
        self._gl = gl
        self._allocate(width, height)

    def restart(self, width: int, height: int) -> None:
        """Forget everything; with another size, allocate anew.

        The textures keep what they hold: the first dispatch ignores it.
        """
        self.samples = 0
        if self.size != (width, height):
            self.release()
            self._allocate(width, height)

    def images(self) -> dict[str, moderngl.Texture]:
        """The textures under the names of the kernel's images."""
        (source_mean, source_variance), (target_mean, target_variance) = self._pairs
        return {
            "source_mean": source_mean,
            "source_variance": source_variance,
            "target_mean": target_mean,
            "target_variance": target_variance,
        }

    def advance(self, samples: int) -> None:
        """The dispatch has written: what was target becomes source, once a frame."""
        self._gl.memory_barrier()
        self._pairs.reverse()
        self.samples += samples

    @property
    def mean(self) -> moderngl.Texture:
        """The texture that holds the picture so far."""
        return self._pairs[0][0]

    def read(self) -> Exposure:
        """Copy the film into memory."""
        if not self.samples:
            raise RenderError("the film is empty: render a sample first")
        mean, variance = (self._read(texture) for texture in self._pairs[0])
        return Exposure(mean[..., :3].copy(), variance[..., :3].copy(), mean[..., 3].copy())

    def release(self) -> None:
        """Free the textures."""
        for pair in self._pairs:
            for texture in pair:
                texture.release()

    def _allocate(self, width: int, height: int) -> None:
        self.size = (width, height)
        self.samples = 0
        self._pairs = [[self._texture() for _ in ("mean", "variance")] for _ in range(2)]

    def _texture(self) -> moderngl.Texture:
        width, height = self.size
        problem = f"no room on the driver for a film of {width} x {height} pixels; render a --crop"
        try:
            texture = self._gl.texture(self.size, 4, dtype="f4")
        except moderngl.Error as error:
            raise RenderError(f"{problem} ({error})") from error
        if (state := self._gl.error) != "GL_NO_ERROR":
            raise RenderError(f"{problem} ({state})")
        return texture

    def _read(self, texture: moderngl.Texture) -> Array:
        width, height = self.size
        return np.frombuffer(texture.read(), np.float32).reshape(height, width, 4)


def standard_error(film: Exposure, samples: int) -> Array:
    """Standard error of each pixel's mean, (H, W, 3) float32; NaN below two observations.

    Under the independent sampler an observation is a sample: s / sqrt(n) with s^2 = v n / (n - 1),
    v being the variance about the mean.
    """
    count = (samples - film.dropped)[..., None]
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.sqrt(film.variance / (count - 1))
    return np.where(count >= 2, error, np.float32(np.nan)).astype(np.float32)
