"""How the error falls while a picture is rendered, and when it will be small enough."""

from typing import NamedTuple

GROWTH = 1.25  # of the samples from one look at the error to the next: looking costs time
PAUSE = 0.5  # seconds between two looks, at least


class Look(NamedTuple):
    """The estimated relative error after some samples and seconds of rendering."""

    samples: int
    seconds: float
    error: float


class Progress:
    """Looks at one picture, from its first sample on."""

    def __init__(self) -> None:
        """No look yet."""
        self.looks: list[Look] = []
        self._picture = -1
        self._looked = 0.0

    def is_due(self, picture: int, samples: int, now: float) -> bool:
        """Whether to look at the error now; another picture forgets the looks at the one before.

        `picture` numbers pictures: it changes with each restart.
        """
        if picture != self._picture:
            self._picture, self.looks = picture, []
        least = GROWTH * self.looks[-1].samples if self.looks else 2
        return samples >= least and now - self._looked >= PAUSE

    def record(self, look: Look, now: float) -> None:
        """Remember a look."""
        self._looked = now
        self.looks.append(look)

    @property
    def error(self) -> float | None:
        """The error at the last look."""
        return self.looks[-1].error if self.looks else None

    def remaining(self, target: float) -> float | None:
        """Seconds of rendering to an error, which falls with the root of time; None if unknown."""
        if not self.looks:
            return None
        last = self.looks[-1]
        return max(0.0, last.seconds * ((last.error / target) ** 2 - 1))

    def slope(self) -> tuple[list[float], list[float]]:
        """Seconds and errors of the line of slope -1/2 through the last look."""
        first, last = self.looks[0], self.looks[-1]
        seconds = [first.seconds, last.seconds]
        return seconds, [last.error * (last.seconds / max(s, 1e-9)) ** 0.5 for s in seconds]
