"""The texels of all images on surfaces, one after the other in a texture."""

from collections.abc import Sequence

import moderngl
import numpy as np

from glrt.gpu.context import Context
from glrt.gpu.shared_resources import Shared
from glrt.scene.files.named_images import Texels
from glrt.scene.images.texture_sizes import reduced, sizes_of
from glrt.scene.materials.textures import Texture

BITS = 12
WIDTH = 1 << BITS  # texels in a line: images follow each other, whatever their width


class TexelTexture(Shared):
    """Texels of all images on surfaces, RGBA in half floats; their last user frees them."""

    def __init__(self, context: Context, images: Sequence[Texture]) -> None:
        """Upload the images in the order of their texels; images that are too large are reduced."""
        super().__init__(texture_of(context.gl, images))
        self._images = list(images)

    def holds(self, images: Sequence[Texture]) -> bool:
        """Return whether the texture holds exactly these images, in this order."""
        return [image.source for image in self._images] == [image.source for image in images]


def texture_of(gl: moderngl.Context, images: Sequence[Texture]) -> moderngl.Texture:
    """Return a texture of images, in lines of WIDTH texels."""
    sizes = sizes_of([texture.texels.shape[:2] for texture in images])
    count = sum(height * width for height, width in sizes)
    texels: Texels = np.zeros((max(-(-count // WIDTH), 1) * WIDTH, 4), np.float16)
    first = 0
    for image, (height, width) in zip(images, sizes, strict=True):
        end = first + height * width
        texels[first:end] = reduced(image.texels, (height, width)).reshape(-1, 4)
        first = end
    texture = gl.texture((WIDTH, len(texels) // WIDTH), 4, texels, dtype="f2")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture
