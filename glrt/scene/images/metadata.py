"""PNG and JPEG files without their metadata, which must not keep pixels from being read."""

import struct
from collections.abc import Iterator

_PNG_HEAD = 8  # bytes before the first chunk
_NEEDED = (b"IHDR", b"PLTE", b"tRNS", b"IDAT", b"IEND")

_SCAN, _FIRST_APP, _LAST_APP, _COMMENT = 0xDA, 0xE0, 0xEF, 0xFE
_JFIF, _ADOBE = 0xE0, 0xEE
_SHORTEST = {_JFIF: (b"JFIF\0", 14), _ADOBE: (b"Adobe", 12)}  # how they begin, bytes


def bare_png(content: bytes) -> bytes:
    """Return a PNG file with the chunks alone that its pixels need, as far as it has chunks."""
    parts, at = [content[:_PNG_HEAD]], _PNG_HEAD
    for kind, start, end in _chunks(content):
        parts += [content[start:end]] if kind in _NEEDED else []
        at = end
    return b"".join(parts) + content[at:]


def frames_of_png(content: bytes) -> int:
    """Return the number of pictures that a PNG file shows one after another, or 1."""
    for kind, start, end in _chunks(content):
        if kind == b"acTL" and end - start == 20:
            return int.from_bytes(content[start + 8 : start + 12])
    return 1


def _chunks(content: bytes) -> Iterator[tuple[bytes, int, int]]:
    """Yield the kind of each chunk, and where it begins and ends."""
    at = _PNG_HEAD
    while at + 12 <= len(content):
        length, kind = struct.unpack_from(">I4s", content, at)
        end = at + 12 + length
        if end > len(content):
            return
        yield kind, at, end
        at = end


def bare_jpeg(content: bytes) -> bytes:
    """Return a JPEG file without comments, and with two of its notes: JFIF and Adobe.

    These say how colours are stored. Broken ones are left out too. From the first scan on, all is
    as it was.
    """
    parts, at = [content[:2]], 2
    for start, end in _segments(content):
        parts.append(content[at:start])
        if _is_kept(content, start, end):
            parts.append(content[start:end])
        at = end
    return b"".join(parts) + content[at:]


def _segments(content: bytes) -> Iterator[tuple[int, int]]:
    """Yield where segments begin, at their marker, and end; until a scan, or what is none."""
    at = 2
    while at + 4 <= len(content) and content[at] == 0xFF:
        if content[at + 1] == 0xFF:  # a byte that fills
            at += 1
            continue
        if content[at + 1] == _SCAN:
            return
        end = at + 2 + int.from_bytes(content[at + 2 : at + 4])
        if end > len(content):
            return
        yield at, end
        at = end


def _is_kept(content: bytes, start: int, end: int) -> bool:
    kind = content[start + 1]
    if kind in _SHORTEST:
        begin, least = _SHORTEST[kind]
        return content[start + 4 : end].startswith(begin) and end - start - 4 >= least
    return not (_FIRST_APP <= kind <= _LAST_APP or kind == _COMMENT)
