"""Threads for the parts of a computation in numpy, which lets other threads run meanwhile."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Part = TypeVar("Part")
Result = TypeVar("Result")


def concurrently(work: Callable[[Part], Result], parts: Iterable[Part]) -> list[Result]:
    """Return the result of `work` for each part, by as many threads as there are processors.

    Parts must not depend on each other. A single part takes no thread. An error of `work` is
    raised.
    """
    every = list(parts)
    many = min(len(every), _processors())
    if many < 2:
        return [work(part) for part in every]
    with ThreadPoolExecutor(many) as threads:
        return list(threads.map(work, every))


def _processors() -> int:
    """Processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
