"""The image of the sky as a texture, which renderers of edited scenes share."""

import moderngl
import numpy as np

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.gpu.shared_resources import Shared
from glrt.scene.files.named_images import Pixels
from glrt.scene.lights.sky_image import SkyPicture


def texture_of(gl: moderngl.Context, pixels: Pixels) -> moderngl.Texture:
    """Return a texture of pixels, (H, W, 3), that is not interpolated."""
    height, width, channels = pixels.shape
    content = np.ascontiguousarray(pixels)
    texture = gl.texture((width, height), channels, content, alignment=1, dtype="f4")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture


class ImageTexture(Shared):
    """The pixels of an image on the driver, RGB in float32; its last user frees them."""

    def __init__(self, context: Context, picture: SkyPicture) -> None:
        """Upload the image; SceneError if it is larger than a texture of the driver may be."""
        assert picture.pixels is not None
        height, width, _ = picture.pixels.shape
        most = int(context.gl.info["GL_MAX_TEXTURE_SIZE"])
        if max(height, width) > most:
            raise SceneError(
                f"background: {picture.name} has {width} x {height} pixels, and a texture of this "
                f"driver {most} on a side at most. Scale the image down."
            )
        super().__init__(texture_of(context.gl, picture.pixels))
        self._source = picture.source

    def shows(self, picture: SkyPicture) -> bool:
        """Return whether the texture holds this image."""
        return self._source == picture.source
