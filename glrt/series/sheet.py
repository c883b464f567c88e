"""A contact sheet: frames side by side in one picture, each with its label."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import UsageError
from glrt.core.files import write_whole
from glrt.series.series import Series

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

Codes = NDArray[np.uint8]

KEY = "glrt.film"  # name of the text in the PNG
GAP = 8  # pixels between frames
LINE = 18  # pixels of a line of text
LETTERS = 13  # pixels of a letter's height
MOST_PIXELS = 1 << 28
_PAPER, _INK = (24, 24, 26), (222, 222, 226)


class Cell(NamedTuple):
    """A frame as sRGB codes, (H, W, 3) uint8, and its label."""

    codes: Codes
    lines: Sequence[str]  # of its label


def size_of(width: int, height: int, count: int, columns: int, lines: int = 1) -> tuple[int, int]:
    """Return width and height of a sheet in pixels; `lines`: of each label."""
    rows = -(-count // columns)
    return GAP + columns * (width + GAP), GAP + rows * (height + lines * LINE + GAP)


def check_sheet(series: Series, count: int) -> None:
    """Raise `UsageError` for a sheet of more than MOST_PIXELS."""
    lines = max(1, len(series.sweeps))
    width, height = size_of(*series.settings.size, count, series.columns(count), lines)
    if width * height > MOST_PIXELS:
        raise UsageError(
            f"A sheet of {count} frames has {width:,} x {height:,} pixels, more than "
            f"{MOST_PIXELS:,}: render smaller or fewer frames."
        )


def write_sheet(path: Path, cells: Sequence[Cell], columns: int, text: str) -> None:
    """Write a PNG of frames with their labels, whole or not at all; `text` is stored in it.

    Raises `RenderError` if it cannot be written.
    """
    from PIL.PngImagePlugin import PngInfo

    metadata = PngInfo()
    metadata.add(b"sRGB", b"\x00")
    metadata.add_itxt(KEY, text)
    picture = sheet_of(cells, columns)
    write_whole(path, lambda file: picture.save(file, "PNG", pnginfo=metadata))


def sheet_of(cells: Sequence[Cell], columns: int) -> "Picture":
    """Return frames of one size in rows, from the upper left, with their labels below them."""
    from PIL import Image, ImageDraw, ImageFont

    height, width = cells[0].codes.shape[:2]
    lines = len(cells[0].lines)
    sheet = Image.new("RGB", size_of(width, height, len(cells), columns, lines), _PAPER)
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(LETTERS)
    for number, cell in enumerate(cells):
        row, column = divmod(number, columns)
        x, y = GAP + column * (width + GAP), GAP + row * (height + lines * LINE + GAP)
        sheet.paste(Image.fromarray(cell.codes), (x, y))
        for line, text in enumerate(cell.lines):
            short = fitting(text, lambda text: draw.textlength(text, font) <= width)
            draw.text((x, y + height + 2 + line * LINE), short, _INK, font)
    return sheet


def fitting(text: str, fits: Callable[[str], bool]) -> str:
    """Return a label that fits: its words are shortened first, and its numbers last."""
    words = text.split(" ")
    for place, word in enumerate(words):
        if _is_number(word):
            continue
        for letters in range(len(word), -1, -1):
            words[place] = word[:letters] + "…" * (0 < letters < len(word))
            if fits(short := " ".join(filter(None, words))):
                return short
    short = " ".join(filter(None, words))
    while short and not fits(short):
        short = f"{short[:-2]}…" if len(short) > 1 else ""
    return short


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
