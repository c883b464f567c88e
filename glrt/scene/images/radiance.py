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
_HDR_END = re.compile(rb"\n[ \t\r]*\n")  # an empty line, in which some programs leave a blank
_HDR_SIZE = re.compile(rb"([-+])([XY]) +(\d{1,9}) +([-+])([XY]) +(\d{1,9})\r?\n")


def decode_hdr(content: bytes, color: bool) -> Pixels:
    """Decode the Radiance picture format, after "Real Pixels" (Graphics Gems II) by Greg Ward.

    His manual is the other source. A pixel is (R, G, B) 2^(E - 136), and black for E = 0, as other
    renderers read it: what was 1 is 1. Ward's own programs add half a step to R, G and B.
    """
    end = _HDR_END.search(content)
    header, rest = (content[: end.start()], content[end.end() :]) if end else (content, b"")
    exposure = _hdr_exposure(header.decode("latin-1").split("\n"))
    size = _HDR_SIZE.match(rest)
    if not size or size[2] == size[5]:
        raise damaged("its header does not say how large it is")
    lines, length = int(size[3]), int(size[6])
    check_size(length, lines)
    with np.errstate(over="ignore"):  # infinite values are refused below
        pixels = _hdr_pixels(rest, size.end(), lines, length)
        if (exposure != 1).any():
            pixels /= exposure
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


# The factor by which a byte E multiplies the others.
_POWERS = (np.ldexp(1.0, np.arange(256) - 136) * (np.arange(256) > 0)).astype(np.float32)
_AT_ONCE = 1 << 20  # bytes of lines that are decoded together: they fit a processor's cache


def _hdr_pixels(content: bytes, at: int, lines: int, length: int) -> Pixels:
    """Return the pixels as they are stored, (lines, length, 3), from a place in the file on."""
    if len(content) - at < 4 * lines:  # a line has a pixel at least
        raise damaged(f"it has {len(content) - at:,} bytes for {lines:,} lines")
    pixels = np.empty((lines, length, 3), np.float32)
    together = max(1, _AT_ONCE // (4 * length))
    for first in range(0, lines, together):
        part = pixels[first : first + together]
        rgbe, at = _hdr_lines(content, at, (first, lines), part.shape[:2])
        scale = _POWERS[rgbe[:, 3]]
        for channel in range(3):
            np.multiply(rgbe[:, channel], scale, out=part[:, :, channel])
    return pixels


def _hdr_lines(
    content: bytes, at: int, place: tuple[int, int], shape: tuple[int, ...]
) -> tuple[Bytes, int]:
    """Return R, G, B and E of lines, (lines, 4, length), and where the next begin.

    `place` is the number of the first line, and of all lines.
    """
    count, length = shape
    found = np.empty((count, 4, length), np.uint8)
    starts, by_runs = list[int](), np.zeros(count, bool)
    for line in range(count):
        mark = content[at : at + 4]
        by_runs[line] = 8 <= length < 1 << 15 and mark[:2] == b"\2\2" and mark[2:3] < b"\x80"
        try:
            if by_runs[line]:
                if int.from_bytes(mark[2:]) != length:
                    raise damaged("a line has another length than the image is wide")
                at = _hdr_runs(content, at + 4, length, starts)
            else:
                row, at = _hdr_line_of_pixels(content, at, length)
                found[line] = np.frombuffer(row, np.uint8).reshape(length, 4).T
        except IndexError:
            raise damaged(f"it ends in line {place[0] + line} of {place[1]}") from None
    if starts:
        found[by_runs] = _unrolled(content, starts, at).reshape(-1, 4, length)
    return found, at


def _hdr_runs(content: bytes, at: int, length: int, starts: list[int]) -> int:
    """Add where the runs of a line begin, all of R, then of G, B and E; return where they end.

    A run is its count, and a byte that is repeated (128 less than the count) or so many bytes.
    """
    for _ in range(4):
        filled = 0
        while filled < length:
            count = content[at]
            starts.append(at)
            if count > 128:
                filled += count - 128
                at += 2
            else:
                filled += count
                at += 1 + count
            if count == 0:
                filled = length + 1
        if filled > length:
            raise damaged("a run passes the end of its line")
    if at > len(content):
        raise IndexError
    return at


def _unrolled(content: bytes, starts: list[int], end: int) -> Bytes:
    """Return the bytes for which runs stand that begin at `starts`, the last before `end`."""
    first = starts[0]
    stored = np.frombuffer(content, np.uint8, end - first, first)
    begin = np.array(starts, np.int64) - first
    count = stored[begin].astype(np.int64)
    advances = count <= 128
    length = np.where(advances, count, count - 128)
    before = np.cumsum(length) - length
    source = np.repeat(begin + 1 - before * advances, length)
    source += np.arange(len(source)) * np.repeat(advances, length)
    unrolled: Bytes = stored[source]
    return unrolled


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
