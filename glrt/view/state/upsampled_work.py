"""Coarse pictures of full size: some pixels are sampled, more of them while nothing moves."""

import itertools
from collections.abc import Callable

from glrt.rendering.history.lattice import FACTORS
from glrt.rendering.history.upsample import PAIR
from glrt.rendering.renderer import Renderer
from glrt.view.state.moving_picture import MovingPicture
from glrt.view.state.preview_size import LEAST, Preview

ROUNDING = 1e-6


class UpsampledWork:
    """Makes the coarse pictures of temporal upsampling within the time of a frame."""

    def __init__(self, moving: MovingPicture, preview: Preview, clock: Callable[[], float]) -> None:
        """Take over the size of pictures from `preview`."""
        self._moving, self._preview, self._clock = moving, preview, clock

    def is_due(self, renderer: Renderer | None) -> bool:
        """Whether the picture that is being made is of this kind.

        During edits whose pictures must be coarse, and afterwards until one pixel in 2 x 2 is
        sampled: then the film begins, whose first sample is the last step.
        """
        if not renderer or renderer.settings.aov or not self._moving.can_upsample(renderer):
            return False
        return self._preview.factor > 1 or self._moving.goes_finer(renderer)

    def work(self, renderer: Renderer, target: int, seconds: float, edit: float) -> None:
        """Sample a lattice in a frame of `seconds`; an edit took `edit` seconds of it.

        While nothing moves, its distances halve where that fits into the frame. `target` is the
        film's, which gets no sample.
        """
        del target
        width, height = renderer.size
        factor = factor_of(self._preview.factor)
        if not self._preview.is_under_way:
            left = max(seconds - edit, LEAST * seconds)
            factor = self._finer(width * height, left)
        times = [self._clock()]

        def note() -> None:
            renderer.context.finish()
            times.append(self._clock())

        note()  # what brings the history to this view is not of the samples
        self._moving.upsample(renderer, factor, note)
        note()
        waited, sampled, made = (after - before for before, after in itertools.pairwise(times))
        self._preview.record(sampled, PAIR * width * height / factor**2)
        self._preview.reconstructed(waited + made)

    def _finer(self, pixels: int, seconds: float) -> int:
        """The next factor of a view at rest: half of the distance reached, if that is fast enough.

        Else the distance halves in four lattices, one a frame.
        """
        half = max(self._moving.progress[1] // 2, FACTORS[0])
        takes = self._preview.seconds_of(PAIR * pixels / half**2)
        return half if takes <= seconds else self._moving.factor


def factor_of(reduced: float) -> int:
    """Pixels between sampled ones that take the time of a sample at a size reduced by a factor."""
    wanted = PAIR * reduced**2 * (1 - ROUNDING)  # pixels to a sampled one
    return next((factor for factor in FACTORS if factor**2 >= wanted), FACTORS[-1])
