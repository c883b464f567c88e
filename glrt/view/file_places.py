"""Places of files, and how messages name them."""

import os
from pathlib import Path


def folder_of(source: str) -> Path:
    """Return the folder of what is open, in which its recipe finds its files; else "."."""
    file = Path(source)
    is_usable = bool(source) and file.is_file() and os.access(file.parent, os.W_OK)
    return file.parent if is_usable else Path()


def where(file: Path) -> str:
    """Return the name of a file and its folder in words."""
    whole = file.absolute()
    return f"{whole.name} in {whole.parent}"
