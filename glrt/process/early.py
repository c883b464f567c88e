"""SIGINT, SIGTERM and SIGHUP before the rest of glrt is imported: no traceback, one line.

It imports nothing that takes time: until `leave_early`, Ctrl-C ends in a traceback of Python's.
"""

import os

try:
    import signal
except KeyboardInterrupt:
    os._exit(130)

INTERRUPTED = 128  # plus the number of the signal: the exit code
PLAIN = "interrupted"  # of a command that renders no picture, or not yet known to

WATCHED = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)


def leave_at_once(number: int, _frame: object) -> None:
    """A handler: ends the process without an exception.

    One that is raised while a compiled package is loaded can end in C++'s terminate: SIGABRT.
    """
    try:
        os.write(2, f"glrt: {PLAIN}\n".encode())
    finally:  # also where nobody reads any more, as after SIGHUP
        os._exit(INTERRUPTED + number)


def leave_early() -> None:
    """Leave at once at each of the signals, unless it is ignored, as by nohup."""
    for number in WATCHED:
        if signal.getsignal(number) not in (signal.SIG_IGN, None):
            signal.signal(number, leave_at_once)
