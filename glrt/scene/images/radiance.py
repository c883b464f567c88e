"""Read Radiance pictures, .hdr."""

import re

import numpy as np
from numpy.typing import NDArray

from glrt.core.text import shortened
from glrt.scene.images.float_images import (
    Bytes,
    Pixels,
    RefusedImageError,
    check_size,
    checked,
    damaged,
)

_DARKEST = 1e-30  # least exposure: its inverse is a float32 number too
_HDR_SIZE = re.compile(rb"([-+])([XY]) +(\d{1,9}) +([-+])([XY]) +(\d{1,9})\r?\n")


def decode_hdr(content: bytes, color: bool) -> Pixels:
    """Decode the Radiance picture format, after "Real Pixels" (Graphics Gems II) by Greg Ward.

    His manual is the other source. A pixel is (R, G, B) 2^(E - 136), and black for E = 0, as other
    renderers read it: what was 1 is 1. Ward's own programs add half a step to R, G and B.
    """
    header, _, rest = content.partition(b"\n\n")
    exposure = _hdr_exposure(header.decode("latin-1").split("\n"))
    size = _HDR_SIZE.match(rest)
    if not size or size[2] == size[5]:
        raise damaged("its header does not say how large it is")
    lines, length = int(size[3]), int(size[6])
    check_size(length, lines)
    rgbe = _hdr_pixels(rest, size.end(), lines, length)
    with np.errstate(over="ignore"):  # infinite values are refused below
        powers = np.ldexp(1.0, np.arange(256) - 136) * (np.arange(256) > 0)
        pixels = rgbe[:, :, :3] * powers.astype(np.float32)[rgbe[:, :, 3:]] / exposure
    return checked(_hdr_upright(pixels, size), "RGB", color)


def _hdr_upright(pixels: Pixels, size: re.Match[bytes]) -> Pixels:
    """Return pixels with row 0 on top and column 0 on the left; the header gives their order."""
    by_rows = size[2] == b"Y"
    upright = pixels if by_rows else pixels.swapaxes(0, 1)
    up, right = (size[1], size[4]) if by_rows else (size[4], size[1])
    upright = upright[::-1] if up == b"+" else upright
    return np.ascontiguousarray(upright[:, ::-1] if right == b"-" else upright)


def _hdr_exposure(lines: list[str]) -> NDArray[np.float32]:
    """Return the factors of R, G and B in the pixels; raises for pixels that are no RGBE.

    A factor that no pixel can be divided by says nothing: FreeImage has written `EXPOSURE=0`.
    """
    exposure = np.ones(3)
    for name, _, value in (line.partition("=") for line in lines):
        if name == "FORMAT" and value.strip() != "32-bit_rle_rgbe":
            raise RefusedImageError(
                f"has pixels in {shortened(value.strip())}, not in RGBE. Convert it to RGBE"
            )
        if name in ("EXPOSURE", "COLORCORR"):
            with np.errstate(over="ignore", invalid="ignore"):
                changed = exposure * _exposure(value)
            if ((changed > _DARKEST) & (changed < 1 / _DARKEST)).all():
                exposure = changed
    return exposure.astype(np.float32)


def _exposure(text: str) -> NDArray[np.float64]:
    """Return one number, or three; NaN for any other text."""
    try:
        numbers = np.array([float(word) for word in text.split()])
    except ValueError:
        numbers = np.empty(0)
    return numbers if len(numbers) in (1, 3) else np.full(1, np.nan)


def _hdr_pixels(content: bytes, at: int, lines: int, length: int) -> Bytes:
    rows = []
    for number in range(lines):
        try:
            row, at = _hdr_line(content, at, length)
        except IndexError:
            raise damaged(f"it ends in line {number} of {lines}") from None
        rows.append(row)
    return np.stack(rows)


def _hdr_line(content: bytes, at: int, length: int) -> tuple[Bytes, int]:
    """Return pixels, (length, 4), and where the next begin; IndexError where the file ends."""
    mark = content[at : at + 4]
    if not (8 <= length < 1 << 15 and mark[:2] == b"\2\2" and mark[2:3] < b"\x80"):
        row, at = _hdr_line_of_pixels(content, at, length)
        return np.frombuffer(row, np.uint8).reshape(length, 4), at
    if int.from_bytes(mark[2:]) != length:
        raise damaged("a line has another length than the image is wide")
    row, at = _hdr_line_of_runs(content, at + 4, length)
    return np.frombuffer(row, np.uint8).reshape(4, length).T, at


def _hdr_line_of_runs(content: bytes, at: int, length: int) -> tuple[bytes, int]:
    """Decode all R, then all G, B and E; each as runs of a repeated byte, or of different ones."""
    row = bytearray()
    for end in range(length, 4 * length + 1, length):
        while len(row) < end:
            count = content[at]
            if count > 128:
                row += content[at + 1 : at + 2] * (count - 128)
                at += 2
            else:
                row += content[at + 1 : at + 1 + count]
                at += 1 + count
            if count == 0 or len(row) > end:
                raise damaged("a run passes the end of its line")
    return bytes(row), at


def _hdr_line_of_pixels(content: bytes, at: int, length: int) -> tuple[bytes, int]:
    """Decode pixels one by one; (1, 1, 1, n) repeats the last n times, the next one 256 n times."""
    row, digit = bytearray(content[at : at + 4 * length]), 0
    if b"\1\1\1" not in row and len(row) == 4 * length:
        return bytes(row), at + len(row)
    row.clear()
    while len(row) < 4 * length:
        pixel = content[at : at + 4]
        at += 4
        if len(pixel) < 4:
            raise IndexError
        if pixel[:3] != b"\1\1\1":
            row += pixel
            digit = 0
            continue
        count = pixel[3] << digit
        digit += 8
        if not row or count > length - len(row) // 4:
            raise damaged("a run passes the end of its line")
        row += row[-4:] * count
    return bytes(row), at
