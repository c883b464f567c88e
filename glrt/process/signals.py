"""Handle SIGINT, SIGTERM and SIGHUP in a command, from its imports to its last file."""

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

_HANGUP = getattr(signal, "SIGHUP", None)  # Windows has none

Handler = Callable[[int, FrameType | None], None]


class Interrupted(KeyboardInterrupt):
    """Exception that ends a command which has nothing to save when a signal arrives."""

    def __init__(self, number: int) -> None:
        """Remember the number of the signal."""
        super().__init__()
        self.number = number


def exit_code_of(error: KeyboardInterrupt) -> int:
    """Return the exit code after an interruption: 128 + its signal, SIGINT if it names none."""
    return INTERRUPTED + int(getattr(error, "number", signal.SIGINT))


@contextmanager
def handled(handler: Handler) -> Iterator[None]:
    """Let `handler` handle the signals inside, unless they are ignored, as nohup does.

    Only the main thread can set handlers: in other threads nothing changes, nor for handlers that
    Python did not set. Only the first SIGHUP is handled: a shell whose terminal is closed sends
    one, and the system sends another when the shell ends.
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
    """Delay signals until the end of the block, then raise the first that arrived again.

    This protects compiled code that calls Python and assumes that the call raises no exception.
    """
    arrived: list[int] = []
    try:
        with handled(lambda number, _frame: arrived.append(number)):
            yield
    finally:
        for number in arrived[:1]:
            signal.raise_signal(number)


def interrupt(number: int, _frame: FrameType | None) -> NoReturn:
    """Signal handler: raise Interrupted."""
    raise Interrupted(number)
