"""Error of a picture over time, and a forecast of when it will reach a target."""

import math
from collections.abc import Hashable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.error.estimate import Band, error_band
from glrt.error.reliability_of_scene import judged
from glrt.plan.plan import Plan, Weights, are_trivial
from glrt.rendering.renderer import Renderer
from glrt.view.state.histogram import DARK, Histogram, histogram
from glrt.view.state.session import Session

Array = NDArray[Any]

GROWTH = 1.25  # factor of the samples between looks at the error: a look takes time
PAUSE = 0.5  # seconds between two looks, at least
MARGIN = 1.6  # factor by which a plot exceeds its looks: its square is more than 5 / 2
FARTHEST = 100.0  # times as long as so far: largest forecast that a plot shows
EMPTY = (0.1, 100.0, 0.01, 1.0)  # the limits of a plot that has no line yet
_THREAD = ThreadPoolExecutor(1, "figures")  # one look at a time, so that it takes one core


class Look(NamedTuple):
    """Figures of a picture after some samples and seconds of rendering."""

    samples: int
    seconds: float
    band: Band  # of the relative error
    mean: float = 1.0  # radiance, over pixels and channels
    nonfinite: int = 0  # samples that were dropped
    is_doubtful: bool | None = None  # whether the error may be far too small; None: not known
    histogram: Histogram = DARK

    @property
    def error(self) -> float:
        """The estimated relative error."""
        return self.band.error


class Reading(NamedTuple):
    """Values of a picture that a look needs; without OpenGL, a thread can use them."""

    plan: Plan
    samples: int
    seconds: float  # of rendering
    radiance: Array  # (H, W, 3), weighted
    stderr: Array  # (H, W, 3), of the radiance
    nonfinite: int  # samples that were dropped
    is_plain: bool  # whether no layer is weighted

    def look(self) -> Look | None:
        """Return the figures of the picture; None without an error yet. It takes up to seconds."""
        band = error_band(self.radiance, self.stderr)
        if band is None:
            return None
        mean = float(self.radiance.mean(dtype=np.float64))
        picture = (self.samples, self.radiance, self.stderr)
        doubt = judged(self.plan.scene, self.plan.settings, *picture) if self.is_plain else None
        counts = histogram(self.radiance)
        return Look(self.samples, self.seconds, band, mean, self.nonfinite, doubt, counts)


def read(renderer: Renderer, weights: Weights, seconds: float) -> Reading:
    """Read a picture, its layers weighted; needs a current context."""
    film, plan = renderer.film, renderer.plan
    picture = renderer.picture(weights)
    return Reading(
        plan, film.samples, seconds, *picture, film.dropped(), bool(are_trivial(weights))
    )


class Progress:
    """Looks at one picture since its first sample, separate from looks under another light."""

    def __init__(self, in_thread: bool = False) -> None:
        """Begin without a look; a thread computes figures on request, as they take up to 1.5 s."""
        self.looks: list[Look] = []
        self._relit: list[Look] = []  # under another light
        self._picture: Hashable = None
        self._light: Hashable = None
        self._looked = 0.0
        self._in_thread = in_thread
        self._awaited: Future[Look | None] | None = None

    @property
    def is_looking(self) -> bool:
        """Whether a thread computes figures, or has computed some that were not taken yet."""
        return self._awaited is not None

    def follow(self, session: Session, now: float) -> Look | None:
        """Look at the picture if that is due, and return the look; call it once a frame.

        A look of a thread is returned by a later call, unless the picture is another one by then.
        """
        renderer = session.renderer
        if not renderer:
            return None
        self.begin(session.restarts, session.weights)
        if self._awaited:
            return self._taken(self._awaited, now)
        has_history = session.moving.is_shown(renderer, session.settings.samples)
        if session.is_passing or has_history or session.samples < session.known_from:
            return None  # of fewer samples no error is known, and reading them takes time
        if not self.is_due(session.samples, now, session.is_done):
            return None
        reading = read(renderer, session.weights, session.rendering)
        if self._in_thread:
            self._awaited = _THREAD.submit(reading.look)
            return None
        look = reading.look()
        self.record(look, now)
        return look

    def _taken(self, awaited: "Future[Look | None]", now: float) -> Look | None:
        """Return the look that a thread has finished, and record it; None before that."""
        if not awaited.done():
            return None
        self._awaited = None
        look = awaited.result()
        self.record(look, now)
        return look

    def begin(self, picture: Hashable, light: Hashable) -> None:
        """Forget the looks at another picture; set those under another light aside.

        `picture` identifies the picture: it changes with each restart.
        """
        if (picture, light) != (self._picture, self._light):
            self._awaited = None  # what it finds is of another picture
        if picture != self._picture:
            self.looks, self._relit = [], []
        elif light != self._light:
            self.looks, self._relit = [], [*self._relit, *self.looks]
        self._picture, self._light = picture, light

    def is_due(self, samples: int, now: float, is_done: bool = False) -> bool:
        """Whether to look at the error now.

        A picture that `is_done` is looked at once more, for the error of all its samples.
        """
        least = GROWTH * self.looks[-1].samples if self.looks else 2
        if is_done and self.looks:
            least = self.looks[-1].samples + 1
        return samples >= least and now - self._looked >= PAUSE

    def record(self, look: Look | None, now: float) -> None:
        """Remember the time of a look, and the look unless it is None."""
        self._looked = now
        self.looks += [look] if look else []

    @property
    def last(self) -> Look | None:
        """The last look."""
        return self.looks[-1] if self.looks else None

    @property
    def drawn(self) -> list[Look]:
        """Looks that logarithmic axes can show: a black picture has no error."""
        return _placed(self.looks)

    @property
    def relit(self) -> list[Look]:
        """Looks under another light that logarithmic axes can show."""
        return _placed(self._relit)

    def remaining(self, target: float) -> float | None:
        """Return seconds of rendering left to an error, as 1 / sqrt(time); None if unknown."""
        if not self.looks:
            return None
        last = self.looks[-1]
        return max(0.0, last.seconds * ((last.error / target) ** 2 - 1))

    def samples_to(self, target: float) -> int | None:
        """Return the samples for an error, rounded up to two digits; None if unknown."""
        if not self.looks:
            return None
        needed = self.looks[-1].samples * (self.looks[-1].error / target) ** 2
        unit = int(10 ** max(0, math.floor(math.log10(max(needed, 1))) - 1))
        return unit * math.ceil(needed / unit)

    def limits(self, target: float = math.inf) -> tuple[float, float, float, float]:
        """Return first and last second, least and largest error, as limits of a plot of the looks.

        The way to the target is inside, if it is not too long. However close the looks are, there
        is a tick of 1, 2 or 5 between the limits.
        """
        looks = [*self.relit, *self.drawn]
        if len(looks) < 2:
            return EMPTY
        seconds, errors = [look.seconds for look in looks], [look.error for look in looks]
        errors += self.slope()[1] if self.drawn else []
        way = self.way_to(target)
        seconds, errors = seconds + way[0], errors + way[1]
        ends = min(seconds), max(seconds), min(errors), max(errors)
        least, most = 1 / MARGIN, MARGIN
        return ends[0] * least, ends[1] * most, ends[2] * least, ends[3] * most

    def way_to(self, target: float) -> tuple[list[float], list[float]]:
        """Return seconds and errors from the last look to a target, as 1 / sqrt(time).

        Both are empty if the target is reached, or takes more than FARTHEST times as long.
        """
        last = self.drawn[-1] if self.drawn else None
        if last is None or not 1 < (last.error / target) ** 2 <= FARTHEST:
            return [], []
        return [last.seconds, last.seconds * (last.error / target) ** 2], [last.error, target]

    def slope(self) -> tuple[list[float], list[float]]:
        """Return seconds and errors of the line of slope -1/2 through the last look."""
        first, last = self.drawn[0], self.drawn[-1]
        seconds = [first.seconds, last.seconds]
        return seconds, [last.error * (last.seconds / max(s, 1e-9)) ** 0.5 for s in seconds]


def _placed(looks: list[Look]) -> list[Look]:
    return [look for look in looks if 0 < look.error < math.inf and look.seconds > 0]
