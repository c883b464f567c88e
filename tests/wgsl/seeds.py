"""The random texture of the thesis: a 32-bit seed for each pixel, new in every frame."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

Array = np.ndarray[Any, Any]


def pcg(values: ArrayLike) -> Array:
    """`pcg_hash` in numpy, uint32 arithmetic."""
    x = np.atleast_1d(np.asarray(values, np.uint32))  # scalars would warn of the wanted overflow
    state = x * np.uint32(747796405) + np.uint32(2891336453)
    word = ((state >> ((state >> np.uint32(28)) + np.uint32(4))) ^ state) * np.uint32(277803737)
    hashed: Array = (word >> np.uint32(22)) ^ word
    return hashed


def seed_texture(width: int, height: int, sample: int, seed: int) -> Array:
    """`pixel_seed` of every pixel, (H, W) uint32."""
    x, y = np.arange(width, dtype=np.uint32), np.arange(height, dtype=np.uint32)
    frame = pcg(np.uint32(sample) + pcg(np.uint32(seed)))
    return pcg(x + pcg(y + frame)[:, None])
