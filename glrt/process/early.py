"""Exit on SIGINT, SIGTERM and SIGHUP with one line before the rest of glrt is imported.

This module imports nothing slow: before `leave_early`, Ctrl-C ends in a Python traceback.
"""

import os

try:
    import signal
except KeyboardInterrupt:
    os._exit(130)

INTERRUPTED = 128  # plus the number of the signal: the exit code
PLAIN = "interrupted"  # message of a command that renders no picture, or not yet

WATCHED = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)


def leave_at_once(number: int, _frame: object) -> None:
    """Signal handler: end the process without an exception.

    An exception while a compiled package is loaded can end in C++'s terminate: SIGABRT.
    """
    try:
        os.write(2, f"glrt: {PLAIN}\n".encode())
    finally:  # even if nobody reads stderr any more, as after SIGHUP
        os._exit(INTERRUPTED + number)


def leave_early() -> None:
    """Install `leave_at_once` for each signal, unless it is ignored, as nohup does."""
    for number in WATCHED:
        if signal.getsignal(number) not in (signal.SIG_IGN, None):
            signal.signal(number, leave_at_once)
