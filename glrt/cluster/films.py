"""Render the frames of a film that are missing by the workers of a cluster."""

import tempfile
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from glrt.cluster.crew import Crew
from glrt.core.errors import RenderError
from glrt.core.files import write_whole
from glrt.rendering.stopping import Interruption
from glrt.series.outputs import Output
from glrt.series.rendering import Frame, FrameRenderer, RenderOptions, kept_frame
from glrt.series.series import Series

Rendered = tuple[Frame, bytes]  # with the content of its file


@dataclass(frozen=True)
class FilmJob:
    """The frames of a series, as a worker renders them."""

    series: Series
    options: RenderOptions
    suffix: str  # of the files of frames

    def begin(self) -> "FilmWork":
        """Return the work, without having rendered any frame."""
        return FilmWork(self)


class FilmWork:
    """Renders frames, with one renderer from frame to frame."""

    def __init__(self, job: FilmJob) -> None:
        """Open nothing yet."""
        self._job = job
        self._renderer = FrameRenderer(job.options, Interruption())

    def do(self, number: int) -> Rendered:
        """Return a frame and the content of its file, empty if it failed; raises `GlrtError`."""
        with tempfile.TemporaryDirectory(prefix="glrt-") as folder:
            output = Output(Path(folder) / f"%d{self._job.suffix}", "frames")
            frame = self._renderer.frame(self._job.series, number, output, None)
            assert frame  # nothing interrupts it
            return frame, frame.file.read_bytes() if frame.record else b""

    def release(self) -> None:
        """Release OpenGL."""
        self._renderer.release()


def render_frames_on(
    crew: Crew, series: Series, numbers: Iterable[int], output: Output, options: RenderOptions
) -> Iterator[Frame]:
    """Yield the frames as `render_frames` does: first the kept ones, then others as they arrive.

    Their files have the bits that they have without a cluster, on the same driver. Raises
    `RenderError` if a file cannot be written or the cluster ends: the frames then stay.
    """
    missing = []
    for number in numbers:
        frame = kept_frame(series, number, output, options)
        if frame:
            yield frame
        else:
            missing.append(number)
    if not missing:
        return
    job = FilmJob(series, options, output.frame(0).suffix)
    for number, value in crew.answers(job, missing):
        file = output.frame(number)
        if isinstance(value, RenderError):
            yield Frame(number, file, failure=str(value))
            continue
        frame, content = value
        if frame.record:
            write_whole(file, _writer(content))
        yield frame._replace(file=file)


def _writer(content: bytes) -> Callable[[Path], None]:
    def write(path: Path) -> None:
        path.write_bytes(content)

    return write
