"""A lock on the frames of a film: one command at a time renders into their folder."""

import os
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from glrt.core.errors import RenderError
from glrt.core.files import UNTOLD, reason

try:
    import fcntl
except ImportError:  # where the system has no such locks, two films are not kept apart
    fcntl = None  # type: ignore[assignment]

NAME = "lock"
_LONGEST = 200  # letters that are read from a lock


@contextmanager
def locked(folder: Path, output: Path) -> Iterator[None]:
    """Hold the lock of a folder of frames for the film `output`.

    The system frees it when the process ends, however it ends. Raises `RenderError` if another
    process holds it, or if it cannot be written.
    """
    if fcntl is None:
        yield
        return
    file = folder / NAME
    try:
        lock = _taken(file)
    except BlockingIOError:
        raise RenderError(
            f"{output} is being rendered by {_holder(file)}, into {folder}. Wait until that has "
            "ended, or choose another name with -o."
        ) from None
    except OSError as error:
        raise RenderError(f"Cannot lock {folder}: {reason(error, UNTOLD)}.") from None
    try:
        yield
    finally:
        with suppress(OSError):
            file.unlink()
        os.close(lock)
        with suppress(OSError):  # it holds frames that are to stay
            folder.rmdir()


def _taken(file: Path) -> int:
    """Return the lock as an open file; BlockingIOError if another process holds it."""
    while True:
        file.parent.mkdir(parents=True, exist_ok=True)
        try:
            lock = os.open(file, os.O_RDWR | os.O_CREAT, 0o666)
        except FileNotFoundError:  # a film that has just ended removed the folder
            continue
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(lock)
            raise
        if _is_at(lock, file):
            break
        os.close(lock)  # a film that has just ended removed the file
    os.ftruncate(lock, 0)
    now = time.strftime("%Y-%m-%d %H:%M:%S")
    os.write(lock, f"process {os.getpid()} on {socket.gethostname()} since {now}".encode())
    return lock


def _is_at(lock: int, file: Path) -> bool:
    with suppress(OSError):
        return os.path.samestat(os.fstat(lock), file.stat())
    return False


def _holder(file: Path) -> str:
    """Return who holds a lock, as it says itself."""
    with suppress(OSError):
        if text := file.read_text("utf-8", "replace")[:_LONGEST].strip():
            return text
    return "another process"
