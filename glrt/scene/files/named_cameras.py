"""Cameras that a scene names: the path of a glTF or USD file, and its cameras once it is read."""

from pathlib import Path
from typing import Annotated, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, PlainSerializer, PrivateAttr, WithJsonSchema

from glrt.scene.files.named_files import PATH_SCHEMA, NamedFile, by_path, to_path


class CameraView(NamedTuple):
    """Where a camera of a file stands, in the coordinates of the file."""

    position: NDArray[np.float64]  # (3,)
    look_at: NDArray[np.float64]  # (3,), one unit in front of it
    up: NDArray[np.float64]  # (3,), of length 1
    fov: float  # vertical, degrees


class OneCamera(Protocol):
    """A camera of a file."""

    @property
    def aspect(self) -> float | None:
        """Width over height of its picture; None if the file states none."""

    @property
    def usual(self) -> str | None:
        """The animation that moves it if none is named; None if none moves it."""

    def seconds(self, name: str) -> float:
        """Return the time of the last key of an animation."""

    def view(self, animation: str | None = None, moment: float | None = None) -> CameraView:
        """Return where it stands at a moment in seconds; ValueError for data that do not fit."""


class Cameras(Protocol):
    """The cameras of a file."""

    @property
    def names(self) -> list[str]:
        """Names, as `find` takes them, of the nodes with a camera by which one can see."""

    def find(self, node: str | None) -> OneCamera:
        """Return the camera of a node, or the only one; ValueError if there is no such camera."""


class CameraFile(NamedFile):
    """A glTF file with a camera."""

    _cameras: Cameras | None = PrivateAttr(None)

    @property
    def cameras(self) -> Cameras | None:
        """The cameras of the file; None before it is read."""
        return self._cameras

    @property
    def is_read(self) -> bool:
        """Whether its cameras are there."""
        return self._cameras is not None

    def read_as(self, sha256: str, cameras: Cameras, origin: Path | None) -> "CameraFile":
        """Return the file with its content."""
        found = CameraFile(file=self.file, sha256=sha256)
        found._cameras, found._origin = cameras, origin
        return found


# A scene file holds the path alone.
NamedCamera = Annotated[
    CameraFile,
    BeforeValidator(by_path(CameraFile)),
    PlainSerializer(to_path, return_type=str),
    WithJsonSchema(PATH_SCHEMA),
]
