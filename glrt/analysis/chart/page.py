"""The results of charts as Markdown: sentences and tables."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from glrt.analysis.chart.choice import BASE, MOST_SHOWN, times_to
from glrt.analysis.chart.curves import LEVELS, Curve, Interval, front
from glrt.analysis.chart.experiment import SAMPLER, Experiment
from glrt.analysis.chart.measure import SETTLED
from glrt.analysis.variants import LEAD, LIVE


def percent(share: float) -> str:
    """A fraction in percent with two significant digits: 0.0123 is "1.2 %"."""
    value = 100 * share
    return f"{value:.0f} %" if value >= 9.95 else f"{value:.2g} %"


def ending(curve: Curve) -> str:
    """The label at the end of a curve: its name, and its bias if it is biased."""
    return f"{curve.name}: bias {percent(curve.bias.value)}" if curve.is_biased else curve.name


class SpeedUp(NamedTuple):
    """Milliseconds to an error by the fastest variant and by BASE, and the speed-up in words."""

    fast: float
    slow: float
    text: str
    is_measured: bool  # none of the two times is extrapolated


def speed_up(curves: Sequence[Curve], level: float) -> SpeedUp | None:
    """The speed-up of the fastest variant over BASE at an error; None if BASE is the fastest."""
    known = times_to(curves, level)
    bases = [(time, measured) for time, name, measured in known if BASE in name.split(" = ")]
    if not bases or known[0][0] == bases[0][0]:
        return None
    (fast, winner, is_known), (slow, is_seen) = known[0], bases[0]
    measured = is_known and is_seen
    about = "" if measured else "about "
    text = f"{winner} {about}{number(slow / fast)} x as fast as {BASE}"
    return SpeedUp(fast, slow, text, measured)


def number(value: float) -> str:
    """A number with three significant digits, without an exponent."""
    return f"{value:.3g}" if value < 1000 else f"{float(f'{value:.3g}'):,.0f}"


def page(experiments: Sequence[Experiment]) -> str:
    """The page: how it was measured, then chart, findings and table of each scene."""
    sections = ["\n".join(section(experiment)) for experiment in experiments]
    return "\n".join([*_introduction(experiments[0]), *sections])


def section(experiment: Experiment) -> Iterator[str]:
    """The lines of the page about one scene."""
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
    if not all(curve.is_rival for curve in experiment.curves):
        yield _LIVE
    yield _reference(experiment)


def table(experiment: Experiment) -> Iterator[str]:
    """A row for each curve, as Markdown."""
    columns = ["variant", "rays per sample", "error at the end", "bias", "slope"]
    columns += [f"ms to {percent(level)}" for level in LEVELS]
    with_flip = _has_flip(experiment)
    columns += ["FLIP at the end"] if with_flip else []
    yield f"| {' | '.join(columns)} |"
    yield "|---" * len(columns) + "|"
    for curve, rays in zip(experiment.curves, experiment.rays, strict=True):
        last = curve.points[-1]
        end = f"{percent(last.error.value)} at {last.samples}"
        cells = [
            curve.name,
            f"{rays.of(last.samples) / last.samples:.3g}",
            end,
            _bias(curve.bias),
            _slope(curve.slope),
        ]
        cells += [_time(curve.milliseconds_to(level)) for level in LEVELS]
        cells += ["-" if last.flip is None else f"{last.flip:.2g}"] if with_flip else []
        yield f"| {' | '.join(cells)} |"


def _introduction(experiment: Experiment) -> Iterator[str]:
    levels = ", ".join(percent(level) for level in LEVELS)
    yield "# Speed against accuracy"
    yield ""
    yield (
        f"Measured with {experiment.place}. The error is the relative RMS error over pixels and "
        "channels against a reference; the time is that of all dispatches of a picture, and of the "
        "filter where it is denoised, without compilation. Every round runs each variant once, in "
        "another order and with other seeds. "
        "Times are medians; errors and slopes have 95 % confidence intervals over the rounds. A "
        f"time after `~` is extrapolated. A picture shows at most {MOST_SHOWN} variants: `{BASE}`, "
        f"`{LEAD}`, what `--curve` names, the first to reach {levels}, and the fastest at other "
        "errors. Grey steps are the Pareto front of all variants: no point has both less time and "
        "less error. At the line of an error, the chart compares "
        f"the fastest variant with `{BASE}`. The sampler is `{SAMPLER}` unless the name of a "
        "variant contains another."
    )
    yield ""
    if _has_flip(experiment):
        yield (
            "FLIP is the perceived difference from the reference when their PNG files are shown "
            "in alternation at 67 pixels per degree: 0 for equal pictures, 1 for black against "
            "white (Andersson et al. 2020). It is computed in the first round, and includes the "
            "noise of the reference."
        )
        yield ""


def _has_flip(experiment: Experiment) -> bool:
    return any(p.flip is not None for curve in experiment.curves for p in curve.points)


def _winner(curves: Sequence[Curve], level: float) -> str:
    """The variants in the order in which they reach an error, with times relative to the first."""
    known = times_to(curves, level)
    if not known:
        return f"No variant reaches {percent(level)}."
    time, name, measured = known[0]
    text = f"{percent(level)} is reached first by `{name}`, after {_time((time, measured))} ms"
    others = [f"`{who}` ({number(other / time)} x)" for other, who, _ in known[1:]]
    return f"{text}; then by {', '.join(others)}." if others else f"{text}, and by no other."


def _biases(curves: Sequence[Curve]) -> Iterator[str]:
    biased = [f"`{c.name}` at {percent(c.bias.value)}" for c in curves if c.is_biased]
    if biased:
        yield f"Biased, however many samples: {', '.join(biased)}."


def _front(curves: Sequence[Curve]) -> str:
    rivals = [curve for curve in curves if curve.is_rival]
    dots = [(p.milliseconds.value, p.error.value, c.name) for c in rivals for p in c.points]
    names = [dots[place][2] for place in front([dot[:2] for dot in dots])]
    ordered = ", then ".join(f"`{name}`" for name in dict.fromkeys(names))
    return f"On the Pareto front are, from fast to slow, {ordered}."


def _slopes(curves: Sequence[Curve]) -> Iterator[str]:
    fitted = [f"`{c.name}` {_slope(c.slope)}" for c in curves if c.slope and not c.is_biased]
    if fitted:
        yield (
            "Slopes of log error over log samples (-0.5 for independent samples): "
            f"{', '.join(fitted)}."
        )


_LIVE = (
    f"`{LIVE}` are in their steady state: {SETTLED} updates before each picture are not in its "
    "time. So it is compared with no other, and is not on the front; its bias contains the noise "
    "of the probes."
)
_DOUBT = (
    " That error is not to be believed: few samples carry much of the light, and all errors here "
    "may be wrong by as much."
)


def _reference(experiment: Experiment) -> str:
    reference = experiment.reference
    width, height = experiment.size
    frame = f"{width} x {height} pixels, {experiment.rounds} rounds"
    if not reference.samples:
        return f"The reference is a closed form ({frame})."
    return (
        f"The reference, two halves of {reference.samples} samples and up to {reference.bounces} "
        f"bounces, has itself an error of {percent(reference.error)} ({frame})."
        f"{_DOUBT if reference.is_doubtful else ''}"
    )


def _time(time: tuple[float, bool] | None) -> str:
    if time is None:
        return "never"
    milliseconds, measured = time
    return f"{'' if measured else '~'}{number(milliseconds)}"


def _bias(bias: Interval) -> str:
    if bias.low > 0:
        return f"{percent(bias.value)} ({percent(bias.low)} to {percent(bias.high)})"
    return f"none detected above {percent(bias.high)}"


def _slope(slope: Interval | None) -> str:
    return f"{slope.value:.2f} ({slope.low:.2f} to {slope.high:.2f})" if slope else "-"
