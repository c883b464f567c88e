"""The image of all directions that a scene has: from a file, or of a clear sky."""

from typing import NamedTuple

from glrt.scene.files.named_images import ImageFile, Pixels
from glrt.scene.lights.background import Background
from glrt.scene.lights.clear_sky import sky_pixels
from glrt.scene.lights.sun import Sun


class ModelSky(NamedTuple):
    """What the pixels of a clear sky follow from."""

    turbidity: float
    ground: float
    towards: tuple[float, float, float]  # the sun


class SkyPicture(NamedTuple):
    """Pictures of equal sources have equal pixels."""

    source: ImageFile | ModelSky
    name: str  # in messages
    pixels: Pixels | None  # (H, W, 3), linear, row 0 on top; None before the file is read


def sky_picture(background: Background, sun: Sun | None) -> SkyPicture | None:
    """None for colours and gradients."""
    if image := background.image:
        return SkyPicture(image, image.file, image.pixels)
    if background.sky is None or sun is None:
        return None
    x, y, z = map(float, sun.towards)
    source = ModelSky(background.sky.turbidity, background.sky.ground, (x, y, z))
    return SkyPicture(source, "the clear sky", sky_pixels(*source))
