"""Write files whole or not at all, by a rename; and refuse files that are not to be read."""

import os
import secrets
import shutil
import stat
from collections.abc import Callable
from contextlib import suppress
from errno import EFBIG, EINVAL, EISDIR
from pathlib import Path

from glrt.core.errors import RenderError, UsageError
from glrt.core.text import one_line

# Of libraries, not only of the system: OpenEXR raises RuntimeError when a disk is full, and Python
# ValueError for names that no system takes.
_WRITE_FAILURES = (OSError, RuntimeError, ValueError, MemoryError)


def write_whole(path: Path, write: Callable[[Path], None]) -> None:
    """Let `write` fill a new file in the same folder, which then takes the name `path`.

    A reader sees the old file or the new one. Raises `RenderError` if that fails; the old file is
    then as it was, and nothing is left beside it.
    """
    try:
        target = path.resolve()  # of a link, the file that it names
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
            f"Cannot write {path}: {reason(error)}. Nothing was written there; free some space, "
            "or choose another place."
        ) from error


def write_text(path: Path, text: str) -> None:
    """`write_whole` of a text in UTF-8."""
    write_whole(path, lambda file: _write_text(file, text))


def make_folder(folder: Path, *names: str) -> None:
    """Make the folder for these files, and try whether they can be written; else `UsageError`."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(
            f"Cannot make the folder {folder}: {reason(error)}. Choose another with -o."
        ) from None
    for name in names:
        check_writable(folder / name)


def read_at_most(path: Path, most: int) -> bytes:
    """What a file holds. Raises OSError for what is no file, or longer than `most` bytes."""
    check_regular(path)
    with path.open("rb") as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise OSError(EFBIG, f"longer than {most >> 20} MiB")
    return content


def check_regular(path: Path) -> None:
    """Raise OSError for a pipe or a device, whose reading may never end, and for a folder."""
    mode = path.stat().st_mode
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(EISDIR, os.strerror(EISDIR), str(path))
    if not stat.S_ISREG(mode):
        raise OSError(EINVAL, "a pipe or a device, not a file", str(path))


def check_writable(path: Path) -> None:
    """Raise `UsageError` if `write_whole` could not write there; leaves nothing behind."""
    try:
        problem = _obstacle(path)
    except (OSError, RuntimeError, ValueError) as error:
        problem = reason(error)
    if problem:
        raise UsageError(f"Cannot write {path}: {problem}. Choose another place or name.")


def reason(error: BaseException) -> str:
    """What an error says, without its number and its full stop."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    if isinstance(error, UnicodeDecodeError):
        return "a text in it is damaged, or not in UTF-8"
    if isinstance(error, UnicodeEncodeError):
        return "a text for it, as the name of a file, has signs that UTF-8 cannot hold"
    return one_line(str(error) or type(error).__name__).rstrip(".")


def _write_text(file: Path, text: str) -> None:
    file.write_text(text, encoding="utf-8")


def _obstacle(path: Path) -> str | None:
    """Why a write would fail; raises what the system says if only trying tells.

    Permission bits say nothing to root, nor of a disk that is mounted read-only.
    """
    target = path.resolve()
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


def _no_folder(path: Path, target: Path) -> str:
    """`target` is where the path leads by its links."""
    if path.is_symlink():
        return f"it is a link to {target}, and there is no folder {target.parent}"
    if path.parent.is_symlink():
        return f"{path.parent} is a link to {target.parent}, and there is no such folder"
    return f"there is no folder {path.parent}"


def _next_to(target: Path) -> Path:
    return target.with_name(f".glrt-{secrets.token_hex(8)}{target.suffix}")


def _create(path: Path) -> None:
    """An empty file that did not exist, with the permissions that any new file gets."""
    os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))


def _rename(temporary: Path, target: Path) -> None:
    if target.exists():
        shutil.copymode(target, temporary)
    with temporary.open("rb+") as file:
        os.fsync(file.fileno())  # a full disk may speak up only here
    os.replace(temporary, target)


def unused(name: str) -> str:
    """The name of a file, with a number if there is one by that name: it is not ours to replace."""
    path, number = Path(name), 1
    while path.exists():
        number += 1
        path = path.with_stem(f"{Path(name).stem}-{number}")
    return str(path)
