"""Difference of the picture from the kept one, in numbers."""

from typing import NamedTuple

import moderngl
import numpy as np

from glrt.core.text import counted
from glrt.error.estimate import relative_error
from glrt.rendering.pass_film import Array
from glrt.view.state.reference_image import ReferenceImage
from glrt.view.state.session import Session

GROWTH = 1.25  # factor of the samples after which the numbers are taken again


class Difference(NamedTuple):
    """Difference of two pictures; at the same samples and seeds it is without their noise."""

    brighter: float  # mean radiance over that of the kept one, less 1; NaN if that is black
    pixels: float  # relative RMS difference, as `relative_error` takes it
    samples: int  # of each pixel of B, the picture that is edited
    others: int  # of A, the kept one

    @property
    def told(self) -> str:
        """The difference in words: B is the picture that is edited, A the kept one."""
        how = "brighter" if self.brighter >= 0 else "darker"
        mean = f"{100 * abs(self.brighter):.3g} % {how}, in the mean,"
        samples = counted(self.samples, "sample")
        if self.others != self.samples:
            samples = f"with the noise of both: A has {self.others} samples, B {self.samples}"
        if not np.isfinite(self.brighter):
            return "A is black"
        if not self.pixels:
            return f"A and B are the same; {samples}"
        pixels = f"pixels differ by {100 * self.pixels:.3g} % (RMS)"
        return f"B is {mean} than A; {pixels}; {samples}"


class Differences:
    """The difference that was measured last."""

    def __init__(self) -> None:
        """Begin without one."""
        self.last: Difference | None = None
        self._of: object = None  # what it was taken of, except samples

    def measure(
        self,
        session: Session,
        here: moderngl.Texture,
        there: moderngl.Texture,
        kept: ReferenceImage,
    ) -> None:
        """Measure the difference of the session's picture, only now and then.

        That takes longer than drawing it.
        """
        assert session.renderer
        has_equal = kept.samples(session.renderer) == session.samples
        others = session.samples if has_equal else kept.samples_as_kept
        of = session.restarts, session.weights, kept, has_equal
        known, is_same = self.last, of == self._of
        is_near = known and known.samples <= session.samples < GROWTH * known.samples
        if not (is_same and is_near) or session.is_done:
            self.last, self._of = difference_of(here, there, session.samples, others), of

    def told(self, session: Session, kept: ReferenceImage, is_drawn: bool) -> str:
        """Return the difference in words if it is drawn, and how far A is rendered again."""
        assert session.renderer
        told, samples = self.last.told if is_drawn and self.last else "", session.samples
        others = kept.samples(session.renderer)
        if others == samples or (kept.samples_as_kept and not session.is_done):
            return told
        again = f"rendering A again: {others} of {samples} samples"
        return f"{told}; {again}" if told else again.capitalize()


def difference_of(
    here: moderngl.Texture, there: moderngl.Texture, samples: int, others: int
) -> Difference:
    """Return the difference of a picture from the kept one: RGBA32F textures of one size."""
    radiance, kept = _read(here), _read(there)
    means = (float(values.mean(dtype=np.float64)) for values in (radiance, kept))
    mean, before = means
    brighter = mean / before - 1 if before else float("nan")
    pixels = relative_error(kept, np.abs(radiance - kept)) or 0.0
    return Difference(brighter, pixels, samples, others)


def _read(texture: moderngl.Texture) -> Array:
    """Return the radiance in a texture, (H, W, 3) float32."""
    width, height = texture.size
    return np.frombuffer(texture.read(), np.float32).reshape(height, width, 4)[..., :3]
