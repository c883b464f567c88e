"""Read images of linear float values, OpenEXR here, and check what all images are held to."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import RenderError
from glrt.core.files import reason
from glrt.core.text import shortened
from glrt.process.silence import silenced

Pixels = NDArray[np.float32]
Bytes = NDArray[np.uint8]

MOST_PIXELS = 16384**2
_MOST_CHANNELS = 16  # of an OpenEXR file with MOST_PIXELS: all channels are read

# x and y of red, green, blue and white in linear sRGB: Rec. 709 and D65.
_REC_709 = (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)
_SAME = 0.005  # largest difference between roundings of these primaries
_FAINT = 1e-3  # share of all light that negative colours may have


class RefusedImageError(Exception):
    """An image is not read; the message follows "this image" and says why, and what to do."""


def damaged(problem: str) -> RefusedImageError:
    """Return the error for a file that breaks the rules of its format."""
    return RefusedImageError(f"is damaged: {shortened(problem)}. Copy or export it again")


def check_size(width: float, height: float) -> None:
    """Raise RefusedImageError for an image without pixels, or with more than MOST_PIXELS."""
    if min(width, height) < 1:
        raise damaged("it has no pixels")
    if width * height > MOST_PIXELS:
        raise RefusedImageError(
            f"has {width:.0f} x {height:.0f} pixels, more than glrt reads, {MOST_PIXELS:,}. "
            "Make it smaller"
        )


@contextmanager
def reading() -> Iterator[None]:
    """Turn the dozen kinds of errors that libraries raise for a damaged file into a refusal."""
    try:
        yield
    except (RefusedImageError, MemoryError):
        raise
    except Exception as error:
        raise damaged(reason(error)) from None


def checked(pixels: Pixels, channels: str, color: bool) -> Pixels:
    """Return the pixels; raises RefusedImageError for NaN, infinite values, and negative colours.

    Colours that are negative by next to nothing, as filters leave them, become 0.
    """
    if color and pixels.min() >= 0 and pixels.max() < np.inf:  # NaN is in both
        return pixels
    wrong = ~np.isfinite(pixels)
    if color and not wrong.any():
        negative = np.minimum(pixels, 0)
        if -negative.sum(dtype=np.float64) <= _FAINT * pixels.sum(dtype=np.float64):
            return pixels - negative if negative.any() else pixels
    if color:
        wrong |= pixels < 0
    if not wrong.any():
        return pixels
    count, row, column, channel = _first(wrong)
    kind = "negative or not finite" if color else "not finite"
    raise RefusedImageError(
        f"has values that are {kind}, {count:,} of them: the first is "
        f"{pixels[row, column, channel]:g}, in row {row} and column {column} of "
        f"{channels[channel]}, counted from 0 at the top left. Repair the image"
    )


def _first(wrong: NDArray[np.bool_]) -> tuple[int, ...]:
    """Return how many are true, and the indices of the first."""
    return int(wrong.sum()), *map(int, np.unravel_index(wrong.argmax(), wrong.shape))


def decode_exr(content: bytes, color: bool) -> Pixels:
    """Decode one flat image with channels R, G, B or Y, with A or without, in half or float.

    Other channels are left out. The data window must be the display window, and the primaries of a
    colour must be those of Rec. 709. Raises `RenderError` if there is no room for a copy of the
    file: OpenEXR reads from memory only since 3.5.
    """
    try:
        with TemporaryDirectory(prefix="glrt-") as folder:
            path = Path(folder) / "image.exr"
            path.write_bytes(content)
            with reading():
                return _read_exr(str(path), color)
    except OSError as error:
        raise RenderError(
            f"Cannot copy an OpenEXR image into a temporary folder: {reason(error)}. Free some "
            "space, or set TMPDIR to a folder with room."
        ) from error


def _read_exr(path: str, color: bool) -> Pixels:
    header = _opened_exr(path, header_only=True).header()
    _check_exr_windows(header)
    if color:
        _check_exr_primaries(header)
    names = _exr_channels(header["channels"])
    channels = _opened_exr(path).channels()
    planes = [channels[name].pixels for name in names]
    if not {plane.dtype for plane in planes} <= {np.dtype(np.half), np.dtype(np.single)}:
        raise RefusedImageError("has channels of whole numbers. Save it in half or float")
    return checked(np.stack(planes, axis=-1).astype(np.float32), names, color)


def _opened_exr(path: str, header_only: bool = False) -> Any:
    import OpenEXR  # type: ignore[import-not-found]

    with silenced():
        file = OpenEXR.File(path, separate_channels=True, header_only=header_only)
    if not file.parts:  # since 3.5, if pixels cannot be decoded
        raise damaged("its pixels cannot be decoded")
    if len(file.parts) > 1:
        raise RefusedImageError(f"has {len(file.parts)} parts. Save one of them")
    if file.header()["type"] not in (OpenEXR.scanlineimage, OpenEXR.tiledimage):
        raise RefusedImageError("is deep. Flatten it to one value a pixel and channel")
    return file


def _check_exr_windows(header: Mapping[str, Any]) -> None:
    low, high = (np.asarray(corner, float) for corner in header["dataWindow"])
    width, height = high - low + 1
    check_size(width, height)
    if width * height * len(header["channels"]) > _MOST_CHANNELS * MOST_PIXELS:
        raise RefusedImageError(
            f"has {len(header['channels'])} channels of {width:.0f} x {height:.0f} pixels, more "
            "than glrt reads. Save R, G and B alone"
        )
    if not np.array_equal([low, high], header["displayWindow"]):
        raise RefusedImageError(
            "is a part of a larger picture, or larger than it: its data window is not its display "
            "window. Save it whole, without a border"
        )


def _check_exr_primaries(header: Mapping[str, Any]) -> None:
    primaries = header.get("chromaticities", _REC_709)
    if not np.allclose(primaries, _REC_709, rtol=0, atol=_SAME):
        red = ", ".join(f"{value:.3g}" for value in primaries[:2])
        raise RefusedImageError(
            f"has other primaries than linear sRGB, with red at ({red}) and not (0.64, 0.33). "
            "Convert it to linear sRGB (Rec. 709)"
        )


def _exr_channels(channels: list[Any]) -> str:
    """Return the channels to read, a letter each; raises if they hold no image."""
    samplings = {channel.name: (channel.xSampling, channel.ySampling) for channel in channels}
    for names in ("RGBA", "RGB", "YA", "Y"):
        if not all(name in samplings for name in names):
            continue
        if "RY" in samplings or {samplings[name] for name in names} != {(1, 1)}:
            raise RefusedImageError("has channels of luminance and chroma. Save it as R, G and B")
        return names
    found = ", ".join(sorted(shortened(name) for name in samplings)[:12])
    raise RefusedImageError(
        f"needs channels R, G and B, or Y; has {found or 'none'}. Save it with one of these"
    )
