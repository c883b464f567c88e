"""Recently opened files, kept in a file of the user next to the preferences."""

import json
from pathlib import Path

from glrt.core.errors import RenderError
from glrt.core.files import write_text

MOST = 10


def load_recent(file: Path) -> tuple[str, ...]:
    """Return recent paths and scene names, the last first; empty if the file cannot be read."""
    try:
        given = json.loads(file.read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return ()
    names = given if isinstance(given, list) else []
    return tuple(name for name in names if isinstance(name, str))[:MOST]


def with_opened(recent: tuple[str, ...], source: str) -> tuple[str, ...]:
    """Return the list with one more in front; a file by its absolute path, valid anywhere."""
    path = Path(source)
    name = str(path.absolute()) if path.is_file() else source
    return (name, *(other for other in recent if other != name))[:MOST]


def save_recent(recent: tuple[str, ...], file: Path) -> str:
    """Write the list; returns what went wrong, "" for nothing."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        write_text(file, json.dumps(recent, indent=2) + "\n")
    except (OSError, RenderError) as error:
        return f"The list of recent files cannot be kept: {error}"
    return ""
