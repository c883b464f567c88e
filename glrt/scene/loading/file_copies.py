"""Copy the files that a scene names next to a scene file elsewhere."""

import hashlib
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from glrt.core.errors import UsageError
from glrt.core.files import write_whole
from glrt.scene.files.path_text import name_of
from glrt.scene.loading.file_contents import NamedContent
from glrt.scene.loading.scene_files import named_files
from glrt.scene.schema.fields import SceneFields


class _Source(NamedTuple):
    """A file to copy: where it is to lie, and its content or the file that has it."""

    path: str
    sha256: str | None
    origin: Path | None
    content: bytes | None


def copy_files(scene: SceneFields, folder: Path) -> None:
    """Put copies of the files that a scene names where a scene file in `folder` finds them.

    A file that is there already stays, and files above the folder are not copied. Raises
    `UsageError` if the file there has other content, or if the one to copy is not as it was read;
    `RenderError` if a copy cannot be written.
    """
    for source in dict.fromkeys(_sources(scene)):
        is_beside = ".." not in PurePosixPath(source.path).parts
        if not is_beside or (source.origin is None and source.content is None):
            continue
        target = folder / name_of(source.path)
        if target.exists():
            if _hash(target) != source.sha256:
                raise UsageError(
                    f"Cannot put a copy of {source.path} in {folder}: a file of that name with "
                    "other content is there. Save the scene to another folder."
                )
            continue
        content = _unchanged(source) if source.content is None else source.content
        target.parent.mkdir(parents=True, exist_ok=True)
        write_whole(target, lambda file, data=content: file.write_bytes(data))  # type: ignore[misc]


def _sources(scene: SceneFields) -> Iterator[_Source]:
    for _, named in named_files(scene):
        yield _Source(named.path, named.sha256, named.origin, named.content)
        for path, sha256 in named.companions.items():
            yield _Source(path, sha256, _next_to(named, path), None)


def _next_to(named: NamedContent, path: str) -> Path | None:
    """Return where a file was read that another one names; None if that is unknown.

    `path` and the path of `named` start from the same folder.
    """
    end = name_of(named.path)
    if named.origin is None or not named.origin.as_posix().endswith(end):
        return None
    return Path(named.origin.as_posix().removesuffix(end)) / name_of(path)


def _unchanged(source: _Source) -> bytes:
    """Return the content of a file; UsageError if it has changed since it was read."""
    assert source.origin is not None
    content = source.origin.read_bytes()
    if hashlib.sha256(content).hexdigest() != source.sha256:
        raise UsageError(
            f"Cannot copy {source.origin} next to the scene: it has changed since it was read. "
            "Load the scene again."
        )
    return content


def _hash(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()
