"""Give the tasks of a job to the workers of a cluster, and yield each answer once."""

import secrets
import time
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, field
from queue import Empty, SimpleQueue
from typing import Any

from glrt.cluster import entry
from glrt.cluster.clusters import DEATHS
from glrt.cluster.worker import Job, packed
from glrt.core.errors import ContextError, GlrtError, RenderError, UsageError
from glrt.core.version import VERSION
from glrt.rendering.stopping import Interruption

TICK = 0.5  # seconds between looks at signals and at the scheduler
LOOK = 2.0  # seconds between looks at which workers there are
FETCH = 60.0  # seconds for an answer to arrive
_FAILURES = {
    "KilledWorker": f"{DEATHS} workers ended while they rendered it, perhaps for lack of memory",
}
_UNKNOWN = "a worker failed in a way that glrt does not know ({failure})"
_ERRORS = {error.exit_code: error for error in (UsageError, ContextError, RenderError)}


@dataclass
class Crew:
    """The workers of a cluster, seen from its client.

    `say` gets sentences for the user; `show` gets tasks done, tasks in all, and workers present.
    """

    client: Any
    place: str
    context: str
    interruption: Interruption
    say: Callable[[str], None]
    show: Callable[[int, int, int], None] = lambda done, count, workers: None
    advice: str = ""  # for the end of a message, when the cluster ends
    renderer: str = ""  # the driver whose bits are wanted
    refused: set[str] = field(default_factory=set)  # addresses
    _waits: bool = False
    _present: frozenset[str] = frozenset()
    _looked: float = 0.0

    def answers(self, job: Job, numbers: Collection[int]) -> Iterator[tuple[int, Any]]:
        """Yield number and value of each task once, as they arrive; a value may be a `RenderError`.

        Ends early after an interruption. A task whose worker ended is done again. Raises
        `RenderError` if the scheduler ends, or no worker fits, and the `GlrtError` of a task.
        """
        if not numbers or not (self.renderer or self.choose_driver()):
            return
        parcel, digest = packed(job)
        held = self.client.submit(entry.same, parcel, key=f"glrt-{digest}")
        tasks = _Tasks(self, held, digest)
        tasks.give(numbers)
        try:
            while tasks.numbers and self._goes_on():
                count = len(numbers)
                self.show(count - len(tasks.numbers), count, len(self._present - self.refused))
                tasks.rescue(self._present)
                if found := tasks.arrived():
                    yield found
        finally:
            if self.client.status == "running":
                self.client.cancel(list(tasks.futures), force=True)

    def refuse(self, answer: dict[str, Any]) -> None:
        """Give no more tasks to the worker of an answer that says why it is unfit."""
        if answer["address"] not in self.refused:
            self.refused.add(answer["address"])
            self.say(f"worker {answer['worker']} takes no part: {answer['unfit'].rstrip('.')}.")

    def fit(self) -> list[str]:
        """Return the addresses of workers that may get tasks."""
        self._look(at_once=True)
        return sorted(self._present - self.refused)

    def fit_ones(self) -> list[str]:
        """Return what `fit` returns; raises `RenderError` if that is nothing."""
        if found := self.fit():
            return found
        raise RenderError(f"no worker of {self.place} is left that can render. {self.advice}")

    def choose_driver(self) -> bool:
        """Ask the workers for their drivers, and want the most common; False if interrupted."""
        while not (present := self.fit()):
            if not self._goes_on():
                return False
            time.sleep(TICK / 5)
        drivers = list[str]()
        for address, future in [(address, self._asked(address)) for address in present]:
            while future.status == "pending" and address in self._present:
                if not self._goes_on():
                    return False
                time.sleep(TICK / 10)
            answer = self.result(future) if future.done() else {"failure": "it ended"}
            if "unfit" in answer:
                self.refuse(answer)
            elif "renderer" in answer:
                drivers.append(answer["renderer"])
        if not drivers:
            raise RenderError(f"no worker of {self.place} can render. {self.advice}")
        self.renderer = max(sorted(set(drivers)), key=drivers.count)
        return True

    def _asked(self, address: str) -> Any:
        """Return the future of a worker's driver."""
        place = {"workers": [address], "allow_other_workers": False, "pure": False}
        return self.client.submit(entry.do, None, b"", "", VERSION, "", self.context, **place)

    def result(self, future: Any) -> dict[str, Any]:
        """Return the answer of a task that is done; raises `RenderError`."""
        try:
            return dict(future.result(timeout=FETCH))
        except GlrtError:
            raise
        except Exception as error:
            self._check()
            return {"failure": type(error).__name__}

    def _goes_on(self) -> bool:
        self._check()
        self._look()
        return self.interruption.signal is None

    def _check(self) -> None:
        if self.client.status != "running":
            raise RenderError(
                f"The scheduler of {self.place} ended, or cannot be reached. {self.advice}"
            )

    def _look(self, at_once: bool = False) -> None:
        if not at_once and time.monotonic() < self._looked + LOOK:
            return
        try:
            self._present = frozenset(self.client.scheduler_info(n_workers=-1)["workers"])
        except Exception:  # the scheduler has ended, as `_check` finds
            self._present = frozenset()
        self._looked = time.monotonic()
        if not self._present and not self._waits:
            self.say(f"no worker is at {self.place}; waiting for one.")
        self._waits = not self._present


class _Tasks:
    """The tasks that are not done, by the keys of their futures."""

    def __init__(self, crew: Crew, held: Any, digest: str) -> None:
        self._crew, self._held, self._digest = crew, held, digest
        self._arrivals: SimpleQueue[Any] = SimpleQueue()
        self._pins = dict[Any, frozenset[str]]()  # workers that may do a task; others: all
        self.futures = dict[Any, Any]()
        self.numbers = dict[Any, int]()

    def give(self, numbers: Iterable[int], workers: Collection[str] = ()) -> None:
        """Give tasks to all workers, or to these alone."""
        numbers = list(numbers)
        group = f"glrt-{self._digest[:12]}-{secrets.token_hex(4)}"
        futures = self._crew.client.map(
            *(entry.do, numbers),
            key=[(group, number) for number in numbers],
            workers=sorted(workers) or None,
            parcel=self._held,
            digest=self._digest,
            version=VERSION,
            renderer=self._crew.renderer,
            context=self._crew.context,
        )
        for number, future in zip(numbers, futures, strict=True):
            self.futures[future.key], self.numbers[future.key] = future, number
            if workers:
                self._pins[future.key] = frozenset(workers)
            future.add_done_callback(self._arrivals.put)

    def rescue(self, present: frozenset[str]) -> None:
        """Give tasks again whose workers have all gone."""
        for key in [key for key, pins in self._pins.items() if not pins & present]:
            self._crew.client.cancel([self.futures[key]], force=True)
            self._again(self._drop(key))

    def arrived(self) -> tuple[int, Any] | None:
        """Wait a little for an answer; a task without its value is given again, or has failed."""
        try:
            future = self._arrivals.get(timeout=TICK)
        except Empty:
            return None
        if future.key not in self.numbers or future.status == "lost":
            return None
        answer = self._crew.result(future)
        number = self._drop(future.key)
        if "unfit" in answer:
            self._crew.refuse(answer)
            self._again(number)
            return None
        if "failure" in answer:
            if answer["failure"] == "CancelledError":
                self._again(number)
                return None
            return number, RenderError(_FAILURES.get(answer["failure"], _UNKNOWN).format(**answer))
        if problem := answer.get("problem"):
            text, code = problem
            raise _ERRORS[code](f"worker {answer['worker']}: {text}")
        return number, answer["value"]

    def _again(self, number: int) -> None:
        self.give([number], self._crew.fit_ones() if self._crew.refused else ())

    def _drop(self, key: Any) -> int:
        self.futures.pop(key)
        self._pins.pop(key, None)
        return self.numbers.pop(key)
