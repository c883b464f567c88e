"""Render the frames of a series that are missing, with one renderer from frame to frame."""

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

from glrt.core.errors import GlrtError, RenderError, SceneError
from glrt.gpu.context import Choice, Context, Pipeline
from glrt.image.image import Image
from glrt.image.recipe import FrameLimits
from glrt.rendering.pipelines import Tier
from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Interruption, Limits, render_to_limit
from glrt.series.kept_frames import kept
from glrt.series.motion import tier_of
from glrt.series.outputs import Output
from glrt.series.series import Series, Still

Watch = Callable[[int, Limits, Renderer], None]  # called with the number of the frame
Watched = Callable[[Renderer], None]


@dataclass(frozen=True)
class RenderOptions:
    """How each frame is rendered."""

    seconds: float | None = None  # limit of a frame's render
    error: float | None = None  # error that ends a frame
    context: Context | Choice = "auto"
    pipeline: Pipeline = "auto"
    decisions: Mapping[str, str] = field(default_factory=dict)  # as in recipes

    def of(self, number: int) -> FrameLimits:
        """Return the record of a frame that keeps these limits."""
        return FrameLimits(number=number, seconds=self.seconds, error=self.error)

    def limits(self, still: Still) -> Limits:
        """Return the limits of a frame whose render begins now."""
        deadline = None if self.seconds is None else time.perf_counter() + self.seconds
        return Limits(still.settings.samples, deadline, self.error)


class Frame(NamedTuple):
    """A frame that is complete, or that failed."""

    number: int
    file: Path
    label: str = ""
    record: FrameLimits | None = None  # None: it failed
    failure: str = ""
    samples: int = 0  # of a pixel, rendered now; 0: it was kept from before, or failed
    error: float | None = None  # estimate, if it was rendered now and has one
    seconds: float = 0.0
    is_black: bool = False  # whether no light reached the camera, if it was rendered now

    @property
    def is_missed(self) -> bool:
        """Whether the frame is complete, but did not reach its error."""
        return self.record is not None and not self.record.reached


class FrameRenderer:
    """Renders one still after another; what fits the next one is kept: program, trees, film."""

    def __init__(self, options: RenderOptions, interruption: Interruption) -> None:
        """Open nothing yet."""
        self._options = options
        self._interruption = interruption
        self._renderer: Renderer | None = None
        self._tier: Tier = "generic"

    def render(self, still: Still, limits: Limits, watch: Watched | None = None) -> Image | None:
        """Return the picture of a still; None if interrupted before its limit.

        Raises the errors of `Renderer`; the next still then opens a new one.
        """
        try:
            renderer = self._renderer_of(still)
            image = render_to_limit(renderer, limits, self._interruption, watch)
        except GlrtError:
            self.release()
            raise
        return None if self._interruption.signal is not None else image

    def _renderer_of(self, still: Still) -> Renderer:
        tier = tier_of(still.scene, still.settings, still.motion)
        if self._renderer and tier == self._tier:
            self._renderer.update(still.scene, **dict(still.settings))
            self._renderer.restart()
            return self._renderer
        self.release()
        options = self._options
        self._tier = tier
        self._renderer = Renderer(
            *(still.scene, still.settings, options.context, tier, options.pipeline),
            decisions=options.decisions,
            opens_shutter=True,
        )
        return self._renderer

    def frame(
        self, series: Series, number: int, output: Output, watch: Watch | None
    ) -> Frame | None:
        """Return a frame, kept or rendered or failed; None if interrupted before its limit.

        Raises `RenderError` if its file cannot be written.
        """
        start, file, options = time.perf_counter(), output.frame(number), self._options
        try:
            if stands := kept_frame(series, number, output, options):
                return stands
            still = series.still(number)
            limits = options.limits(still)
            watched = (lambda renderer: watch(number, limits, renderer)) if watch else None
            image = self.render(still, limits, watched)
        except (SceneError, RenderError) as error:
            return Frame(number, file, failure=str(error))
        if image is None:
            return None
        record = options.of(number)
        reached = image.error_to_reach
        if options.error is not None and (reached is None or reached > options.error):
            record = record.model_copy(update={"reached": False})
        if image.recipe:
            image = replace(image, recipe=image.recipe.model_copy(update={"frame": record}))
        image.save(file)
        seconds, is_black = time.perf_counter() - start, not image.radiance.any()
        figures = image.samples, image.error, seconds, is_black
        return Frame(number, file, still.label, record, "", *figures)

    def release(self) -> None:
        """Release OpenGL."""
        if self._renderer:
            self._renderer.release()
        self._renderer = None


def kept_frame(series: Series, number: int, output: Output, options: RenderOptions) -> Frame | None:
    """Return a frame that stands, or whose values are out of range; None if it is missing."""
    file = output.frame(number)
    try:
        still = series.still(number)
    except (SceneError, RenderError) as error:
        return Frame(number, file, failure=str(error))
    record = kept(file, still, options.of(number))
    return Frame(number, file, still.label, record) if record else None


def render_frames(
    series: Series,
    numbers: Iterable[int],
    output: Output,
    options: RenderOptions,
    interruption: Interruption,
    watch: Watch | None = None,
) -> Iterator[Frame]:
    """Yield the frames: each was kept from before, is rendered and saved now, or failed.

    `watch` is called with the number of the frame and its limits after each dispatch. An
    interruption ends the series after the frames that are complete. Raises `RenderError` if a file
    cannot be written.
    """
    work = FrameRenderer(options, interruption)
    try:
        for number in numbers:
            if interruption.signal is not None:
                return
            frame = work.frame(series, number, output, watch)
            if frame is not None:
                yield frame
    finally:
        work.release()
