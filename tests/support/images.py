"""Images for tests of files, and what it means that two are the same."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.scene.scenefile.toml import parse_scene
from glrt.settings import Settings

# Zeros of both signs, denormals, the largest and values that no half float holds.
SPECIAL = [0.0, -0.0, 1e-45, -1e-40, 1.1754942e-38, 1e30, -1e30, 3.4028235e38, 1 / 3, np.inf]


def recipe(**settings: Any) -> Recipe:
    table = {
        "title": "Скляна куля — “glass”",
        "camera": {"position": [0.0, 0.0, 1.0], "look_at": [0.0, 0.0, 0.0]},
        "background": {"color": [1.0, 1.0, 1.0]},
    }
    return Recipe(
        scene=parse_scene(table, "test"),
        settings=Settings(**settings),
        samples=12,
        version="0.1.0",
        renderer="llvmpipe",
    )


def picture(rows: int = 5, columns: int = 7, **settings: Any) -> Image:
    """Log-uniform radiance with special values strewn in, and some noise."""
    draw = np.random.default_rng(1)
    radiance = np.power(10, draw.uniform(-4, 2, (rows, columns, 3))).astype(np.float32)
    stderr = (0.1 * draw.random((rows, columns, 3))).astype(np.float32)
    for values in (radiance, stderr):
        values.flat[: len(SPECIAL)] = SPECIAL[: values.size]
    stderr.flat[-1] = np.nan
    return Image(radiance, stderr, 12, recipe(**settings))


def same_bits(a: NDArray[Any], b: NDArray[Any]) -> bool:
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
