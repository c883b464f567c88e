"""The process of a command: start, standard streams, age and memory."""

import gc
import io
import json
import os
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

from glrt.core.errors import RenderError
from glrt.core.files import reason
from glrt.core.text import escaped
from glrt.process.early import leave_at_once
from glrt.process.signals import handled


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


class Patient(io.TextIOWrapper):
    """A stream that goes on when nobody takes what it is given: all later text goes nowhere.

    For stderr: a terminal that is closed during a render must not cost the picture.
    """

    def write(self, text: str) -> int:
        """Return the length of the text, whatever becomes of it."""
        try:
            return super().write(text)
        except OSError:
            silence(self)
            return len(text)

    def flush(self) -> None:
        """Write out what is pending, if possible."""
        try:
            super().flush()
        except OSError:
            silence(self)


def make_patient() -> None:
    """Let no failure to write to stderr end the command, nor a letter that stdout does not hold."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    old = sys.stderr
    if isinstance(old, io.TextIOWrapper):
        sys.stderr = Patient(old.buffer, old.encoding, old.errors, line_buffering=True)


def report(text: str) -> None:
    """A line on stderr, if that takes one."""
    try:
        print(text, file=sys.stderr, flush=True)
    except (OSError, ValueError):
        silence(sys.stderr)


def fail(message: str, code: int) -> int:
    """Tell why the command fails, in one paragraph; returns the exit code."""
    report(f"glrt: {escaped(message)}")
    return code


def file_names(outputs: Sequence[str | Path]) -> str:
    """Files that were written, for a message on one line."""
    return ", ".join(escaped(str(output)) for output in outputs)


def print_figures(figures: dict[str, Any], outputs: Sequence[str]) -> None:
    """A line of JSON on stdout; if that takes none, RenderError says that the files are saved."""
    try:
        print(json.dumps(figures), flush=True)
    except BrokenPipeError:
        raise
    except OSError as error:
        settle(sys.stdout)
        raise RenderError(
            f"The picture is saved in {file_names(outputs)}, but its figures could not be written "
            f"to standard output: {reason(error)}. Send them to another place."
        ) from None


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


@contextmanager
def loading() -> Iterator[None]:
    """While the modules of a command are imported: Ctrl-C leaves at once, nothing is collected.

    Imports take most of the first half second, and leave nothing that is garbage; so it is not
    looked for in them later either.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        with handled(leave_at_once):
            yield
    finally:
        if was_enabled:
            gc.freeze()
            gc.enable()


_IMPORTED = time.perf_counter()


def since_start() -> float:
    """Seconds since this process started; where the system does not tell, since the import."""
    return time.perf_counter() - _IMPORTED + _AGE_AT_IMPORT


def _process_age() -> float:
    """Linux: uptime minus start time, the 22nd word of /proc/self/stat, in clock ticks."""
    try:
        from os import sysconf

        started = float(Path("/proc/self/stat").read_text().rpartition(")")[2].split()[19])
        uptime = float(Path("/proc/uptime").read_text().split()[0])
        return max(0.0, uptime - started / sysconf("SC_CLK_TCK"))
    except (ImportError, OSError, ValueError, IndexError):
        return 0.0


_AGE_AT_IMPORT = _process_age()


def peak_bytes() -> int | None:
    """The most memory this process has held, in bytes; None where the system does not tell."""
    try:
        from resource import RUSAGE_SELF, getrusage
    except ImportError:
        return None
    unit = 1 if sys.platform == "darwin" else 1024
    return getrusage(RUSAGE_SELF).ru_maxrss * unit
