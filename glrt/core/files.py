"""Write files atomically, by a rename; refuse to read pipes, devices and files too long."""

import os
import re
import secrets
import shutil
import stat
from collections.abc import Callable
from contextlib import suppress
from errno import EFBIG, EINVAL, EISDIR, ELOOP
from pathlib import Path

from glrt.core.errors import ContentError, RenderError, UsageError

# Libraries raise these, not only the system: OpenEXR raises RuntimeError when a disk is full, and
# Python raises ValueError for names that no system accepts.
_WRITE_FAILURES = (OSError, RuntimeError, ValueError, MemoryError)


def write_whole(path: Path, write: Callable[[Path], None]) -> None:
    """Let `write` fill a temporary file in the folder of `path`, then rename it to `path`.

    A reader sees either the old file or the new one. Raises `RenderError` on failure: the old file
    then stays unchanged, and the temporary file is removed.
    """
    try:
        target = _resolved(path)  # for a link, the file that it points to
        if target.is_dir():
            raise IsADirectoryError(EISDIR, os.strerror(EISDIR), str(path))
        temporary = _next_to(target)
        try:
            _create(temporary)
            write(temporary)
            _rename(temporary, target)
        finally:
            with suppress(OSError):
                temporary.unlink(missing_ok=True)
    except _WRITE_FAILURES as error:
        raise RenderError(
            f"Cannot write {path}: {reason(error, UNTOLD)}. Nothing was written there; free some "
            "space, or choose another place."
        ) from error


def write_text(path: Path, text: str) -> None:
    """Write a text in UTF-8 with `write_whole`; raises `RenderError` on failure."""
    write_whole(path, lambda file: _write_text(file, text))


def make_folder(folder: Path, *names: str) -> None:
    """Create the folder; `UsageError` if that fails, or if one of these files cannot be written."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(
            f"Cannot make the folder {folder}: {reason(error, UNTOLD)}. Choose another with -o."
        ) from None
    for name in names:
        check_writable(folder / name)


def read_at_most(path: Path, most: int) -> bytes:
    """Return the content of a file; OSError if it is not a file, or longer than `most` bytes."""
    check_regular(path)
    with path.open("rb") as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise OSError(EFBIG, f"longer than {most >> 20} MiB")
    return content


def check_regular(path: Path) -> None:
    """Raise OSError for a folder, and for a pipe or device, whose reading may never end."""
    mode = path.stat().st_mode
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(EISDIR, os.strerror(EISDIR), str(path))
    if not stat.S_ISREG(mode):
        raise OSError(EINVAL, "a pipe or a device, not a file", str(path))


def check_writable(path: Path) -> None:
    """Raise `UsageError` if `write_whole` could not write to `path`; leaves no file behind."""
    try:
        problem = _obstacle(path)
    except (OSError, RuntimeError, ValueError) as error:
        problem = reason(error, UNTOLD)
    if problem:
        raise UsageError(f"Cannot write {path}: {problem}. Choose another place or name.")


def reason(error: BaseException, otherwise: str = "its content cannot be decoded") -> str:
    """Return why something failed, in the words of the system or of glrt, without a full stop.

    Messages of Python and of libraries are for programmers: in place of them stands `otherwise`.
    """
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    if isinstance(error, UnicodeDecodeError):
        return "a text in it is damaged, or not in UTF-8"
    if isinstance(error, UnicodeEncodeError):
        return "a text for it, as the name of a file, has signs that UTF-8 cannot hold"
    if isinstance(error, ContentError):
        return str(error).rstrip(".")
    told = str(error)
    if isinstance(error, MemoryError):
        wanted = _SIZE.search(told)  # as numpy gives it
        return f"there is no room for {wanted[0]}" if wanted else "there is no more"
    if isinstance(error, EOFError) or _CUT_OFF.search(told):
        return "it is cut off"
    return otherwise


UNTOLD = "the system gives no reason"
_SIZE = re.compile(r"[\d.]+ [KMGTP]?i?B\b")
_CUT_OFF = re.compile("truncated|end of file|not enough|EOF|fewer bytes|too short|premature", re.I)


def _write_text(file: Path, text: str) -> None:
    file.write_text(text, encoding="utf-8")


def _obstacle(path: Path) -> str | None:
    """Return why a write would fail, or None; a failed trial raises the error of the system.

    Permission bits are not enough: they do not bind root or show a disk mounted read-only.
    """
    target = _resolved(path)
    if not target.parent.is_dir():
        return _no_folder(path, target)
    if target.exists() and not target.is_file():
        return "it is a folder or a device, not a file"
    if target.exists():
        target.open("ab").close()
    probe = _next_to(target)
    _create(probe)
    probe.unlink()
    return None


def _resolved(path: Path) -> Path:
    """The file that a path leads to by its links. OSError for links that go round in circles."""
    target = path.resolve()
    if target.is_symlink():  # since Python 3.13 `resolve` returns such a link as it is
        raise OSError(ELOOP, os.strerror(ELOOP), str(path))
    return target


def _no_folder(path: Path, target: Path) -> str:
    """Return which folder is missing; `target` is the path with its links resolved."""
    if path.is_symlink():
        return f"it is a link to {target}, and there is no folder {target.parent}"
    if path.parent.is_symlink():
        return f"{path.parent} is a link to {target.parent}, and there is no such folder"
    return f"there is no folder {path.parent}"


def _next_to(target: Path) -> Path:
    return target.with_name(f".glrt-{secrets.token_hex(8)}{target.suffix}")


def _create(path: Path) -> None:
    """Create an empty file that did not exist, with the permissions of any new file."""
    os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))


def _rename(temporary: Path, target: Path) -> None:
    if target.exists():
        shutil.copymode(target, temporary)
    with temporary.open("rb+") as file:
        os.fsync(file.fileno())  # a full disk may be reported only here
    os.replace(temporary, target)


def unused(name: str) -> str:
    """Return the file name, with a number appended if it is taken, so that no file is replaced."""
    path, number = Path(name), 1
    while path.exists():
        number += 1
        path = path.with_stem(f"{Path(name).stem}-{number}")
    return str(path)
