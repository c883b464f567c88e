"""Files that a scene names: the path, and the SHA-256 of the content once it is known."""

import re
from abc import abstractmethod
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import Field, PrivateAttr

from glrt.scene.values import Name
from glrt.settings import Frozen

_LONGEST = 4096  # characters of a path, as on Linux
PATH_SCHEMA = {"type": "string", "minLength": 1, "maxLength": _LONGEST}


class NamedFile(Frozen):
    """A file that a scene names; equal to another of its kind if path and SHA-256 are equal."""

    file: Annotated[Name, Field(max_length=_LONGEST)] = Field(
        description="path with '/', relative to the folder of the scene; `\\xHH` is a byte of a "
        "name that text cannot hold"
    )
    sha256: str | None = Field(None, description="of the content, in hex, where it is known")

    _origin: Path | None = PrivateAttr(None)
    _companions: Mapping[str, str] = PrivateAttr({})
    _content: bytes | None = PrivateAttr(None)

    @property
    @abstractmethod
    def is_read(self) -> bool:
        """Whether the content is there."""

    @property
    def content(self) -> bytes | None:
        """Content of the file of what was made from arrays; None for what was read from a file."""
        return self._content

    @property
    def origin(self) -> Path | None:
        """The location of the file that was read; None before it is read."""
        return self._origin

    @property
    def path(self) -> str:
        """Path of the file itself: `FILE.glb` for an image `FILE.glb#2` inside it."""
        return container_of(self.file)[0]

    @property
    def companions(self) -> Mapping[str, str]:
        """SHA-256 in hex, by path, of other files from which the content was read."""
        return self._companions

    def with_companions(self, hashes: Mapping[str, str]) -> Self:
        """Return a copy with these SHA-256, by path, of other files from which it was read."""
        found = self.model_copy()
        found._companions = hashes
        return found

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, NamedFile) or type(self) is not type(other):
            return False
        return (self.file, self.sha256) == (other.file, other.sha256)

    def __hash__(self) -> int:
        return hash((self.file, self.sha256))


_INSIDE = re.compile(r"(.+\.(?:glb|gltf|usd[acz]?))#([0-9]{1,6})", re.IGNORECASE)


def container_of(path: str) -> tuple[str, int | None]:
    """Return the file of a path, and the number of the image in it that the path means, if any."""
    match = _INSIDE.fullmatch(path)
    return (match[1], int(match[2])) if match else (path, None)


def by_path(kind: type[NamedFile]) -> Callable[[Any], Any]:
    """Return a function that makes a file of a kind from the path in a scene file."""

    def read(value: Any) -> Any:
        if isinstance(value, kind):
            return value
        if not isinstance(value, str):
            raise ValueError("must be the path of a file, a text")
        return kind.model_validate({"file": value})

    return read


def to_path(named: NamedFile | None) -> str | None:
    """Return the path alone, as a scene file gives it; None without a file."""
    return named.file if named else None
