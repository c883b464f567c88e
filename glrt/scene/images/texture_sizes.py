"""Make images smaller if the images of a scene are too large together."""

from collections.abc import Sequence

import numpy as np

from glrt.scene.files.named_images import Texels

MOST_TEXELS = 1 << 26  # texels of all images, 8 bytes each
Size = tuple[int, int]  # height and width


def sizes_of(sizes: Sequence[Size]) -> list[Size]:
    """Return the sizes that images get: the largest is halved until there is room for all."""
    found = list(sizes)
    while sum(height * width for height, width in found) > MOST_TEXELS:
        largest = max(range(len(found)), key=lambda number: found[number][0] * found[number][1])
        height, width = found[largest]
        found[largest] = (max(height // 2, 1), max(width // 2, 1))
    return found


def reduced(texels: Texels, size: Size) -> Texels:
    """Return texels, (H, W, 4), halved to this size by means of two by two texels."""
    while texels.shape[:2] != size:
        height, width = (max(length // 2, 1) for length in texels.shape[:2])
        rows = texels[: 2 * height].reshape(height, -1, *texels.shape[1:])
        across = rows.astype(np.float32).mean(axis=1)[:, : 2 * width]
        texels = across.reshape(height, width, -1, 4).mean(axis=2).astype(np.float16)
    return texels
