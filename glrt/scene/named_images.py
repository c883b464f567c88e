"""Images that a scene names: the path of a file, its SHA-256, and its pixels once it is read."""

from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, PlainSerializer, PrivateAttr, WithJsonSchema

from glrt.scene.values import Name
from glrt.settings import Frozen

Pixels = NDArray[np.float32]

_LONGEST = 1000  # characters of a path


class ImageFile(Frozen):
    """An image in a file; equal to another if path and content are."""

    file: Annotated[Name, Field(max_length=_LONGEST)] = Field(
        description="path with '/', relative to the folder of the scene"
    )
    sha256: str | None = Field(None, description="of the content, in hex, where it is known")

    _pixels: Pixels | None = PrivateAttr(None)
    _origin: Path | None = PrivateAttr(None)

    @property
    def pixels(self) -> Pixels | None:
        """(H, W, 3), linear, row 0 on top; None before the file is read."""
        return self._pixels

    @property
    def origin(self) -> Path | None:
        """The file that was read."""
        return self._origin

    def read_as(self, sha256: str, pixels: Pixels, origin: Path | None) -> "ImageFile":
        """The image with its content."""
        found = ImageFile(file=self.file, sha256=sha256)
        found._pixels, found._origin = pixels, origin
        return found

    def __eq__(self, other: object) -> bool:
        same = isinstance(other, ImageFile)
        return same and (self.file, self.sha256) == (other.file, other.sha256)  # type: ignore[attr-defined]

    def __hash__(self) -> int:
        return hash((self.file, self.sha256))


def _of_path(value: Any) -> Any:
    if isinstance(value, ImageFile):
        return value
    if not isinstance(value, str):
        raise ValueError("must be the path of a file, a text")
    return ImageFile.model_validate({"file": value})


def _to_path(image: ImageFile | None) -> str | None:
    return image.file if image else None


# In a scene file, the path alone.
NamedImage = Annotated[
    ImageFile,
    BeforeValidator(_of_path),
    PlainSerializer(_to_path, return_type=str),
    WithJsonSchema({"type": "string", "minLength": 1, "maxLength": _LONGEST}),
]
