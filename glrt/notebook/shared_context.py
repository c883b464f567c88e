"""One OpenGL context for all pictures of a notebook, used by one thread at a time.

Kernels may answer messages of pages in another thread than the one that runs cells. A context is
current in one thread at most, so a lock is held while it is.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from math import inf
from threading import RLock

from glrt.gpu.context import Context, open_context

HOLD = 0.5  # seconds after the input of a picture for which the others rest


class SharedContext:
    """A context that is opened when it is first used, and current only during a turn."""

    def __init__(self) -> None:
        """Open nothing yet."""
        self._lock = RLock()
        self._context: Context | None = None
        self._held: tuple[object, float] = (None, -inf)  # by which picture, and since when

    def hold(self, picture: object, now: float) -> None:
        """Note that a picture has got input, so that it has the machine to itself."""
        self._held = picture, now

    def is_held(self, picture: object, now: float) -> bool:
        """Whether another picture has got input in the last `HOLD` seconds."""
        holder, since = self._held
        return holder is not picture and now - since < HOLD

    @contextmanager
    def turn(self) -> Iterator[Context]:
        """Make the context current in this thread, after other threads have left it.

        Raises ContextError if none can be opened; the next turn tries again.
        """
        with self._lock:
            if self._context is None:
                self._context = open_context()
            with self._context.gl:
                yield self._context


SHARED = SharedContext()  # of this process
