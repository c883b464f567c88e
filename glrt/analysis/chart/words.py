"""What a chart shows, in words."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from glrt.analysis.chart.curves import LEVELS, Curve, Interval, front
from glrt.analysis.chart.experiment import SAMPLER, Experiment


def percent(share: float) -> str:
    """Two digits: 0.0123 is "1.2 %"."""
    value = 100 * share
    return f"{value:.0f} %" if value >= 9.95 else f"{value:.2g} %"


def ending(curve: Curve) -> str:
    """A curve in a word: its name, and the bias if it ends in one."""
    return f"{curve.name}: bias {percent(curve.bias.value)}" if curve.is_biased else curve.name


BASE = "naive"  # the method that others are compared with: the thesis's


class SpeedUp(NamedTuple):
    """Milliseconds of the fastest variant to a level and of BASE, and what that means."""

    fast: float
    slow: float
    text: str


def speed_up(curves: Sequence[Curve], level: float) -> SpeedUp | None:
    """How much sooner than BASE the fastest reaches a level; None if BASE is the fastest."""
    known = _times_to(curves, level)
    bases = [(time, measured) for time, name, measured in known if BASE in name.split(" = ")]
    if not bases or known[0][0] == bases[0][0]:
        return None
    (fast, winner, _), (slow, measured) = known[0], bases[0]
    about = "" if measured else "about "
    return SpeedUp(fast, slow, f"{winner} {about}{number(slow / fast)} x as fast as {BASE}")


def number(value: float) -> str:
    """Three digits, without an exponent."""
    return f"{value:.3g}" if value < 1000 else f"{float(f'{value:.3g}'):,.0f}"


def page(experiments: Sequence[Experiment]) -> str:
    """Markdown: what was measured and how, then chart, words and table of each scene."""
    sections = ["\n".join(section(experiment)) for experiment in experiments]
    return "\n".join([*_introduction(experiments[0]), *sections])


def section(experiment: Experiment) -> Iterator[str]:
    """The part of the page that tells of one scene."""
    name = experiment.name
    yield f"## {name}: {experiment.title}"
    yield ""
    yield f"![Error against time for {name}]({name}.svg)"
    yield ""
    yield " ".join(sentences(experiment))
    yield ""
    yield from table(experiment)
    yield ""


def sentences(experiment: Experiment) -> Iterator[str]:
    """The findings, most important first."""
    yield from (_winner(experiment.curves, level) for level in LEVELS)
    yield from _biases(experiment.curves)
    yield _front(experiment.curves)
    yield from _slopes(experiment.curves)
    yield _reference(experiment)


def table(experiment: Experiment) -> Iterator[str]:
    """The curves as Markdown."""
    columns = ["variant", "rays a sample", "error at the end", "bias", "slope"]
    columns += [f"ms to {percent(level)}" for level in LEVELS]
    asked = _has_flip(experiment)
    columns += ["FLIP at the end"] if asked else []
    yield f"| {' | '.join(columns)} |"
    yield "|---" * len(columns) + "|"
    for curve, rays in zip(experiment.curves, experiment.rays, strict=True):
        last = curve.points[-1]
        end = f"{percent(last.error.value)} at {last.samples}"
        cells = [curve.name, f"{rays:.3g}", end, _bias(curve.bias), _slope(curve.slope)]
        cells += [_time(curve.milliseconds_to(level)) for level in LEVELS]
        cells += ["-" if last.flip is None else f"{last.flip:.2g}"] if asked else []
        yield f"| {' | '.join(cells)} |"


def _introduction(experiment: Experiment) -> Iterator[str]:
    yield "# Speed against accuracy"
    yield ""
    yield (
        f"Measured by {experiment.place}. The error is the relative RMS error over pixels and "
        "channels against a reference; a time is that of all dispatches of a picture, without "
        "compiling. Every round runs each variant once, in another order and with other random "
        "numbers: times are medians; errors and slopes have 95 % intervals over the rounds, of "
        "which one in twenty misses the truth by chance. A time after `~` lies beyond what was "
        "measured. Black in the charts is what nothing else beats in both time and error; on the "
        "line of an error stands how many times as fast the fastest gets there. Random numbers are "
        f"`{SAMPLER}` where the name of a variant does not say otherwise."
    )
    yield ""
    if _has_flip(experiment):
        yield (
            "FLIP says how different a picture looks from the reference to someone who flips "
            "between their PNG files, where 67 pixels fill a degree: from 0, the same, to 1, black "
            "beside white (Andersson et al. 2020). One picture is asked, and the noise of the "
            "reference is in it."
        )
        yield ""


def _has_flip(experiment: Experiment) -> bool:
    return any(p.flip is not None for curve in experiment.curves for p in curve.points)


def _winner(curves: Sequence[Curve], level: float) -> str:
    known = _times_to(curves, level)
    if not known:
        return f"Nothing reaches {percent(level)}."
    time, name, measured = known[0]
    text = f"{percent(level)} is reached first by `{name}`, after {_time((time, measured))} ms"
    others = [f"`{who}` ({number(other / time)} x)" for other, who, _ in known[1:]]
    return f"{text}; then by {', '.join(others)}." if others else f"{text}, and by nothing else."


def _times_to(curves: Sequence[Curve], level: float) -> list[tuple[float, str, bool]]:
    """Milliseconds, name, and whether that was measured, fastest first."""
    reached = [(curve.milliseconds_to(level), curve.name) for curve in curves]
    return sorted((time[0], name, time[1]) for time, name in reached if time)


def _biases(curves: Sequence[Curve]) -> Iterator[str]:
    biased = [f"`{c.name}` at {percent(c.bias.value)}" for c in curves if c.is_biased]
    if biased:
        yield f"More samples do not help what is biased: {', '.join(biased)}."


def _front(curves: Sequence[Curve]) -> str:
    dots = [(p.milliseconds.value, p.error.value, c.name) for c in curves for p in c.points]
    names = [dots[place][2] for place in front([dot[:2] for dot in dots])]
    ordered = ", then ".join(f"`{name}`" for name in dict.fromkeys(names))
    return f"The best for its time is, from quick to slow, {ordered}."


def _slopes(curves: Sequence[Curve]) -> Iterator[str]:
    fitted = [f"`{c.name}` {_slope(c.slope)}" for c in curves if c.slope and not c.is_biased]
    if fitted:
        yield f"Slopes of error over samples (-0.5: independent): {', '.join(fitted)}."


def _reference(experiment: Experiment) -> str:
    reference = experiment.reference
    width, height = experiment.size
    frame = f"{width} x {height} pixels, {experiment.rounds} rounds"
    if not reference.samples:
        return f"The reference is a closed form ({frame})."
    return (
        f"The reference, two halves of {reference.samples} samples and up to {reference.bounces} "
        f"bounces, has an error of {percent(reference.error)} itself ({frame})."
    )


def _time(time: tuple[float, bool] | None) -> str:
    if time is None:
        return "never"
    milliseconds, measured = time
    return f"{'' if measured else '~'}{number(milliseconds)}"


def _bias(bias: Interval) -> str:
    if bias.low > 0:
        return f"{percent(bias.value)} ({percent(bias.low)} to {percent(bias.high)})"
    return f"none seen above {percent(bias.high)}"


def _slope(slope: Interval | None) -> str:
    return f"{slope.value:.2f} ({slope.low:.2f} to {slope.high:.2f})" if slope else "-"
