"""Standard streams, age and memory of the process of a command."""

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
from glrt.core.files import UNTOLD, reason
from glrt.core.text import escaped
from glrt.process.early import leave_at_once
from glrt.process.signals import handled


def open_missing() -> None:
    """Open the null device in place of each standard stream that is closed.

    Otherwise the next opened file would take its number, and receive what the driver writes to
    stderr.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest number that is free: this one
    sys.stdout = sys.stdout or open(1, "w", closefd=False)  # noqa: SIM115
    sys.stderr = sys.stderr or open(2, "w", closefd=False)  # noqa: SIM115


class Patient(io.TextIOWrapper):
    """A stream that survives a failed write: it discards all later text.

    It replaces stderr: a terminal that is closed during a render must not cost the picture.
    """

    def write(self, text: str) -> int:
        """Write a text, or discard it if that fails; returns its length in both cases."""
        try:
            return super().write(text)
        except OSError:
            silence(self)
            return len(text)

    def flush(self) -> None:
        """Write out the pending text, or discard it if that fails."""
        try:
            super().flush()
        except OSError:
            silence(self)


def make_patient() -> None:
    """Let the command survive failed writes to stderr, and characters that stdout cannot encode."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    old = sys.stderr
    if isinstance(old, io.TextIOWrapper):
        sys.stderr = Patient(old.buffer, old.encoding, old.errors, line_buffering=True)


def report(text: str) -> None:
    """Print a line to stderr; silence stderr if that fails."""
    try:
        print(text, file=sys.stderr, flush=True)
    except (OSError, ValueError):
        silence(sys.stderr)


def fail(message: str, code: int) -> int:
    """Report on stderr, in one paragraph, why the command fails; returns the exit code."""
    report(f"glrt: {escaped(message)}")
    return code


def file_names(outputs: Sequence[str | Path]) -> str:
    """Return the names of files for a message on one line."""
    return ", ".join(escaped(str(output)) for output in outputs)


def print_figures(figures: dict[str, Any], outputs: Sequence[str]) -> None:
    """Print a line of JSON to stdout; if that fails, RenderError says that the files are saved."""
    try:
        print(json.dumps(figures), flush=True)
    except BrokenPipeError:
        raise
    except OSError as error:
        settle(sys.stdout)
        raise RenderError(
            f"The picture is saved in {file_names(outputs)}, but its figures could not be written "
            f"to standard output: {reason(error, UNTOLD)}. Send them to another place."
        ) from None


def settle(stream: IO[str]) -> None:
    """Write out the pending text of a stream; silence the stream if that fails."""
    try:
        stream.flush()
    except (OSError, ValueError):
        silence(stream)


def silence(stream: IO[str]) -> None:
    """Redirect a broken stream to the null device, so that exit reports no further error."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


@contextmanager
def loading() -> Iterator[None]:
    """Import the modules of a command inside: Ctrl-C exits at once, garbage collection is off.

    Imports take most of the first half second and leave no garbage. Their objects are frozen, so
    that later collections skip them too.
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
    """Return seconds since this process started; if that is unknown, since this import."""
    return time.perf_counter() - _IMPORTED + _AGE_AT_IMPORT


def _process_age() -> float:
    """Return the age of this process in seconds; 0 where the system does not report it.

    Linux: uptime minus start time, the 22nd word of /proc/self/stat, in clock ticks.
    """
    try:
        from os import sysconf

        started = float(Path("/proc/self/stat").read_text().rpartition(")")[2].split()[19])
        uptime = float(Path("/proc/uptime").read_text().split()[0])
        return max(0.0, uptime - started / sysconf("SC_CLK_TCK"))
    except (ImportError, OSError, ValueError, IndexError):
        return 0.0


_AGE_AT_IMPORT = _process_age()


def peak_bytes() -> int | None:
    """Return the peak memory of this process in bytes; None where the system does not report it."""
    try:
        from resource import RUSAGE_SELF, getrusage
    except ImportError:
        return None
    unit = 1 if sys.platform == "darwin" else 1024
    return getrusage(RUSAGE_SELF).ru_maxrss * unit
