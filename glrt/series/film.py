"""A film: the frames of a series, and the file that is made of them."""

import json
from bisect import insort
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from glrt.core.version import VERSION
from glrt.image.image import Image
from glrt.image.tonemap import expose_and_encode
from glrt.rendering.stopping import Interruption
from glrt.scene.animation.tracks import Animation
from glrt.scene.scenefile.toml import scene_to_dict
from glrt.series.containers import write_container
from glrt.series.lock import locked
from glrt.series.outputs import Output
from glrt.series.rendering import Frame, RenderOptions, Watch, render_frames
from glrt.series.series import Series, describe
from glrt.series.sheet import Cell, write_sheet


@dataclass
class Film:
    """A series to render, its files, and the frames that are done."""

    series: Series
    numbers: range  # frames to render
    output: Output
    options: RenderOptions
    own_fps: float | None = None
    frames: list[Frame] = field(default_factory=list)

    @property
    def fps(self) -> float:
        """Frames a second at which the film plays: given, or those of the animation."""
        return self.own_fps or (self.series.scene.animation or Animation()).fps

    @property
    def complete(self) -> list[Frame]:
        """The frames that did not fail."""
        return [frame for frame in self.frames if frame.record]

    @property
    def failed(self) -> list[Frame]:
        """The frames that failed."""
        return [frame for frame in self.frames if frame.failure]

    @property
    def missed(self) -> list[Frame]:
        """The complete frames that did not reach their error."""
        return [frame for frame in self.frames if frame.is_missed]

    @property
    def recipe(self) -> str:
        """All that makes the film, as JSON."""
        film = {
            "version": VERSION,
            "scene": scene_to_dict(self.series.scene),
            "settings": self.series.settings.model_dump(mode="json"),
            "frames": [self.numbers.start, self.numbers.stop - 1],
            "fps": self.fps,
            **describe(self.series),
        }
        return json.dumps(film, allow_nan=False)

    def locked(self) -> AbstractContextManager[None]:
        """Keep other commands from rendering frames of the same film or sheet.

        Frames with files of their own are free: several commands may share them. Raises
        `RenderError` if another command renders the film.
        """
        output = self.output
        return nullcontext() if output.kind == "frames" else locked(output.folder, output.path)

    def render(self, interruption: Interruption, watch: Watch | None = None) -> Iterator[Frame]:
        """Render the frames that are missing; yields each, as `render_frames` does."""
        rest = self.options, interruption, watch
        return self.taken(render_frames(self.series, self.numbers, self.output, *rest))

    def taken(self, frames: Iterable[Frame]) -> Iterator[Frame]:
        """Yield frames that arrive in any order, and keep them in order."""
        for frame in frames:
            insort(self.frames, frame, key=lambda other: other.number)
            yield frame

    def write(self, keeps_frames: bool) -> None:
        """Write the film or the sheet of its frames, and remove these unless they are to stay.

        Raises `RenderError` if it cannot be written: the frames then stay.
        """
        output = self.output
        if output.kind == "frames":
            return
        codes = map(self._codes, self.frames)
        if output.kind == "container":
            write_container(output.path, codes, len(self.frames), self.fps, self.recipe)
        else:
            cells = [
                Cell(c, frame.label.split(", "))
                for c, frame in zip(codes, self.frames, strict=True)
            ]
            write_sheet(output.path, cells, self.series.columns(len(cells)), self.recipe)
        if not keeps_frames:
            self._remove_frames()

    def _remove_frames(self) -> None:
        """Remove the files of the frames."""
        with suppress(OSError):
            for frame in self.frames:
                frame.file.unlink(missing_ok=True)

    def _codes(self, frame: Frame) -> NDArray[np.uint8]:
        image, settings = Image.load(frame.file), self.series.settings
        return expose_and_encode(image.shown, settings.exposure, settings.tonemap)
