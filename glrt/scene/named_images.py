"""Images that a scene names: the path of a file, its SHA-256, and its pixels once it is read."""

from pathlib import Path
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, PlainSerializer, PrivateAttr, WithJsonSchema

from glrt.scene.named_files import PATH_SCHEMA, NamedFile, by_path, to_path

Pixels = NDArray[np.float32]


class ImageFile(NamedFile):
    """An image in a file."""

    _pixels: Pixels | None = PrivateAttr(None)

    @property
    def pixels(self) -> Pixels | None:
        """(H, W, 3), linear, row 0 on top; None before the file is read."""
        return self._pixels

    def read_as(self, sha256: str, pixels: Pixels, origin: Path | None) -> "ImageFile":
        """The image with its content."""
        found = ImageFile(file=self.file, sha256=sha256)
        found._pixels, found._origin = pixels, origin
        return found


# In a scene file, the path alone.
NamedImage = Annotated[
    ImageFile,
    BeforeValidator(by_path(ImageFile)),
    PlainSerializer(to_path, return_type=str),
    WithJsonSchema(PATH_SCHEMA),
]
