"""Standard streams as shells may leave them: closed, full, or with nobody at the other end."""

import os
import sys
from contextlib import suppress
from typing import IO


def open_missing() -> None:
    """Give nothing to write to where a stream is closed.

    Else the next file that is opened takes its number, and gets what the driver tells stderr.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest number that is free: this one
    sys.stdout = sys.stdout or open(1, "w", closefd=False)  # noqa: SIM115
    sys.stderr = sys.stderr or open(2, "w", closefd=False)  # noqa: SIM115


def tell(text: str) -> None:
    """A line on stderr, if that takes one."""
    try:
        print(text, file=sys.stderr, flush=True)
    except (OSError, ValueError):
        silence(sys.stderr)


def fail(message: str, code: int) -> int:
    """Tell why the command fails, in one paragraph; returns the exit code."""
    tell(f"glrt: {' '.join(message.split())}")
    return code


def settle(stream: IO[str]) -> None:
    """Write out what is pending; silence a stream that does not take it."""
    try:
        stream.flush()
    except (OSError, ValueError):
        silence(stream)


def silence(stream: IO[str]) -> None:
    """What is still to be written to a broken stream goes nowhere, so that exit is quiet."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
