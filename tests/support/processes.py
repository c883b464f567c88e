"""Running the command as a user does: a process of its own."""

import os
import subprocess
import sys
from pathlib import Path


def glrt(
    *arguments: str | Path, cwd: Path | None = None, **environment: str
) -> "subprocess.CompletedProcess[str]":
    """Run `glrt` to its end."""
    return subprocess.run(
        [sys.executable, "-m", "glrt", *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=cwd,
        timeout=120,
        env={**os.environ, **environment},
    )


def start(*arguments: str | Path) -> "subprocess.Popen[str]":
    """Start `glrt` and go on."""
    return subprocess.Popen(
        [sys.executable, "-m", "glrt", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
