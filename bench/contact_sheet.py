"""A contact sheet: rendered pictures in rows, small enough for a front page."""

import io
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core import files
from glrt.core.errors import RenderError, UsageError

Codes = NDArray[np.uint8]  # (H, W, 3) sRGB

FORMATS = {".jpg": "JPEG", ".jpeg": "JPEG", ".png": "PNG"}
MOST_BYTES = 300_000
WIDTH = 1200  # pixels
COLUMNS = 3  # pictures in a row
GAP = 6  # pixels between pictures
GAP_COLOR = (127, 127, 127)  # visible on light and dark pages

_JPEG = [{"quality": quality, "subsampling": 0} for quality in (92, 88, 84, 80, 76, 72, 68, 64)]
_TRIES: dict[str, list[dict[str, Any]]] = {"JPEG": _JPEG, "PNG": [{"optimize": True}]}


def save_sheet(pictures: Sequence[Path | Codes], file: Path, most_bytes: int = MOST_BYTES) -> None:
    """Write a contact sheet of pictures or files, JPEG or PNG by suffix, below `most_bytes`.

    Quality is reduced first, then width. Raises `UsageError` for another suffix, `RenderError` if
    no sheet is small enough or the file cannot be written.
    """
    encodings = _encodings(_sheet([_opened(one) for one in pictures]), _format(file))
    data = next((data for data in encodings if len(data) < most_bytes), None)
    if data is None:
        raise RenderError(
            f"Cannot write {file}: even the smallest sheet of these pictures has {most_bytes} "
            "bytes. Choose fewer pictures."
        )
    write_bytes(file, data)


def check_sheet(file: Path) -> None:
    """Raise `UsageError` if `save_sheet` could not write to `file`; creates no file."""
    _format(file)
    files.check_writable(file)


def write_bytes(file: Path, data: bytes) -> None:
    """Write a whole file, or none."""

    def write(path: Path) -> None:
        path.write_bytes(data)

    files.write_whole(file, write)


def _format(file: Path) -> str:
    try:
        return FORMATS[file.suffix.lower()]
    except KeyError:
        raise UsageError(
            f"Cannot write {file}: the name of a contact sheet ends in .jpg or .png."
        ) from None


def _opened(one: Path | Codes) -> Codes:
    from PIL import Image

    if not isinstance(one, Path):
        return one
    with Image.open(one) as picture:
        return np.asarray(picture.convert("RGB"))


def _sheet(pictures: Sequence[Codes]) -> Codes:
    """Rows of COLUMNS uncropped pictures, each row scaled to WIDTH."""
    rows = [_row(pictures[i : i + COLUMNS]) for i in range(0, len(pictures), COLUMNS)]
    gap = _blank(GAP)
    parts = [part for row in rows for part in (gap, row)]
    return np.concatenate(parts[1:])


def _row(pictures: Sequence[Codes]) -> Codes:
    aspects = [picture.shape[1] / picture.shape[0] for picture in pictures]
    room = WIDTH - GAP * (len(pictures) - 1)
    height = min(round(room / sum(aspects)), WIDTH // COLUMNS)  # an incomplete row is not enlarged
    row = _blank(height)
    left = 0.0
    for picture, aspect in zip(pictures, aspects, strict=True):
        right = min(left + height * aspect, WIDTH)
        columns = slice(round(left), round(right))
        row[:, columns] = _resized(picture, columns.stop - columns.start, height)
        left = right + GAP
    return row


def _blank(height: int) -> Codes:
    return np.full((height, WIDTH, 3), GAP_COLOR, np.uint8)


def _resized(picture: Codes, width: int, height: int) -> Codes:
    from PIL import Image

    smaller = Image.fromarray(picture).resize((width, height), Image.Resampling.LANCZOS)
    return np.asarray(smaller)


def _encodings(sheet: Codes, kind: str) -> Iterator[bytes]:
    """The sheet as encoded files, in decreasing quality."""
    for width, options in product(range(WIDTH, 0, -100), _TRIES[kind]):
        height = max(1, round(len(sheet) * width / WIDTH))
        yield _encoded(_resized(sheet, width, height), kind, options)


def _encoded(sheet: Codes, kind: str, options: dict[str, Any]) -> bytes:
    from PIL import Image

    file = io.BytesIO()
    Image.fromarray(sheet).save(file, kind, **options)
    return file.getvalue()
