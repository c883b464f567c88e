"""Image files as bytes, written by hand where a library would choose what they hold."""

import io
import struct
import tempfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR  # type: ignore[import-not-found]
import pytest
from numpy.typing import NDArray

from glrt.core.errors import SceneError
from glrt.scene.images.image_files import decode_image

WHERE = "room.toml: background.image: sky.png"
GREY, COLOR, PALETTE, GREY_ALPHA, COLOR_ALPHA = 0, 2, 3, 4, 6  # kinds of PNG

Codes = NDArray[Any]
Bytes = NDArray[np.uint8]


def refusal(content: bytes, color: bool = True) -> str:
    """The message that refuses an image, after the place: one printable paragraph."""
    with pytest.raises(SceneError) as caught:
        decode_image(content, WHERE, color)
    message = str(caught.value)
    assert message.startswith(f"{WHERE}: this image ")
    assert message.isprintable()
    assert message.endswith(".")
    return message.removeprefix(f"{WHERE}: this image ")


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(codes: Codes, kind: int, extra: bytes = b"", adam7: bool = False) -> bytes:
    """A PNG file of codes (H, W, C) in uint8 or uint16; unfiltered."""
    passes = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2)]
    passes = [*passes, (0, 1, 1, 2)] if adam7 else [(0, 0, 1, 1)]
    parts = [codes[y::down, x::right] for x, y, right, down in passes]
    big_endian = [part.astype(codes.dtype.newbyteorder(">")) for part in parts if part.size]
    rows = b"".join(b"\0" + row.tobytes() for part in big_endian for row in part)
    return raw_png(codes.shape[1], codes.shape[0], 8 * codes.itemsize, kind, rows, extra, adam7)


def raw_png(
    width: int, height: int, depth: int, kind: int, rows: bytes, extra: bytes = b"", adam7: int = 0
) -> bytes:
    header = struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, adam7)
    body = extra + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + body


def saved(image: Any, kind: str, **options: Any) -> bytes:
    file = io.BytesIO()
    image.save(file, kind, **options)
    return file.getvalue()


def hdr(size: str, data: bytes, *lines: str) -> bytes:
    header = ["#?RADIANCE", "# by hand", "FORMAT=32-bit_rle_rgbe", *lines, "", size]
    return "\n".join(header).encode() + b"\n" + data


def flat_hdr(rgbe: Bytes, *lines: str) -> bytes:
    return hdr(f"-Y {rgbe.shape[0]} +X {rgbe.shape[1]}", rgbe.tobytes(), *lines)


def rle_hdr(rgbe: Bytes) -> bytes:
    """Runs of each channel of each line."""
    height, width = rgbe.shape[:2]
    start = b"\2\2" + width.to_bytes(2)
    data = b"".join(start + b"".join(map(runs, row.T)) for row in rgbe)
    return hdr(f"-Y {height} +X {width}", data)


def runs(values: Bytes) -> bytes:
    """Repeated bytes as a run from 3 on; others as they are, at most 128 together."""
    data, plain = b"", b""
    at = 0
    while at < len(values):
        same = values[at:] == values[at]
        count = min(127, len(same) if same.all() else int(np.argmin(same)))
        if count < 3:
            count, plain = 1, plain + values[at : at + 1].tobytes()
        if plain and (count > 1 or len(plain) == 128 or at + count == len(values)):
            data, plain = data + bytes([len(plain)]) + plain, b""
        if count > 1:
            data += bytes([128 + count, values[at]])
        at += count
    return data


def exr(channels: dict[str, Codes], **header: Any) -> bytes:
    return exr_of_parts([OpenEXR.Part(header, dict(channels), "part")])


def exr_of_parts(parts: list[Any]) -> bytes:
    return exr_written(lambda path: OpenEXR.File(parts).write(path))


def exr_written(write: Callable[[str], object]) -> bytes:
    """OpenEXR writes into memory only since 3.5."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.exr"
        write(str(path))
        return path.read_bytes()
