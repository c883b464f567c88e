"""The results of charts as sections of a page: curves over time and over rays, and a table."""

from collections.abc import Iterator, Sequence

from glrt.analysis.chart.choice import shown
from glrt.analysis.chart.curves import LEVELS, Curve, Point, front
from glrt.analysis.chart.experiment import Experiment
from glrt.analysis.chart.page import number, percent, sentences, speed_up, table
from glrt.analysis.chart.sights import captions, codes_of
from glrt.analysis.chart_page import (
    Axes,
    Dot,
    Level,
    Line,
    Picture,
    Section,
    Table,
    encoded_picture,
)

FRONT = "Pareto front"


def section_of(experiment: Experiment) -> Section:
    """The section of a scene. The curves that are shown at first come first."""
    few = shown(experiment.curves, experiment.named)
    order = [*few, *(n for n in range(len(experiment.curves)) if n not in few)]
    curves = [experiment.curves[number] for number in order]
    times = [[point.milliseconds.value for point in curve.points] for curve in curves]
    pairs = zip(curves, (experiment.rays[number] for number in order), strict=True)
    rays = [[ray.of(point.samples) for point in curve.points] for curve, ray in pairs]
    width, height = experiment.size
    charts = [
        _axes("Error over time", "milliseconds per picture", curves, times, len(few)),
        _axes("Error over rays", "rays per pixel", curves, rays, len(few)),
    ]
    return Section(
        name=experiment.name,
        title=f"{experiment.name}: {experiment.title}",
        lines=[f"{width} x {height} pixels, {experiment.rounds} rounds, {experiment.place}."],
        charts=charts,
        tables=[Table("all variants", list(_cells(experiment)))],
        findings=[sentence.replace("`", "") for sentence in sentences(experiment)],
        pictures=list(_pictures(experiment)),
    )


def _axes(
    title: str,
    x_label: str,
    curves: Sequence[Curve],
    places: Sequence[Sequence[float]],
    few: int,
) -> Axes:
    lines = [
        Line(
            curve.name,
            [_dot(x, point) for x, point in zip(xs, curve.points, strict=True)],
            is_shown=place < few,
        )
        for place, (curve, xs) in enumerate(zip(curves, places, strict=True))
    ]
    pairs = zip(curves, lines, strict=True)
    rivals = [dot for curve, line in pairs if curve.is_rival for dot in line.dots]
    lines.append(Line(FRONT, _front(rivals), "front"))
    by_time = x_label.startswith("milliseconds")
    levels = [Level(level, _text(curves, level) if by_time else percent(level)) for level in LEVELS]
    return Axes(title, x_label, "relative RMS error", lines, levels, is_percent=True)


def _dot(x: float, point: Point) -> Dot:
    error, low, high = point.error
    tip = (
        f"{point.samples} samples, {number(point.milliseconds.value)} ms: error {percent(error)} "
        f"({percent(low)} to {percent(high)})"
    )
    return Dot(x, error, tip, low, high)


def _front(dots: Sequence[Dot]) -> list[Dot]:
    known = [(dot.x, dot.y) for dot in dots if dot.x is not None and dot.y is not None]
    return [Dot(*known[place], tip="") for place in front(known)]


def _text(curves: Sequence[Curve], level: float) -> str:
    gain = speed_up(curves, level)
    return f"{percent(level)}: {gain.text}" if gain else percent(level)


def _pictures(experiment: Experiment) -> Iterator[Picture]:
    if experiment.sights:
        shown_with = experiment.sights, experiment.reference
        yield from map(encoded_picture, codes_of(*shown_with), captions(*shown_with))


def _cells(experiment: Experiment) -> Iterator[list[str]]:
    """The table of the Markdown page without its lines."""
    for line in table(experiment):
        if not line.startswith("|---"):
            yield [cell.strip() for cell in line.strip("|").split("|")]
