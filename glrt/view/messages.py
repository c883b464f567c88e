"""Messages of the window to the user: finished actions, problems and questions."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from glrt.core.errors import GlrtError
from glrt.core.text import escaped
from glrt.view.state.session import Session

SHOWN = 5.0  # seconds for which a finished action is shown


Then = Callable[[], object]


def nothing() -> None:
    """Do nothing."""


@dataclass(frozen=True)
class Question:
    """Question of a popup; `answers` maps texts of buttons to actions, and Escape cancels."""

    title: str
    text: str
    answers: dict[str, Callable[[], object]]


@dataclass
class Messages:
    """One message, one problem and one question at a time; the session holds the problem."""

    session: Session
    last: str = ""  # last finished action
    told: float = 0.0  # time of that action, by time.perf_counter
    question: Question | None = None

    def report(self, message: str) -> None:
        """Show a finished action for SHOWN seconds."""
        self.last, self.told = escaped(message), time.perf_counter()

    def recent(self, now: float) -> str:
        """Return the action that finished less than SHOWN seconds ago; "" if there is none."""
        return self.last if now - self.told < SHOWN else ""

    def complain(self, problem: str) -> None:
        """Show a problem; "" keeps the problem that is shown."""
        self.session.problem = escaped(problem) or self.session.problem

    @contextmanager
    def reporting(self) -> Iterator[None]:
        """Show a GlrtError of the block as a problem, and continue."""
        try:
            yield
        except GlrtError as error:
            self.complain(str(error))

    def ask(self, title: str, text: str, **answers: Callable[[], object]) -> None:
        """Ask a question; `_` in the name of an answer stands for a blank."""
        shown = {name.replace("_", " "): act for name, act in answers.items()}
        self.question = Question(escaped(title), escaped(text), shown)
