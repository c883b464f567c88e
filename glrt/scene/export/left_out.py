"""Reports of parts that a file of another program cannot hold."""

from collections.abc import Callable

from glrt.core.text import counted

Report = Callable[[str], None]
_MOST_NAMED = 8


class LeftOut:
    """Parts that are left out or changed, each once, in the order of their reports."""

    def __init__(self) -> None:
        self._things = dict[str, None]()

    def __call__(self, thing: str) -> None:
        """Report a thing."""
        self._things.setdefault(thing)

    @property
    def things(self) -> list[str]:
        """All that was reported."""
        return list(self._things)


def told(left_out: list[str]) -> str:
    """Return what a file lacks in one sentence; empty if it lacks nothing."""
    more = len(left_out) - _MOST_NAMED
    rest = f" and {counted(more, 'other part')}" if more > 0 else ""
    return f"left out: {', '.join(left_out[:_MOST_NAMED])}{rest}" if left_out else ""
