"""SIGINT, SIGTERM and SIGHUP: how they end the command, from its imports to its last file."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn

from glrt.process.early import INTERRUPTED as INTERRUPTED
from glrt.process.early import PLAIN as PLAIN
from glrt.process.early import WATCHED

NOTHING = "interrupted before anything was rendered"

_HANGUP = getattr(signal, "SIGHUP", None)  # which Windows does not have

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
    """Let `handler` take the signals inside, unless they are ignored, as by nohup.

    Only the main thread can; elsewhere, and where handlers are not Python's, nothing changes. Of
    SIGHUP the first is taken alone: a shell whose terminal is closed sends one, and the system
    another when the shell ends.
    """

    def take(number: int, frame: FrameType | None) -> None:
        try:
            handler(number, frame)
        finally:
            if number == _HANGUP:
                signal.signal(number, signal.SIG_IGN)

    is_main = threading.current_thread() is threading.main_thread()
    others = (signal.SIG_IGN, None)
    watched = [n for n in WATCHED if is_main and signal.getsignal(n) not in others]
    before = {number: signal.signal(number, take) for number in watched}
    try:
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)


@contextmanager
def postponed() -> Iterator[None]:
    """Let the signals wait until the end of the block: the first that came is raised anew.

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
