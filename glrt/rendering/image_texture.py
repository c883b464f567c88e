"""An image of a scene as a texture, which renderers of edited scenes share."""

import moderngl
import numpy as np

from glrt.errors import SceneError
from glrt.gpu.context import Context
from glrt.gpu.shared import Shared
from glrt.scene.named_images import ImageFile, Pixels


def texture_of(gl: moderngl.Context, pixels: Pixels) -> moderngl.Texture:
    """A texture of pixels, (H, W, 3), which is not interpolated."""
    height, width, channels = pixels.shape
    content = np.ascontiguousarray(pixels)
    texture = gl.texture((width, height), channels, content, alignment=1, dtype="f4")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture


class ImageTexture(Shared):
    """The pixels of an image on the driver, RGB in float32, freed by its last user."""

    def __init__(self, context: Context, image: ImageFile, key: str) -> None:
        """SceneError for an image beyond the driver; `key` names it in messages."""
        assert image.pixels is not None
        height, width, _ = image.pixels.shape
        most = int(context.gl.info["GL_MAX_TEXTURE_SIZE"])
        if max(height, width) > most:
            raise SceneError(
                f"{key}: {image.file} has {width} x {height} pixels, and a texture of this driver "
                f"{most} on a side at most. Scale the image down."
            )
        super().__init__(texture_of(context.gl, image.pixels))
        self._image = image

    def shows(self, image: ImageFile) -> bool:
        """Whether it is of this image."""
        return self._image == image
