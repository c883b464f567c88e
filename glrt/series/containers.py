"""Write frames as a WebP, GIF or MP4 file, with the recipe of the film."""

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import UsageError
from glrt.core.files import write_whole
from glrt.core.install import install

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

Codes = NDArray[np.uint8]

MILLISECONDS = 1000
GIF_TICK = 10  # milliseconds: a GIF counts in hundredths of a second
QUALITY = 90  # of WebP, 0 to 100
CRF = "18"  # of H.264: nearly without visible loss (x264's documentation)
PACKAGE = "av"
_BT709 = 1  # its number for matrix, primaries and transfer (ITU-T H.273)


def check_container(path: Path) -> None:
    """Raise `UsageError` if a package that writes the file is not installed."""
    if path.suffix.lower() == ".mp4":
        _library()


def write_container(path: Path, frames: Iterable[Codes], count: int, fps: float, text: str) -> None:
    """Write `count` frames of sRGB codes, (H, W, 3) uint8 each, whole or not at all.

    `text` is stored in the file. Raises `RenderError` if it cannot be written.
    """
    writers: dict[str, Callable[[Path], None]] = {
        ".webp": lambda file: _write_webp(file, frames, durations(count, fps), text),
        ".gif": lambda file: _write_gif(file, frames, durations(count, fps, GIF_TICK), text),
        ".mp4": lambda file: _write_mp4(file, frames, fps, text),
    }
    write_whole(path, writers[path.suffix.lower()])


def durations(count: int, fps: float, tick: int = 1) -> list[int]:
    """Return milliseconds of each frame, multiples of `tick`, that add up to the film's length.

    None is shorter than a tick.
    """
    ends = [round(number * MILLISECONDS / fps / tick) * tick for number in range(count + 1)]
    return [max(tick, end - start) for start, end in pairwise(ends)]


def _write_webp(path: Path, frames: Iterable[Codes], times: list[int], text: str) -> None:
    first, *rest = _pictures(frames)
    first.save(
        *(path, "WEBP"),
        save_all=True,
        append_images=rest,
        duration=times,
        loop=0,
        quality=QUALITY,
        method=4,
        xmp=text.encode(),
    )


def _write_gif(path: Path, frames: Iterable[Codes], times: list[int], text: str) -> None:
    first, *rest = (picture.quantize() for picture in _pictures(frames))
    options = {"append_images": rest, "duration": times, "loop": 0}
    first.save(path, "GIF", save_all=True, comment=text.encode(), disposal=1, **options)


def _pictures(frames: Iterable[Codes]) -> Iterator["Picture"]:
    from PIL import Image

    return (Image.fromarray(codes) for codes in frames)


def _write_mp4(path: Path, frames: Iterable[Codes], fps: float, text: str) -> None:
    av = _library()
    with av.open(str(path), "w", format="mp4", options={"movflags": "+faststart"}) as film:
        film.metadata["comment"] = text
        rate = Fraction(fps).limit_denominator(1001)
        stream = film.add_stream("libx264", rate=rate, options={"crf": CRF})
        stream.pix_fmt = "yuv420p"
        coding = stream.codec_context
        coding.colorspace = coding.color_primaries = coding.color_trc = _BT709
        for number, even in enumerate(map(_even, frames)):
            if number == 0:
                stream.height, stream.width = even.shape[:2]
            picture = av.VideoFrame.from_ndarray(even, format="rgb24")
            coded = picture.reformat(format="yuv420p", dst_colorspace=_BT709)
            film.mux(stream.encode(coded))
        film.mux(stream.encode(None))


def _even(codes: Codes) -> Codes:
    """Return the frame with an even width and height, which H.264 needs: its edge is repeated."""
    height, width = codes.shape[:2]
    return np.pad(codes, ((0, height % 2), (0, width % 2), (0, 0)), "edge")


def _library() -> Any:
    try:
        import av
    except ModuleNotFoundError:
        raise UsageError(
            f"an MP4 needs the Python package {PACKAGE}: type `{install('film')}`, or "
            "write a .webp."
        ) from None
    return av
