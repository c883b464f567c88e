"""Read channels and metadata of picture files; errors describe damage in one paragraph."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from glrt.core import files
from glrt.core.errors import UsageError
from glrt.core.text import escaped
from glrt.process.silence import silenced

MOST_PIXELS = 16384**2  # pixels of the largest frame that is read

_EXR_MAGIC = b"\x76\x2f\x31\x01"


def read_exr(path: Path, header_only: bool = False) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
    """Header and channels by name, (H, W) each; UsageError if the file cannot be read."""
    if _first_bytes(path) != _EXR_MAGIC:
        if path.suffix.lower() == ".exr":
            raise UsageError(f"{path}: not an EXR image, despite its name; give one that is.")
        why = "Only EXR files hold exact radiance: render to a name that ends in .exr."
        raise UsageError(f"{path}: not an EXR image. {why}")
    header, channels = _opened_exr(path, True, "its header is damaged")
    if not header_only:
        _check_size(header["dataWindow"], path)
        header, channels = _opened_exr(path, False, "its pixels are damaged, or it is cut off")
    return header, channels


def _opened_exr(
    path: Path, header_only: bool, damage: str
) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
    """Header and channels; UsageError says `damage`, as the library's message does not help."""
    import OpenEXR  # type: ignore[import-not-found]

    name = exr_name(path)
    try:
        with silenced():
            file = OpenEXR.File(name, separate_channels=True, header_only=header_only)
            channels = {name: channel.pixels for name, channel in file.channels().items()}
            return file.header(), channels
    except UnicodeError as error:
        raise _unreadable(path, error) from None
    except (RuntimeError, ValueError):
        advice = "Copy it or render it again."
        raise UsageError(f"{path}: cannot read this image: {damage}. {advice}") from None


def exr_name(path: Path) -> str:
    """The path of an EXR file as the library takes it: bytes in UTF-8, whatever the locale.

    Raises UsageError for a name that is not UTF-8.
    """
    try:
        return os.fsencode(path).decode()
    except UnicodeError:
        advice = "OpenEXR takes only names in UTF-8; rename the file or its folder."
        raise UsageError(f"{escaped(str(path))}: {advice}") from None


def _check_size(window: Any, path: Path) -> None:
    """Raise UsageError for a header that claims more pixels than MOST_PIXELS."""
    low, high = (np.asarray(corner, float) for corner in window)
    width, height = high - low + 1
    if width * height > MOST_PIXELS:
        raise UsageError(
            f"{path}: {width:.0f} x {height:.0f} pixels are more than glrt reads, {MOST_PIXELS:,}."
        )


def _first_bytes(path: Path) -> bytes:
    try:
        files.check_regular(path)
        with path.open("rb") as file:
            return file.read(len(_EXR_MAGIC))
    except OSError as error:
        raise _unreadable(path, error) from None


def read_png_metadata(path: Path) -> Mapping[Any, Any]:
    from PIL.PngImagePlugin import PngImageFile

    try:
        files.check_regular(path)
        with PngImageFile(path) as file:
            return file.info
    except (OSError, SyntaxError, ValueError) as error:
        raise _unreadable(path, error) from None


def check_pixels(path: Path) -> None:
    """Raise `UsageError` if the pixels of an EXR or PNG file cannot be read to their end."""
    if path.suffix.lower() == ".exr":
        read_exr(path)
        return
    from PIL.PngImagePlugin import PngImageFile

    try:
        with PngImageFile(path) as file:
            file.load()
    except (OSError, SyntaxError, ValueError) as error:
        raise _unreadable(path, error) from None


def _unreadable(path: Path, error: BaseException) -> UsageError:
    return UsageError(
        f"{path}: cannot read this image: {files.reason(error)}. Check name and file."
    )
