"""Images of the sky for tests: files, scenes that hold one, and what float64 says of directions."""

from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR  # type: ignore[import-not-found]

from glrt.scene.files.named_images import ImageFile, Pixels
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, glass, scene_of
from tests.support.numerics import Array


def write_exr(path: Path, pixels: Array) -> None:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": np.ascontiguousarray(pixels, np.float32)}).write(str(path))


def spot(column: int, row: int, width: int = 16, height: int = 8, radiance: float = 1.0) -> Pixels:
    """A black sky with one bright pixel."""
    pixels = np.zeros((height, width, 3), np.float32)
    pixels[row, column] = radiance
    return pixels


def random_sky(width: int, height: int, seed: int = 1) -> Pixels:
    return np.random.default_rng(seed).random((height, width, 3), np.float32)


def under(pixels: Pixels, *objects: dict[str, Any], **background: Any) -> Scene:
    """Matte things under an image of the sky that needs no file."""
    mirror = {"type": "metal", "color": [1, 1, 1]}
    materials = {"m": MATTE, "mirror": mirror, "glass": glass(), **background.pop("materials", {})}
    camera = background.pop("camera", {})
    sun = {"sun": background.pop("sun")} if "sun" in background else {}
    sky = {"image": "sky.exr", **background}
    scene = scene_of(list(objects), materials, camera, background=sky, **sun)
    read = ImageFile(file="sky.exr").read_as(f"{pixels.tobytes().__hash__():064x}", pixels, None)
    shown = scene.background.model_copy(update={"image": read})
    return scene.model_copy(update={"background": shown})


def sky64(pixels: Pixels, direction: Array, rotation: float = 0.0) -> Array:
    """The image in directions, (n, 3), in float64: rows from +y to -y, the middle column is -z."""
    x, y, z = (direction[:, k].astype(np.float64) for k in range(3))
    height, width, _ = pixels.shape
    u = np.arctan2(x, -z) / (2 * np.pi) + 0.5 + rotation / 360
    v = np.arctan2(np.hypot(x, z), y) / np.pi
    across, down = u * width - 0.5, v * height - 0.5
    left, top = np.floor(across).astype(int), np.floor(down).astype(int)
    right_share, low_share = (across - left)[:, None], (down - top)[:, None]

    def at(column: Array, row: Array) -> Array:
        found: Array = pixels[np.clip(row, 0, height - 1), column % width].astype(np.float64)
        return found

    upper = at(left, top) * (1 - right_share) + at(left + 1, top) * right_share
    lower = at(left, top + 1) * (1 - right_share) + at(left + 1, top + 1) * right_share
    mixed: Array = upper * (1 - low_share) + lower * low_share
    return mixed
