"""Pictures as files for a page: JPEG while they change, PNG when they are done."""

import io
from typing import Any

import numpy as np
from numpy.typing import NDArray

QUALITY = 88  # of JPEG: noise of a few samples hides its artefacts
JPEG, PNG = "image/jpeg", "image/png"


def encoded(codes: NDArray[np.uint8], is_last: bool) -> tuple[bytes, str]:
    """Return a picture, (H, W, 3) sRGB codes, as the bytes of a file, and its type.

    The last one is PNG, which has every bit; others are JPEG with colours at full resolution.
    """
    from PIL import Image

    file, picture = io.BytesIO(), Image.fromarray(codes)
    options: dict[str, Any] = {"compress_level": 6} if is_last else {"quality": QUALITY}
    if not is_last:
        options["subsampling"] = 0
    picture.save(file, "PNG" if is_last else "JPEG", **options)
    return file.getvalue(), PNG if is_last else JPEG
