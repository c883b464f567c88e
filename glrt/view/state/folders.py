"""What a folder holds, as a dialog shows it."""

from dataclasses import dataclass
from pathlib import Path

from glrt.core.files import reason


@dataclass(frozen=True)
class Listing:
    """Names in a folder, sorted without regard to case; `problem`: why there are none."""

    folders: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    problem: str = ""


def listing(folder: Path, suffixes: tuple[str, ...]) -> Listing:
    """Folders, and files with one of the suffixes; without those that begin with a dot."""
    try:
        paths = [path for path in folder.iterdir() if not path.name.startswith(".")]
        folders = [path.name for path in paths if path.is_dir()]
        files = [path.name for path in paths if path.suffix.lower() in suffixes and path.is_file()]
    except (OSError, ValueError) as error:
        return Listing(problem=f"{folder}: {reason(error)}")
    return Listing(_sorted(folders), _sorted(files))


def nearest_folder(path: Path) -> Path:
    """The path itself if it is a folder, else the first one above it that is there."""
    whole = path.expanduser().absolute()
    return next(folder for folder in (whole, *whole.parents) if folder.is_dir())


def _sorted(names: list[str]) -> tuple[str, ...]:
    return tuple(sorted(names, key=lambda name: (name.lower(), name)))
