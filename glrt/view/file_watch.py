"""Watch files for changes by other programs, by modification time and size."""

import stat
from collections.abc import Iterable
from pathlib import Path

INTERVAL = 0.5  # seconds between two checks


def watch_for(source: str) -> "Watch | None":
    """Return a watch over a scene file; None for a scene by name, a model or a picture."""
    path = Path(source)
    return Watch([path]) if path.suffix.lower() == ".toml" and path.is_file() else None


class Watch:
    """A set of files; a check detects whether one has changed since the last check."""

    def __init__(self, files: Iterable[Path]) -> None:
        """Remember the present times and sizes of the files."""
        self._files = tuple(files)
        self._known = self._times()
        self._looked = 0.0

    def has_changed(self, now: float) -> bool:
        """Whether a file has changed since the last check; False if that was under INTERVAL ago."""
        if now - self._looked < INTERVAL:
            return False
        self._looked, known = now, self._known
        self._known = self._times()
        return self._known != known

    @property
    def has_lost(self) -> bool:
        """Whether one of the files was missing at the last check."""
        return _GONE in self._known

    def _times(self) -> tuple[tuple[int, int], ...]:
        return tuple(map(_time, self._files))


_GONE = (0, 0)


def _time(file: Path) -> tuple[int, int]:
    """Return modification time in nanoseconds and size; _GONE if it is not a regular file."""
    try:
        state = file.stat()
    except OSError:
        return _GONE
    return (state.st_mtime_ns, state.st_size) if stat.S_ISREG(state.st_mode) else _GONE
