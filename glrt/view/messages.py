"""What the window tells the user: what was done, what went wrong, and what it asks."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from glrt.core.errors import GlrtError
from glrt.core.text import escaped
from glrt.view.state.session import Session

SHOWN = 5.0  # seconds that a message of what was done stays in sight


@dataclass(frozen=True)
class Question:
    """A box above the window: each answer by its name, with what it does. Escape does nothing."""

    title: str
    text: str
    answers: dict[str, Callable[[], object]]


@dataclass
class Messages:
    """One message, one problem and one question at a time; the problem is the session's."""

    session: Session
    last: str = ""  # what was done last
    told: float = 0.0  # when, by time.perf_counter
    question: Question | None = None

    def report(self, message: str) -> None:
        """Show for a while what was done."""
        self.last, self.told = escaped(message), time.perf_counter()

    def recent(self, now: float) -> str:
        """What was done a moment ago; "" for nothing."""
        return self.last if now - self.told < SHOWN else ""

    def complain(self, problem: str) -> None:
        """Show what went wrong, if anything did."""
        self.session.problem = escaped(problem) or self.session.problem

    @contextmanager
    def reporting(self) -> Iterator[None]:
        """Tell the user of an error, and go on."""
        try:
            yield
        except GlrtError as error:
            self.complain(str(error))

    def ask(self, title: str, text: str, **answers: Callable[[], object]) -> None:
        """Put a question; names of answers have _ for a blank."""
        shown = {name.replace("_", " "): act for name, act in answers.items()}
        self.question = Question(escaped(title), escaped(text), shown)
