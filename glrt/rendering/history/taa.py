"""Temporal antialiasing: an exponential mean over views, where the surface was seen before.

Yang, Liu, Salvi, "A Survey of Temporal Antialiasing Techniques" (2020). Samples already lie at
random places in their pixels, so the film needs no other jitter and keeps its bits.
"""

from typing import NamedTuple

import moderngl

from glrt.gpu.canvas import Canvas
from glrt.rendering.history.drawn_pass import DrawnPass
from glrt.rendering.history.gbuffer import Surfaces
from glrt.rendering.history.history_filter import Fresh
from glrt.rendering.history.reprojection import Limits, Reprojection

ANY = -1.0  # history is not clamped
UNLIMITED = Limits(1e6, 1e6, 1e6)  # instead, the least share of a new sample limits history


class TaaOptions(NamedTuple):
    """Options of the exponential mean; the defaults are those of the survey."""

    least: float = 0.1  # share of a new sample, at least; the n-th sample has 1 / n if that is more
    reach: float = 1.0  # history is kept within so many deviations of the neighbourhood's mean


PUBLISHED = TaaOptions()


class Taa:
    """The film blended with the previous view; each sample counts as a frame."""

    def __init__(self, gl: moderngl.Context, options: TaaOptions = PUBLISHED) -> None:
        """Nothing is compiled or allocated before it is needed."""
        self._reprojection = Reprojection(gl, UNLIMITED)
        self._pass = DrawnPass(gl, "taa.frag")
        self._canvas = Canvas(gl, "f4")
        self._options = options
        self._history: moderngl.Texture | None = None  # the newest of this view
        self._brought: moderngl.Texture | None = None

    def arrive(self, now: Surfaces, before: Surfaces | None, is_same_light: bool) -> None:
        """Reproject the last picture, under any light: clamping keeps it near the film."""
        del is_same_light
        self._brought = None
        if before and self._history:
            self._brought = self._reprojection.bring(now, before, self._history)
        self._history = self._brought

    def show(self, now: Surfaces, fresh: Fresh) -> moderngl.Texture:
        """The picture: radiance in RGB, in a the number of samples that it stands for."""
        del now
        brought = self._still_used(fresh)
        textures = {"light": fresh.light, "mean": fresh.mean, "brought": brought or fresh.mean}
        values = {"has_history": brought is not None, **self._options._asdict()}
        self._pass.draw(self._canvas.sized(fresh.mean.size), textures, values)
        self._history = self._canvas.texture
        assert self._history
        return self._history

    def _still_used(self, fresh: Fresh) -> moderngl.Texture | None:
        return self._brought if fresh.samples < fresh.end else None

    def release(self) -> None:
        """Release all OpenGL resources."""
        for part in (self._reprojection, self._pass, self._canvas):
            part.release()
