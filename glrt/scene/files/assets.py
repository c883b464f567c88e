"""Files that a scene names: held to a folder, limited in size, known by their SHA-256.

A scene names a mesh or an image by a path with '/', relative to a base folder; such a file may name
others, relative to itself. Files outside the base folder are not read unless the user allows it: a
scene from a stranger must not carry a private file into a picture.
"""

import hashlib
import os
import posixpath
import re
import stat
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, field
from errno import EINVAL, EIO, EISDIR
from itertools import islice
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from glrt.core.errors import SceneError
from glrt.core.files import check_regular, reason
from glrt.core.text import nearest, quoted
from glrt.scene.files.path_text import (
    has_stray_backslash,
    name_of,
    text_of,
    text_of_bytes,
    with_slashes,
)

LARGEST = 1 << 30  # bytes of a file
LARGEST_IN_ALL = 4 << 30  # bytes of all files of a scene

_MOST_NEIGHBOURS = 1000  # names that a misspelt one is compared with
_DRIVE = re.compile(r"[A-Za-z]:")
# Opening must not wait for a pipe, and must fail for a link that has replaced the checked file.
_CAREFULLY = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOFOLLOW", 0)


@dataclass(frozen=True)
class AssetFolder:
    """Where the files of a scene may lie, how large they may be, and which content they must have.

    `base` is the folder of the scene file; for a picture's recipe, it is the folder of the picture
    or the one that the user gives. Only the user may set `allow_outside`; no picture may.
    `expected` holds the SHA-256 of a recipe in hex, by path as `AssetReader.hashes` gives them, and
    None for a scene file. Other files are refused, and other content too unless `accept_changed`.
    Sizes are in bytes.
    """

    base: Path
    allow_outside: bool = False
    expected: Mapping[str, str] | None = None
    accept_changed: bool = False
    largest: int = LARGEST
    largest_in_all: int = LARGEST_IN_ALL


@dataclass(frozen=True)
class Asset:
    """A file as it was read, and the SHA-256 of that content in hex.

    `path` is relative to the base folder, with '/'. It is absolute only for a file outside that was
    named so.
    """

    path: str
    content: bytes = field(repr=False)
    sha256: str
    origin: Path = field(compare=False)  # the file itself, without links

    @property
    def size(self) -> int:
        """Size in bytes."""
        return len(self.content)


class AssetReader:
    """Reads the files of one scene, each once, and records them.

    It holds their content: keep it no longer than it takes to load the scene.
    """

    def __init__(self, folder: AssetFolder) -> None:
        self.folder = folder
        self._by_path: dict[str, Asset] = {}
        self._by_file: dict[str, Asset] = {}  # by path, links resolved
        self.made: dict[str, Any] = {}  # of files, by path, to be used again

    @property
    def assets(self) -> tuple[Asset, ...]:
        """The files read so far, in order; a file that has two paths is there twice."""
        return tuple(self._by_path.values())

    @property
    def hashes(self) -> dict[str, str]:
        """SHA-256 in hex of the files read so far, by path, as a recipe stores them."""
        return {path: asset.sha256 for path, asset in self._by_path.items()}

    def read(self, path: str, where: str, named_by: Asset | None = None) -> Asset:
        """Return the file at a path with '/', relative to the base folder or to the file naming it.

        `..` goes up in the path as it is written, as in a URL, before links are followed. `where`
        begins messages: the scene file and the key, as `room.toml: objects[2].file`. Raises
        `SceneError` for a path that leads out of the base folder, directly or by a link; for a file
        that is missing, unreadable, no regular file, or too large; and for a file that is not as
        `expected`.
        """
        place = f"{where}: {named_by.path}" if named_by else where
        try:
            return self._read(_joined(path, named_by))
        except _RefusedError as refused:
            raise SceneError(f"{place}: {refused}") from None
        except ValueError:  # from the system's functions, for a NUL or half a pair of surrogates
            raise SceneError(f"{place}: no file can have the name {quoted(path)}.") from None

    def spelled(self, path: str, folder: str = "") -> str:
        """Return the path, from the base folder, of a file that a model in a folder names.

        It is spelled as in the file system, if an entry fits: models name files with '\\' between
        folders, by paths of another machine, in letters of another case, with accents in another
        normal form, or with '%20' for a blank. A path that leads out of the base folder is not
        looked for, unless the user allows it.
        """
        joined = posixpath.join(folder, path)
        if self.folder.allow_outside and (self.folder.base / name_of(joined)).is_file():
            return joined
        given = with_slashes(path)
        if given.startswith("/") or _DRIVE.match(given):
            given = posixpath.basename(given)
        parts = posixpath.normpath(posixpath.join(folder, given)).split("/")
        if parts[0] in ("", ".."):
            return joined
        found = ""
        for part in parts:
            found = posixpath.join(found, _entry_like(part, self.folder.base / name_of(found)))
        return found

    def _read(self, name: str) -> Asset:
        if name not in self._by_path:
            _check_listed(name, self.folder)
            self._by_path[name] = self._fetched(name, _located(name, self.folder))
        return self._by_path[name]

    def _fetched(self, name: str, real: str) -> Asset:
        known = self._by_file.get(real)
        content = known.content if known else self._content(name, real)
        digest = known.sha256 if known else hashlib.sha256(content).hexdigest()
        _check_content(name, digest, self.folder)
        asset = Asset(name, content, digest, Path(real))
        self._by_file.setdefault(real, asset)
        return asset

    def _content(self, name: str, real: str) -> bytes:
        folder = self.folder
        room = folder.largest_in_all - sum(asset.size for asset in self._by_file.values())
        try:
            content = _read_at_most(real, min(folder.largest, room))
        except OSError as error:
            raise _RefusedError(_obstacle(error, name, real, folder)) from None
        if content is not None:
            return content
        if room < folder.largest:
            raise _RefusedError(
                f"with {quoted(name)} the files of this scene would take more than "
                f"{_size(folder.largest_in_all)}. Use smaller ones."
            )
        raise _RefusedError(
            f"{quoted(name)} is larger than {_size(folder.largest)}. Use a smaller file."
        )


class _RefusedError(ValueError):
    """A file is not read; the message says why, and what to do."""


def _joined(path: str, named_by: Asset | None) -> str:
    """Return a path from the base folder; raises `_RefusedError` if it is no path with '/'."""
    if not path:
        raise _RefusedError("the path of a file is empty. Give the path of one.")
    if has_stray_backslash(path):
        raise _RefusedError(f"{quoted(path)} holds a backslash. Write '/' between folders.")
    folder = folder_of(named_by.path) if named_by else ""
    return text_of_bytes(posixpath.normpath(posixpath.join(folder, path)).encode())


def folder_of(path: str) -> str:
    """Return the folder of a file, both as paths from the base folder; "" is the base folder."""
    return posixpath.dirname(path)


def _located(name: str, folder: AssetFolder) -> str:
    """Return the path without links; raises `_RefusedError` if it lies outside the folder.

    A name that leads out is refused before the system is asked, which would reveal whether it
    exists.
    """
    if folder.allow_outside:
        return os.path.realpath(folder.base / name_of(name))
    if name.split("/")[0] == ".." or name.startswith("/") or _DRIVE.match(name):
        raise _RefusedError(_outside(f"{quoted(name)} lies outside", folder))
    base = os.path.realpath(folder.base)
    real = os.path.realpath(os.path.join(base, name_of(name)))
    if not Path(real).is_relative_to(base):
        raise _RefusedError(_outside(f"{quoted(name)} is a link that leads out of", folder))
    return real


def _outside(problem: str, folder: AssetFolder) -> str:
    return (
        f"{problem} the folder {folder.base}, and only files in it or below are read. "
        "Move the file there, or allow others with --allow-outside if you trust the scene."
    )


def _check_listed(name: str, folder: AssetFolder) -> None:
    if folder.expected is not None and name not in folder.expected:
        raise _RefusedError(
            f"the recipe of this picture does not list {quoted(name)}, and a picture reads no file "
            "that it was not made with. Render its scene file instead."
        )


def _check_content(name: str, digest: str, folder: AssetFolder) -> None:
    expected = folder.expected[name] if folder.expected is not None else digest
    if digest != expected and not folder.accept_changed:
        raise _RefusedError(
            f"{quoted(name)} is not the file that this picture was made with: its SHA-256 begins "
            f"with {digest[:12]}, not {expected[:12]}. Put the old file back, or accept the new "
            "one with --assets changed."
        )


def _read_at_most(real: str, most: int) -> bytes | None:
    """Return the content of a file, or None if it has more than `most` bytes; raises OSError."""
    check_regular(Path(real))  # before it is opened: opening a device can act on it
    with open(real, "rb", opener=lambda path, flags: os.open(path, flags | _CAREFULLY)) as file:
        status = os.fstat(file.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise OSError(EINVAL, "a pipe or a device, not a file")
        if status.st_size > most:
            return None
        content = file.read(status.st_size + 1)
    if len(content) != status.st_size:
        raise OSError(EIO, "it changed while it was read")
    return content


def _obstacle(error: OSError, name: str, real: str, folder: AssetFolder) -> str:
    if isinstance(error, FileNotFoundError | NotADirectoryError):
        return f"there is no file {quoted(name)} in {folder.base}{_advice(real, folder)}"
    if error.errno == EISDIR:
        return f"{quoted(name)} is a folder. Name a file in it."
    if error.errno == EINVAL:
        return f"{quoted(name)} is {reason(error)}. Save what comes out of it to a file."
    return f"{quoted(name)} cannot be read: {reason(error)}. Check the file and its permissions."


def _advice(real: str, folder: AssetFolder) -> str:
    """Return advice on a missing file, which lies inside the folder, or the user allows others."""
    near = nearest(text_of(os.path.basename(real)), _neighbours(os.path.dirname(real)))
    if near:
        return f"; did you mean {quoted(near)}?"
    if folder.expected is None:
        return ". Check the path."
    return ". Name the folder that holds the files of the scene with --assets-from."


def _neighbours(folder: str) -> tuple[str, ...]:
    try:
        with os.scandir(folder) as entries:
            files = (entry.name for entry in islice(entries, _MOST_NEIGHBOURS) if entry.is_file())
            return tuple(sorted(map(text_of, files)))
    except OSError:
        return ()


def _entry_like(name: str, folder: Path) -> str:
    """Return the name as the folder spells it, or itself where the folder has nothing like it."""
    try:
        if (folder / name_of(name)).exists():
            return name
        with os.scandir(folder) as entries:
            names = sorted(text_of(entry.name) for entry in islice(entries, _MOST_NEIGHBOURS))
    except (OSError, ValueError):  # ValueError for a NUL
        return name
    return next((entry for entry in names if _plain(entry) == _plain(name)), name)


def _plain(name: str) -> str:
    return unicodedata.normalize("NFC", unquote(name)).casefold()


def _size(count: int) -> str:
    return f"{count >> 20:,} MiB" if count >= 1 << 20 else f"{count:,} bytes"
