"""Texels as codes of 8 bits, as PNG files hold them."""

import io
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.scene.images.codes import decode_srgb

Codes = NDArray[np.uint8]

MOST = 255  # the largest code


def codes_of(texels: NDArray[Any], is_color: bool) -> Codes:
    """Return codes, (H, W, 4), of linear texels, in sRGB or of data; alpha is always linear.

    Values beyond 0 to 1 are cut.
    """
    values = texels.astype(np.float32).clip(0, 1)
    codes: Codes = np.rint(values * MOST).astype(np.uint8)
    if is_color:
        known = decode_srgb(np.arange(MOST + 1) / MOST).astype(np.float32)
        between = (known[1:] + known[:-1]) / 2
        codes[..., :3] = np.searchsorted(between, values[..., :3])
    return codes


def png_of(codes: Codes) -> bytes:
    """Return a PNG file of codes, (H, W), or (H, W, C) with C from 3 to 4."""
    from PIL.Image import fromarray

    file = io.BytesIO()
    fromarray(np.ascontiguousarray(codes)).save(file, "PNG")
    return file.getvalue()
