"""SIGINT and SIGTERM: how the command ends by them, from its first import to its last file."""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import NoReturn

INTERRUPTED = 128  # plus the number of the signal: the exit code
PLAIN = "interrupted"  # of a command that renders no picture, or not yet known to
NOTHING = "interrupted before anything was rendered"

_WATCHED = (signal.SIGINT, signal.SIGTERM)

Handler = Callable[[int, FrameType | None], None]


class Interrupted(KeyboardInterrupt):
    """What ends a command that has nothing to save."""

    def __init__(self, number: int) -> None:
        """`number` of the signal."""
        super().__init__()
        self.exit_code = INTERRUPTED + number


@contextmanager
def handled(handler: Handler) -> Iterator[None]:
    """Let `handler` take the two signals inside, unless they are ignored, as by nohup.

    Only the main thread can; elsewhere, and where handlers are not Python's, nothing changes.
    """
    is_main = threading.current_thread() is threading.main_thread()
    others = (signal.SIG_IGN, None)
    watched = [n for n in _WATCHED if is_main and signal.getsignal(n) not in others]
    before = {number: signal.signal(number, handler) for number in watched}
    try:
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)


@contextmanager
def postponed() -> Iterator[None]:
    """Let the two signals wait until the end of the block: the first that came is raised anew.

    For compiled code that calls Python and takes for granted that no exception comes of it.
    """
    arrived: list[int] = []
    try:
        with handled(lambda number, _frame: arrived.append(number)):
            yield
    finally:
        for number in arrived[:1]:
            signal.raise_signal(number)


def interrupt(number: int, _frame: FrameType | None) -> NoReturn:
    """A handler: raises Interrupted."""
    raise Interrupted(number)


def is_command() -> bool:
    """Whether this process is the command `glrt`, not a program that imports it."""
    words = sys.orig_argv[1:3]
    return words == ["-m", "glrt"] or any(Path(word).stem == "glrt" for word in words[:1])


def leave_at_once_while_loading() -> None:
    """Where the process is the command: no traceback from an import that Ctrl-C meets.

    Imports take most of the first half second. Nothing is open yet that must be closed.
    """
    if is_command():
        for number in _WATCHED:
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, leave_at_once)


def loaded() -> None:
    """The command's own handling takes over: Ctrl-C raises KeyboardInterrupt again."""
    if signal.getsignal(signal.SIGINT) is leave_at_once:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if signal.getsignal(signal.SIGTERM) is leave_at_once:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


def leave_at_once(number: int, _frame: FrameType | None) -> None:
    """A handler: ends the process without an exception.

    One that is raised while a compiled package is loaded can end in C++'s terminate: SIGABRT.
    """
    os.write(2, f"glrt: {PLAIN}\n".encode())
    os._exit(INTERRUPTED + number)
