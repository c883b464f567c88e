"""Codes of images, as PNG and JPEG files hold them, as linear values."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Codes = NDArray[Any]  # uint8 or uint16, (H, W, C)
Texels = NDArray[np.float16]

_AT_ONCE = 1 << 18  # codes that are decoded together: they fit a processor's cache
_PAIRS = 1 << 16  # of two codes of 8 bits


def decode_srgb(code: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return linear values, 0..1, of sRGB codes, 0..1: IEC 61966-2-1, piecewise."""
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def linear(codes: Codes, color: bool) -> NDArray[np.float32]:
    """Return the values of codes, (H, W, C), C from 1 to 4; the last of 2 or 4 is alpha.

    `color` says that they are colours in sRGB; else the largest code is 1. Alpha is always linear.
    """
    table, scaled = _tables(codes, color)
    pixels = np.empty(codes.shape, np.float32)
    for row, stored in zip(pixels, codes, strict=True):  # a row at a time: indices take 8 bytes
        row[:] = table[stored]
        if codes.shape[2] in (2, 4):
            row[:, -1] = scaled[stored[:, -1]]
    return pixels


def halves(codes: Codes, color: bool) -> Texels:
    """Return texels, (H, W, 4), of codes in uint8: values as by `linear`, rounded.

    Grey stands for R, G and B, and alpha is 1 where there is none. Two codes are looked up at once:
    R with G, and B with alpha.
    """
    height, width, channels = codes.shape
    table, scaled = (values.astype(np.float16) for values in _tables(codes, color))
    first, second = np.arange(_PAIRS, dtype=np.uint16).view(np.uint8).reshape(-1, 2).T
    pairs = np.empty((2, _PAIRS, 2), np.float16)
    pairs[..., 0] = table[first]
    pairs[0, :, 1], pairs[1, :, 1] = table[second], scaled[second]
    looked_up = pairs.view(np.uint32).ravel()
    texels = np.empty((height, width, 4), np.float16)
    found = texels.view(np.uint32)  # (H, W, 2)
    together = max(1, _AT_ONCE // (4 * width))
    rows = np.full((together, width, 4), 255, np.uint8)
    places = np.empty((together, width, 2), np.intp)
    for start in range(0, height, together):
        part = codes[start : start + together]
        size = len(part)
        rows[:size, :, :3] = part[..., :3] if channels > 2 else part[..., :1]
        if channels in (2, 4):
            rows[:size, :, 3] = part[..., -1]
        places[...] = rows.view(np.uint16)
        places[..., 1] += _PAIRS
        np.take(looked_up, places[:size], out=found[start : start + size], mode="clip")
    return texels


def _tables(codes: Codes, color: bool) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return the value of each code, and that of each code of alpha."""
    most = np.iinfo(codes.dtype).max
    scaled = np.arange(most + 1) / most
    values = decode_srgb(scaled) if color else scaled
    return values.astype(np.float32), scaled.astype(np.float32)
