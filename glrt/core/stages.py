"""Stages of long work, reported to the one who waits for it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

Listener = Callable[[str, float], None]  # name of a stage, and the share of it that is done

_listener: ContextVar[Listener | None] = ContextVar("listener", default=None)


@contextmanager
def listened(listener: Listener) -> Iterator[None]:
    """Call `listener` for each report of the block, in this thread; it may raise to end work."""
    token = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(token)


def report(stage: str, share: float) -> None:
    """Report that a stage has begun or goes on; `share` is from 0 to 1."""
    listener = _listener.get()
    if listener:
        listener(stage, share)
