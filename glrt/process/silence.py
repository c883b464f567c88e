"""Keep the output of compiled libraries out of the user's streams."""

import io
import os
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout, suppress

from glrt.process.signals import postponed

_ONE_AT_A_TIME = threading.Lock()


@contextmanager
def silenced() -> Iterator[None]:
    """Discard what Python or C prints to stdout and stderr inside the block.

    Earlier output is written out first. Signals wait until the end, so that their message is
    seen. Other threads are silenced too: do little inside.
    """
    with _ONE_AT_A_TIME, postponed(), ExitStack() as stack:
        for stream, number in ((sys.stdout, 1), (sys.stderr, 2)):
            with suppress(OSError, ValueError, AttributeError):  # full, closed or missing
                stream.flush()
            stack.enter_context(_to_nowhere(number))
        stack.enter_context(redirect_stdout(io.StringIO()))
        stack.enter_context(redirect_stderr(io.StringIO()))
        yield


@contextmanager
def _to_nowhere(number: int) -> Iterator[None]:
    """Redirect a file descriptor to the null device inside the block, if it is open."""
    try:
        kept = os.dup(number)
    except OSError:
        yield
        return
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        try:
            os.dup2(nowhere, number)
        finally:
            os.close(nowhere)
        yield
    finally:
        os.dup2(kept, number)
        os.close(kept)
