"""Textures of a glTF file that is written: images in PNG of 8 bits, and how they lie."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.scene.export.image_codes import MOST, codes_of, png_of
from glrt.scene.materials.textures import Texture
from glrt.scene.model_files.gltf_file import GltfFile, Table

Texels = NDArray[np.float16]  # (H, W, 4), linear

_WRAPS = {"clamp": 33071, "mirror": 33648, "repeat": 10497}
_FILTERS = {"nearest": 9728, "linear": 9729}
_CHANNELS = {None: 0, "r": 0, "g": 1, "b": 2, "a": 3}
_TRANSFORM = "KHR_texture_transform"


class TextureWriter:
    """Adds textures to a file, each image once."""

    def __init__(self, file: GltfFile) -> None:
        self._file, self._images = file, dict[object, int]()
        self._samplers = dict[object, int]()

    def lying(self, texture: Texture, texels: Texels, is_color: bool) -> Table:
        """Return the reference to texels that lie as a texture does."""
        image = self._image(texels, is_color)
        sharpness = "nearest" if texture.checker is not None else texture.filter
        key = texture.wrap, sharpness
        if key not in self._samplers:
            wraps = {f"wrap{axis}": _WRAPS[it] for axis, it in zip("ST", texture.wrap, strict=True)}
            sampler = {"magFilter": _FILTERS[sharpness], **wraps}
            self._samplers[key] = self._file.add("samplers", sampler)
        number = self._file.add("textures", {"source": image, "sampler": self._samplers[key]})
        info: Table = {"index": number, "texCoord": texture.uv}
        moved = texture.scale != (1.0, 1.0) or texture.offset != (0.0, 0.0) or texture.rotation
        if moved:
            place = {"scale": list(texture.scale), "offset": list(texture.offset)}
            turn = {"rotation": math.radians(texture.rotation)}
            self._file.use(_TRANSFORM)
            info["extensions"] = {_TRANSFORM: {**place, **turn}}
        return info

    def _image(self, texels: Texels, is_color: bool) -> int:
        key = is_color, texels.shape, texels.tobytes()
        if key not in self._images:
            view = self._file.view(_file_of(texels, is_color))
            table = {"bufferView": view, "mimeType": "image/png"}
            self._images[key] = self._file.add("images", table)
        return self._images[key]


def placing(texture: Texture) -> tuple[Any, ...]:
    """Return how a texture lies: textures of equal placing and size may share an image."""
    place = texture.scale, texture.offset, texture.rotation
    return *place, texture.wrap, texture.filter, texture.uv, texture.texels.shape


def channel_of(texture: Texture) -> NDArray[np.float16]:
    """Return the channel that a number takes, (H, W)."""
    return texture.texels[..., _CHANNELS[texture.channel]]


def _file_of(texels: Texels, is_color: bool) -> bytes:
    codes = codes_of(texels, is_color)
    is_whole = (codes[..., 3] == MOST).all()
    return png_of(codes[..., :3] if is_whole else codes)
