"""Temporal upsampling: the full picture from coarse ones, whose sampled pixels differ by frame.

In the spirit of FSR 2 (AMD, 2022), with weights for noisy samples: shaders_glsl/upsample.frag.
"""

from collections.abc import Callable

import moderngl

from glrt.gpu.canvas import Canvas
from glrt.rendering.history.drawn_pass import DrawnPass
from glrt.rendering.history.gbuffer import Surfaces
from glrt.rendering.history.history_filter import Fresh
from glrt.rendering.history.lattice import Cycle, lattice_of, list_of
from glrt.rendering.history.listed_pixels import ListedPixels
from glrt.rendering.history.reproject import OTHER_LIGHT, Reproject
from glrt.rendering.history.reprojection import Limits, Reprojection
from glrt.rendering.renderer import Renderer

FACTOR = 4  # pixels between sampled pixels, in width and height
OF_OWN = Limits(most_at_lamps=2.0)
OF_GUESSES = Limits(most_at_edges=16.0, most_at_lamps=16.0)  # few samples are of these places
PAIR = 2  # samples of a sampled pixel: their difference is its noise


class Upsample(Reproject):
    """Reconstructs coarse pictures; a film at full size is blended with them as by `reproject`.

    Two histories follow the surfaces: means of a pixel's own samples, and means of pixels around.
    """

    def __init__(self, gl: moderngl.Context, factor: int = FACTOR) -> None:
        """Nothing is compiled or allocated before it is needed."""
        super().__init__(gl)
        self.factor = factor  # distance of sampled pixels where no other is asked for
        self.frames = 0  # coarse pictures of this view
        self.step = 0  # distance of sampled pixels that the view has reached; 0 before the first
        self._gl = gl
        self._pass = DrawnPass(gl, "upsample.frag")
        self._made = [Canvas(gl, "f4", 3), Canvas(gl, "f4", 3)]  # own samples, around, shown
        self._own_reprojection = Reprojection(gl, OF_OWN)
        self._pair = ListedPixels(gl), ListedPixels(gl)
        self._known: list[moderngl.Texture | None] = [None, None]
        self._is_moved = self._is_other_light = False
        self._shift = 0  # coarse pictures so far: they shift the order of pixels
        self._cycle = Cycle(0, 0, 0)

    @property
    def coarse(self) -> moderngl.Texture | None:
        """The reconstructed picture of this view: radiance, a: samples; None without one."""
        return self._made[0].textures[2] if self.frames else None

    @property
    def last_factor(self) -> int:
        """Distance of the pixels that the newest picture of the view sampled."""
        return self._cycle.factor or self.factor

    def arrive(self, now: Surfaces, before: Surfaces | None, is_same_light: bool) -> None:
        """Reproject the history to the new view; own samples under other light are dropped."""
        own, around = self._known
        self._known = [None, None]
        if before and around:
            limits = None if is_same_light else OTHER_LIGHT
            self._known[1] = self._reprojection.bring(now, before, around, limits or OF_GUESSES)
            if own and is_same_light:
                self._known[0] = self._own_reprojection.bring(now, before, own)
        self._brought = self._history = self._known[1]
        self.frames = self.step = 0
        self._cycle = Cycle(0, 0, self._shift)
        self._is_moved, self._is_other_light = True, not is_same_light

    def show(self, now: Surfaces, fresh: Fresh) -> moderngl.Texture:
        """The film blended with what was shown, which becomes both histories."""
        found = super().show(now, fresh)
        self._known = [found, found]
        return found

    def trace(
        self,
        renderer: Renderer,
        now: Surfaces,
        factor: int | None = None,
        sampled: Callable[[], None] = lambda: None,
    ) -> moderngl.Texture:
        """Sample the next lattice of the view, and return the picture as `coarse` does.

        `sampled` is called when the samples are there, before the picture is made. Only for
        pictures that are the kernel's sum of paths. Raises RenderError.
        """
        size, k = now.size, factor or self.factor
        self._cycle = self._cycle.followed_by(k)
        corner = self._cycle.corner
        first = self._samples_of(renderer, size, corner)
        sampled()
        textures = {"position": now.position, "normal": now.normal}
        textures |= dict(zip(("first", "second"), first, strict=True))
        for name, known in zip(("known_own", "known_guess"), self._known, strict=True):
            textures[name] = known or now.position
        values = {
            "has_own": self._known[0] is not None,
            "has_guess": self._known[1] is not None,
            "is_moved": self._is_moved,
            "is_other_light": self._is_other_light,
            "factor": k,
            "corner": corner,
        }
        self._made.reverse()
        self._pass.draw(self._made[0].sized(size), textures, values)
        self._known = [*self._made[0].textures[:2]]
        self._is_moved = self._is_other_light = False
        self.frames, self._shift = self.frames + 1, self._shift + 1
        self._cycle = self._cycle._replace(frames=self._cycle.frames + 1)
        self.step = min(self.step or k, self._cycle.step)
        picture = self._made[0].textures[2]
        self._brought = self._history = picture
        return picture

    def forget(self) -> None:
        """Drop all history, and the coarse pictures of this view."""
        self._known, self.frames, self.step = [None, None], 0, 0
        self._brought = self._history = None

    def release(self) -> None:
        """Release all OpenGL resources."""
        super().release()
        for canvas in self._made:
            canvas.release()
        for part in (self._pass, self._own_reprojection, *self._pair):
            part.release()
        self.forget()

    def _samples_of(
        self, renderer: Renderer, size: tuple[int, int], corner: tuple[int, int]
    ) -> list[moderngl.Texture]:
        """The two samples of each pixel of a lattice, with the numbers and bits of a film's."""
        pixels = lattice_of(size, self._cycle.factor, corner)
        listed = list_of(self._gl, pixels)
        found = []
        try:
            for number, one in enumerate(self._pair):
                one.next_sample = PAIR * self._cycle.number + number
                one.clear(size)
                found.append(one.trace(renderer, renderer.plan, listed, pixels.size, 1))
        finally:
            listed.release()
        return found
