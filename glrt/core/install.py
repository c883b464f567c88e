"""The command that installs an optional package."""

import shlex
import sys
from contextlib import suppress
from pathlib import Path

_ROOT = Path(__file__).parents[2]  # of a checkout


def install(extra: str) -> str:
    """Return the command that adds an extra of glrt to the Python that runs.

    glrt comes as a checkout or as a wheel. pip takes its extras from there, for no index has it.
    """
    pip = [_typed(Path(sys.executable)), "-m", "pip", "install"]
    if not (_ROOT / "pyproject.toml").is_file():
        return shlex.join([*pip, f"glrt[{extra}]"])
    return shlex.join([*pip, "-e", f"{_typed(_ROOT)}[{extra}]"])


def _typed(path: Path) -> str:
    """Return a path as it is typed in the current folder."""
    with suppress(OSError, ValueError):
        return str(path.relative_to(Path.cwd()))
    return str(path)
