"""Locks of files, which the system opens when their process ends, however it ends."""

import sys
from contextlib import suppress
from pathlib import Path
from typing import IO

if sys.platform == "win32":
    import msvcrt

    def _lock(file: IO[bytes]) -> None:
        """Lock an open file; OSError if another process has locked it."""
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)

else:
    import fcntl

    def _lock(file: IO[bytes]) -> None:
        """Lock an open file; OSError if it is locked."""
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


class Claim:
    """A locked file; while it is locked, no other window takes what belongs to it."""

    def __init__(self, path: Path) -> None:
        """Create the file unless it is there, and lock it; OSError if another has locked it."""
        self._path, self._file = path, path.open("ab")
        try:
            _lock(self._file)
        except OSError:
            self._file.close()
            raise

    def release(self) -> None:
        """Let another window claim the file."""
        self._file.close()

    def remove(self) -> None:
        """Unlock the file and remove it."""
        self.release()
        with suppress(OSError):
            self._path.unlink(missing_ok=True)
