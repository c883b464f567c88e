"""The image of the sky in all directions, from a file or of a clear sky."""

from typing import NamedTuple

import numpy as np

from glrt.core.memo import kept_for_the_same
from glrt.scene.files.named_images import ImageFile, Pixels
from glrt.scene.lights.background import Background
from glrt.scene.lights.clear_sky import sky_pixels
from glrt.scene.lights.sun import Sun

BRIGHT = 16.0  # times the mean radiance of an image, from which on a pixel is a bright spot


class ModelSky(NamedTuple):
    """The values that determine the pixels of a clear sky."""

    turbidity: float
    ground: float
    towards: tuple[float, float, float]  # unit vector to the sun


class SkyPicture(NamedTuple):
    """An image of the sky; pictures with equal sources have equal pixels."""

    source: ImageFile | ModelSky
    name: str  # its name in messages
    pixels: Pixels | None  # (H, W, 3), linear, row 0 on top; None before the file is read


def sky_picture(background: Background, sun: Sun | None) -> SkyPicture | None:
    """Return the image of a background; None for colours and gradients."""
    if image := background.image:
        return SkyPicture(image, image.file, image.pixels)
    if background.sky is None or sun is None:
        return None
    x, y, z = map(float, sun.towards)
    source = ModelSky(background.sky.turbidity, background.sky.ground, (x, y, z))
    return SkyPicture(source, "the clear sky", sky_pixels(*source))


@kept_for_the_same
def bright_share(pixels: Pixels) -> float:
    """Return the share of the flux of an image, (H, W, 3), that comes from its bright spots.

    A row counts by the sine of its angle from the pole.
    """
    light = pixels.mean(axis=-1, dtype=np.float64)
    sines = np.sin(np.pi * (np.arange(len(light)) + 0.5) / len(light))[:, None]
    flux = light * sines
    total = float(flux.sum())
    mean = total / (light.shape[1] * float(sines.sum()))
    return float(flux[light >= BRIGHT * mean].sum()) / total if total > 0 else 0.0
