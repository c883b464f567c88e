"""SIGINT and SIGTERM: how they end the command, from its first import to its last file."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
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
        self.number = number


def exit_code_of(error: KeyboardInterrupt) -> int:
    """The exit code of a command that this ended; Python's own is of SIGINT."""
    return INTERRUPTED + int(getattr(error, "number", signal.SIGINT))


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
