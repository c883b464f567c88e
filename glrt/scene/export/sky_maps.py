"""The radiance of the sky in any direction, from which maps of other programs are made."""

import numpy as np
from numpy.typing import NDArray

from glrt.scene.files.named_images import Pixels
from glrt.scene.scene import Scene

Floats = NDArray[np.float64]


def sky_towards(scene: Scene, directions: Floats) -> Floats:
    """Return the radiance of the background towards unit directions, (n, 3), in float64.

    The intensity of its light group is included; the sun is not.
    """
    bottom, *horizon, top = (np.array(color) for color in scene.background_colors)
    picture = scene.sky
    if picture is not None and picture.pixels is not None:
        found: Floats = _in_picture(
            picture.pixels, directions, scene.background.rotation or 0.0
        ) * np.array(top)
        return found
    colors = np.array([bottom, *horizon, top])
    knots = np.linspace(-1, 1, len(colors))
    return np.stack([np.interp(directions[:, 1], knots, each) for each in colors.T], axis=-1)


def is_even(scene: Scene) -> bool:
    """Return whether the background has one radiance in all directions."""
    return not scene.background.is_pictured and len(set(scene.background_colors)) == 1


def _in_picture(pixels: Pixels, directions: Floats, rotation: float) -> Floats:
    """Return pixels between whose middles is interpolated; the middle column is -z."""
    x, y, z = directions.T
    height, width, _ = pixels.shape
    across = (np.arctan2(x, -z) / (2 * np.pi) + 0.5 + rotation / 360) * width - 0.5
    down = np.arctan2(np.hypot(x, z), y) / np.pi * height - 0.5
    left, above = np.floor(across).astype(np.int64), np.floor(down).astype(np.int64)
    found = np.zeros((len(directions), 3))
    for column in (0, 1):
        for row in (0, 1):
            share = np.abs(1 - column - (across - left)) * np.abs(1 - row - (down - above))
            rows = np.clip(above + row, 0, height - 1)
            found += share[:, None] * pixels[rows, (left + column) % width]
    return found
