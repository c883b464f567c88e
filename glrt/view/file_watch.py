"""Watch files that other programs change, by their times."""

import stat
from collections.abc import Iterable
from pathlib import Path

INTERVAL = 0.5  # seconds between two looks


def watch_for(source: str) -> "Watch | None":
    """A watch over a scene file; None for a scene by name, and for a picture."""
    path = Path(source)
    return Watch([path]) if path.suffix.lower() == ".toml" and path.is_file() else None


class Watch:
    """A set of files; a look tells whether one of them has changed since the last."""

    def __init__(self, files: Iterable[Path]) -> None:
        """Remember the files as they are."""
        self._files = tuple(files)
        self._known = self._times()
        self._looked = 0.0

    def has_changed(self, now: float) -> bool:
        """Whether a file is another than at the last look; between two intervals, no."""
        if now - self._looked < INTERVAL:
            return False
        self._looked, known = now, self._known
        self._known = self._times()
        return self._known != known

    @property
    def has_lost(self) -> bool:
        """Whether one of them was no longer a file at the last look."""
        return _GONE in self._known

    def _times(self) -> tuple[tuple[int, int], ...]:
        return tuple(map(_time, self._files))


_GONE = (0, 0)


def _time(file: Path) -> tuple[int, int]:
    """Time of the last change in nanoseconds, and size; _GONE for what is no file."""
    try:
        state = file.stat()
    except OSError:
        return _GONE
    return (state.st_mtime_ns, state.st_size) if stat.S_ISREG(state.st_mode) else _GONE
