"""Long steps: a line for each on stderr, with the time it took. Its output is kept back."""

import os
import subprocess
import sys
import textwrap
import time
from typing import NoReturn


def say(text: str, end: str = "\n") -> None:
    print(text, end=end, file=sys.stderr, flush=True)


def fail(text: str) -> NoReturn:
    """End with one paragraph: what is wrong and what to do."""
    say(paragraph(text))
    sys.exit(1)


def paragraph(text: str) -> str:
    """Wrap to 100 columns; a line that starts with four spaces is a command and stays whole."""
    lines = text.splitlines()
    return "\n".join(line if line.startswith("    ") else _fill(line) for line in lines)


def _fill(line: str) -> str:
    return textwrap.fill(line, 100, break_on_hyphens=False)


def run(title: str, command: list[str], **variables: str) -> tuple[bool, str]:
    """Run a command without input; returns whether it succeeded, and what it printed."""
    say(f"{title} ...", end=" ")
    start = time.monotonic()
    done = subprocess.run(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env={**os.environ, **variables},
    )
    seconds = time.monotonic() - start
    say(f"{seconds:.1f} s" if done.returncode == 0 else f"failed after {seconds:.1f} s")
    return done.returncode == 0, done.stdout.decode(errors="replace")


def gist(printed: str, lines: int = 3) -> str:
    """The lines of a failed step that say why: its errors, or its last lines."""
    said = [line.strip() for line in printed.splitlines() if line.strip()]
    errors = [line for line in said if line.startswith(("ERROR", "E: ", "fatal"))]
    return " ".join((errors or said)[-lines:])
