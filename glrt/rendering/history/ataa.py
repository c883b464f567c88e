"""Adaptive temporal antialiasing: repair pixels where an exponential mean over views fails.

Marrs et al., "Adaptive Temporal Antialiasing" (2018): a mask of failures, FXAA where the surface
was outside the view before, and more samples elsewhere.
"""

from dataclasses import replace

import moderngl

from glrt.gpu.canvas import Canvas
from glrt.gpu.glsl import Source
from glrt.gpu.program import Kernel
from glrt.rendering.history.drawn_pass import DrawnPass
from glrt.rendering.history.gbuffer import Surfaces
from glrt.rendering.history.history_filter import Fresh
from glrt.rendering.history.listed_pixels import ListedPixels
from glrt.rendering.history.reprojection import CONSTANTS, between
from glrt.rendering.history.taa import PUBLISHED, Taa
from glrt.rendering.renderer import Renderer
from glrt.settings import settings_for

OTHER_SEED = 0x5BD1E995  # changes the film's seed, so that these samples have noise of their own


class MoreSamples:
    """Traces more samples of the pixels of a mask (shaders_glsl/gather.comp)."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled or allocated before it is needed."""
        self._gl = gl
        self._listed = ListedPixels(gl)
        self._gather: Kernel | None = None

    def trace(
        self, renderer: Renderer, mask: moderngl.Texture, samples: int
    ) -> tuple[moderngl.Texture, int]:
        """Texture of radiance, a: samples, valid at the mask's pixels; and the number of those."""
        size, seed = mask.size, renderer.settings.seed ^ OTHER_SEED
        settings = settings_for(renderer.settings, seed=seed)
        plan = replace(renderer.plan, settings=settings)
        samples = min(samples, renderer.most_samples)
        self._listed.clear(size)
        pixels = self._gl.buffer(bytes(4 * (1 + size[0] * size[1])))
        try:
            self._gather = self._gather or Kernel(self._gl, Source("gather.comp"))
            self._gather.bind({"List": pixels, "mask": mask}, {})
            self._gather.run(*size)
            count = int.from_bytes(pixels.read(4), "little")
            found = self._listed.trace(renderer, plan, pixels, count, samples)
        finally:
            pixels.release()
        return found, count

    def release(self) -> None:
        """Release all OpenGL resources."""
        if self._gather:
            self._gather.release()
        self._gather = None
        self._listed.release()


SAMPLES = 8  # additional samples of a pixel where the mean fails
CHOICES = range(2, 17)  # allowed SAMPLES: as in the paper


class Ataa(Taa):
    """Temporal antialiasing with a mask of failures; masked pixels are traced once a view."""

    def __init__(self, gl: moderngl.Context, samples: int = SAMPLES) -> None:
        """Nothing is compiled or allocated before it is needed."""
        super().__init__(gl)
        self.samples = samples
        self.traced = 0  # number of pixels in this view
        self._find = DrawnPass(gl, "ataa_mask.frag", CONSTANTS)
        self._compose = DrawnPass(gl, "ataa.frag")
        self._more = MoreSamples(gl)
        self._mask, self._composed = Canvas(gl, "f4"), Canvas(gl, "f4")
        self._before: Surfaces | None = None
        self._extra: moderngl.Texture | None = None
        self._is_masked = False

    @property
    def more(self) -> int:
        """Samples of this view in addition to the film, over all pixels."""
        return self.traced * self.samples

    @property
    def mask(self) -> moderngl.Texture | None:
        """Texture of this view, a: 0 the mean over views, 1 FXAA, 2 more samples, 3 those alone."""
        return self._mask.texture if self._is_masked else None

    def arrive(self, now: Surfaces, before: Surfaces | None, is_same_light: bool) -> None:
        """Reproject the last picture, under any light: clamping and mask keep it near the film."""
        super().arrive(now, before, is_same_light)
        self._before, self._extra = before, None
        self._is_masked, self.traced = False, 0

    def show(self, now: Surfaces, fresh: Fresh) -> moderngl.Texture:
        """The picture: radiance in RGB, in a the number of samples that it stands for."""
        plain, brought = super().show(now, fresh), self._still_used(fresh)
        if not brought or not self._before:
            return plain
        if not self._is_masked:
            self._look(now, self._before, fresh, brought)
        assert self._mask.texture
        textures = {"light": fresh.light, "mean": fresh.mean, "plain": plain}
        textures |= {"mask": self._mask.texture, "more": self._extra or fresh.mean}
        own = {"has_more": self._extra is not None, "least": PUBLISHED.least}
        self._compose.draw(self._composed.sized(fresh.mean.size), textures, own)
        self._history = self._composed.texture
        assert self._history
        return self._history

    def release(self) -> None:
        """Release all OpenGL resources."""
        super().release()
        for part in (self._find, self._compose, self._more, self._mask, self._composed):
            part.release()
        self._is_masked = False

    def _look(
        self, now: Surfaces, before: Surfaces, fresh: Fresh, brought: moderngl.Texture
    ) -> None:
        """Find where the mean fails, from the first samples of the view, and trace those pixels."""
        textures, values = between(now, before)
        own = {**textures, "light": fresh.light, "brought": brought}
        self._find.draw(self._mask.sized(now.size), own, values)
        self._is_masked = True
        assert self._mask.texture
        if fresh.source:
            self._extra, self.traced = self._more.trace(
                fresh.source, self._mask.texture, self.samples
            )
