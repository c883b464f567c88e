"""Difference of the picture from the kept one, in numbers."""

from typing import NamedTuple

import moderngl
import numpy as np

from glrt.core.text import counted
from glrt.error.estimate import relative_error
from glrt.rendering.pass_film import Array

GROWTH = 1.25  # factor of the samples after which the numbers are taken again


class Difference(NamedTuple):
    """Difference of two pictures with the same samples of each pixel, at equal seeds."""

    brighter: float  # mean radiance over that of the kept one, less 1; NaN if that is black
    pixels: float  # relative RMS difference, as `relative_error` takes it
    samples: int

    @property
    def told(self) -> str:
        """The difference in words: B is the picture that is edited, A the kept one."""
        how = "brighter" if self.brighter >= 0 else "darker"
        mean = f"{100 * abs(self.brighter):.3g} % {how}, in the mean,"
        samples = counted(self.samples, "sample")
        if not np.isfinite(self.brighter):
            return "A is black"
        if not self.pixels:
            return f"A and B are the same; {samples}"
        pixels = f"pixels differ by {100 * self.pixels:.3g} % (RMS)"
        return f"B is {mean} than A; {pixels}; {samples}"


def difference_of(here: moderngl.Texture, there: moderngl.Texture, samples: int) -> Difference:
    """Return the difference of a picture from the kept one: RGBA32F textures of one size."""
    radiance, kept = _read(here), _read(there)
    means = (float(values.mean(dtype=np.float64)) for values in (radiance, kept))
    mean, before = means
    brighter = mean / before - 1 if before else float("nan")
    return Difference(brighter, relative_error(kept, np.abs(radiance - kept)) or 0.0, samples)


def _read(texture: moderngl.Texture) -> Array:
    """Return the radiance in a texture, (H, W, 3) float32."""
    width, height = texture.size
    return np.frombuffer(texture.read(), np.float32).reshape(height, width, 4)[..., :3]
