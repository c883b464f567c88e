"""Images on surfaces in the words of Mitsuba."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.text import quoted
from glrt.scene.export.left_out import Report
from glrt.scene.export.mitsuba.words import Pixels, Words
from glrt.scene.materials.textures import Texture
from glrt.scene.values import Radiance

_FILTERS = {"linear": "bilinear", "nearest": "nearest"}
CHANNELS = {None: 0, "r": 0, "g": 1, "b": 2, "a": 3}

Turn = NDArray[np.float64]  # (3, 3), of coordinates of texture, before all else
STRAIGHT = np.eye(3)


def painted(texture: Texture, factor: Radiance, turn: Turn = STRAIGHT) -> Words:
    """Return an image of colours, or of a radiance, times a factor."""
    pixels = texture.texels[..., :3].astype(np.float32) * np.array(factor, np.float32)
    return _bitmap(texture, pixels, turn)


def measured(texture: Texture, factor: float, turn: Turn = STRAIGHT) -> Words:
    """Return an image of a number, which is one channel, times a factor."""
    channel = texture.texels[..., CHANNELS[texture.channel]].astype(np.float32)
    return _bitmap(texture, channel[..., None] * np.float32(factor), turn)


def report_lying(name: str, textures: Mapping[str, Texture], report: Report) -> None:
    """Report how images of a material lie in ways that Mitsuba does not know."""
    for key, texture in textures.items():
        if texture.wrap[0] != texture.wrap[1]:
            report(f"what lies beyond the image of {key} of {quoted(name)} along v")
    if len({texture.uv for texture in textures.values()}) > 1:
        report(f"the second set of coordinates of {quoted(name)}")


def _bitmap(texture: Texture, pixels: NDArray[np.float32], turn: Turn) -> Words:
    matrix = np.eye(4)
    matrix[:2, [0, 1, 3]] = texture.transform @ turn
    sharpness: Any = "nearest" if texture.checker is not None else texture.filter
    return {
        "type": "bitmap",
        "bitmap": Pixels(np.ascontiguousarray(pixels)),
        "raw": True,
        "filter_type": _FILTERS[sharpness],
        "wrap_mode": texture.wrap[0],
        "to_uv": matrix,
    }
