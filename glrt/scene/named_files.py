"""Files that a scene names: the path, and the SHA-256 of the content once it is known."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, PrivateAttr

from glrt.scene.values import Name
from glrt.settings import Frozen

_LONGEST = 1000  # characters of a path
PATH_SCHEMA = {"type": "string", "minLength": 1, "maxLength": _LONGEST}


class NamedFile(Frozen):
    """A file; equal to another of its kind if path and content are."""

    file: Annotated[Name, Field(max_length=_LONGEST)] = Field(
        description="path with '/', relative to the folder of the scene"
    )
    sha256: str | None = Field(None, description="of the content, in hex, where it is known")

    _origin: Path | None = PrivateAttr(None)

    @property
    def origin(self) -> Path | None:
        """The file that was read."""
        return self._origin

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, NamedFile) or type(self) is not type(other):
            return False
        return (self.file, self.sha256) == (other.file, other.sha256)

    def __hash__(self) -> int:
        return hash((self.file, self.sha256))


def by_path(kind: type[NamedFile]) -> Callable[[Any], Any]:
    """What makes a file of a kind from the path that a scene file gives."""

    def read(value: Any) -> Any:
        if isinstance(value, kind):
            return value
        if not isinstance(value, str):
            raise ValueError("must be the path of a file, a text")
        return kind.model_validate({"file": value})

    return read


def to_path(named: NamedFile | None) -> str | None:
    """What a scene file says of it: the path alone."""
    return named.file if named else None
