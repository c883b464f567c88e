"""The image of the sky in all directions, from a file or of a clear sky."""

from typing import NamedTuple

from glrt.scene.files.named_images import ImageFile, Pixels
from glrt.scene.lights.background import Background
from glrt.scene.lights.clear_sky import sky_pixels
from glrt.scene.lights.sun import Sun


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
