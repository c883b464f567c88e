"""Images that a scene names: the path of a file, its SHA-256, and its pixels once it is read."""

from pathlib import Path
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, PlainSerializer, PrivateAttr, WithJsonSchema

from glrt.scene.files.named_files import PATH_SCHEMA, NamedFile, by_path, to_path

Pixels = NDArray[np.float32]
Texels = NDArray[np.float16]


class ImageFile(NamedFile):
    """An image of the sky in a file."""

    _pixels: Pixels | None = PrivateAttr(None)

    @property
    def pixels(self) -> Pixels | None:
        """Pixels, (H, W, 3), linear, row 0 on top; None before the file is read."""
        return self._pixels

    @property
    def is_read(self) -> bool:
        """Whether its pixels are there."""
        return self._pixels is not None

    def read_as(self, sha256: str, pixels: Pixels, origin: Path | None) -> "ImageFile":
        """Return the image with its content."""
        found = ImageFile(file=self.file, sha256=sha256)
        found._pixels, found._origin = pixels, origin
        return found


class TextureImage(NamedFile):
    """An image on a surface; `FILE.glb#2` is the third image in a glTF file."""

    is_color: ClassVar[bool]

    _texels: Texels | None = PrivateAttr(None)

    @property
    def texels(self) -> Texels | None:
        """Texels, (H, W, 4), linear, alpha last, row 0 on top; None before the file is read."""
        return self._texels

    @property
    def is_read(self) -> bool:
        """Whether its texels are there."""
        return self._texels is not None

    def read_as(self, sha256: str, texels: Texels, origin: Path | None) -> Self:
        """Return the image with its content."""
        found = type(self)(file=self.file, sha256=sha256)
        found._texels, found._origin = texels, origin
        return found

    @classmethod
    def named(cls, path: str) -> Any:
        """Return the image of a path, or an invalid path itself, which validation reports."""
        try:
            return cls(file=path)
        except ValueError:
            return path


class ColorImage(TextureImage):
    """An image of colors in sRGB."""

    is_color = True


class DataImage(TextureImage):
    """An image of numbers from 0 to 1."""

    is_color = False


def _texture(value: Any) -> Any:
    return value if isinstance(value, TextureImage) else by_path(ColorImage)(value)


# A scene file holds the path alone.
NamedImage = Annotated[
    ImageFile,
    BeforeValidator(by_path(ImageFile)),
    PlainSerializer(to_path, return_type=str),
    WithJsonSchema(PATH_SCHEMA),
]
NamedTexture = Annotated[
    TextureImage,
    BeforeValidator(_texture),
    PlainSerializer(to_path, return_type=str),
    WithJsonSchema(PATH_SCHEMA),
]
