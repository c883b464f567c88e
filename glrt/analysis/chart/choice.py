"""Which curves a picture shows: a few, so that it can be read; the others are in the table."""

import math
from collections.abc import Iterator, Sequence

from glrt.analysis.chart.curves import LEVELS, Curve, front
from glrt.analysis.variants import LEAD

BASE = "naive"  # the baseline of speed-ups: the method of the thesis
FEW, MOST_SHOWN = 5, 7  # curves of a picture
MOST_NAMED = MOST_SHOWN - 2  # by the user; the others are BASE and LEAD
LEAST_SPAN = math.log(1.1)  # range of errors at which a curve beyond FEW is the fastest


def shown(curves: Sequence[Curve], named: Sequence[str] = ()) -> tuple[int, ...]:
    """Indices of the curves of a picture, MOST_SHOWN at most: BASE, LEAD, then the others in order.

    The others are the curves that the user named, then the first to reach each of LEVELS, then
    curves on the Pareto front, in the order of the range of errors at which they are the fastest.
    """
    names = [curve.name for curve in curves]
    always = [name for each in (BASE, LEAD) if (name := called(each, names))]
    wanted = [*always, *(name for each in named if (name := called(each, names)))]
    wanted += [times[0][1] for level in LEVELS if (times := times_to(curves, level))]
    few = [*dict.fromkeys(wanted)]
    for name, span in _spans(curves):
        if name not in few and (len(few) < FEW or span >= LEAST_SPAN):
            few.append(name)
    places = [names.index(name) for name in few[:MOST_SHOWN]]
    first = len(dict.fromkeys(always))
    return (*places[:first], *sorted(places[first:]))


def called(wanted: str, names: Sequence[str]) -> str | None:
    """The name of the curve that a user calls `wanted`; None if there is none.

    Methods that are one have a common name, "naive = nee". A method that takes a sampler of its own
    can be named without it: "ddgi" is "ddgi, sobol".
    """
    parts = [(name, part) for name in names for part in name.split(" = ")]
    exact = [name for name, part in parts if part == wanted]
    longer = [name for name, part in parts if part.startswith(f"{wanted}, ")]
    return next(iter([*exact, *longer]), None)


def times_to(curves: Sequence[Curve], level: float) -> list[tuple[float, str, bool]]:
    """Milliseconds to an error, name, and whether it was measured, of rivals, fastest first."""
    reached = [(it.milliseconds_to(level), it.name) for it in curves if it.is_rival]
    return sorted((time[0], name, time[1]) for time, name in reached if time)


def _spans(curves: Sequence[Curve]) -> list[tuple[str, float]]:
    """Each curve on the front, and the logarithms of its ranges of errors; largest first."""
    spans: dict[str, float] = {}
    for name, span in _steps(curves):
        spans[name] = spans.get(name, 0.0) + span
    return sorted(spans.items(), key=lambda item: -item[1])


def _steps(curves: Sequence[Curve]) -> Iterator[tuple[str, float]]:
    """Each point of the front: the name of its curve, and the logarithm of the range of errors."""
    rivals = [curve for curve in curves if curve.is_rival]
    dots = [(p.milliseconds.value, p.error.value, c.name) for c in rivals for p in c.points]
    before = None
    for place in front([dot[:2] for dot in dots]):
        _, error, name = dots[place]
        yield name, math.log(before / error) if before else 0.0
        before = error
