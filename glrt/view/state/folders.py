"""Contents of a folder, as a dialog shows them."""

from dataclasses import dataclass
from pathlib import Path

from glrt.core.files import reason


@dataclass(frozen=True)
class Listing:
    """Names in a folder, sorted without regard to case; `problem`: why it cannot be read."""

    folders: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    problem: str = ""


def listing(folder: Path, suffixes: tuple[str, ...]) -> Listing:
    """Return folders, and files with one of the suffixes; names with a leading dot are hidden."""
    try:
        paths = [path for path in folder.iterdir() if not path.name.startswith(".")]
        folders = [path.name for path in paths if path.is_dir()]
        files = [path.name for path in paths if path.suffix.lower() in suffixes and path.is_file()]
    except (OSError, ValueError) as error:
        return Listing(problem=f"{folder}: {reason(error)}")
    return Listing(_sorted(folders), _sorted(files))


def nearest_folder(path: Path) -> Path:
    """Return the path if it is a folder, else the nearest existing folder above it."""
    whole = path.expanduser().absolute()
    return next(folder for folder in (whole, *whole.parents) if folder.is_dir())


def _sorted(names: list[str]) -> tuple[str, ...]:
    return tuple(sorted(names, key=lambda name: (name.lower(), name)))
