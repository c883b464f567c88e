"""The files of a chart: plots and a Markdown page, and the figures as CSV and JSON."""

import csv
import io
import json
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import fmean
from typing import Any

from glrt.analysis.chart.curves import LEVELS, Curve, front
from glrt.analysis.chart.experiment import Experiment
from glrt.analysis.chart.page import ending, page, percent, speed_up
from glrt.analysis.plot import FORMATS, open_figure, save_figure
from glrt.core import files

MARKERS = "os^Dv<>ph*XPd1+28H34x|"
BLACK, GREY, PALE = "black", "0.62", "0.85"
SIZE = (12.0, 6.5)  # inches
FONT = 13  # points


def save_plots(experiment: Experiment, stem: Path) -> None:
    """Write STEM.svg and STEM.png."""
    with open_figure(SIZE, FONT) as figure:
        _fill(figure, experiment)
        for suffix in FORMATS:
            save_figure(figure, stem.with_name(stem.name + suffix))


def _fill(figure: Any, experiment: Experiment) -> None:
    times, rays = figure.subplots(1, 2, sharey=True, width_ratios=[3, 2])
    width, height = experiment.size
    figure.suptitle(f"{experiment.title}: {width} x {height} pixels", weight="bold")
    _draw(times, experiment.curves, _milliseconds(experiment))
    _draw(rays, experiment.curves, _rays(experiment))
    times.set(xlabel="milliseconds per picture", ylabel="relative RMS error")
    times.yaxis.set_major_formatter(lambda error, _place: percent(error))
    rays.set(xlabel="rays per pixel")
    _mark_levels(times, experiment.curves)
    _mark_levels(rays, [])
    _name_curves(times, experiment.curves)
    figure.supxlabel(experiment.place, x=0.99, ha="right", size=FONT - 4)


def _milliseconds(experiment: Experiment) -> list[list[float]]:
    return [[point.milliseconds.value for point in curve.points] for curve in experiment.curves]


def _rays(experiment: Experiment) -> list[list[float]]:
    pairs = zip(experiment.curves, experiment.rays, strict=True)
    return [[rays.of(point.samples) for point in curve.points] for curve, rays in pairs]


def _draw(axes: Any, curves: Sequence[Curve], places: Sequence[Sequence[float]]) -> None:
    """Draw curves over their x coordinates `places`, and their common Pareto front as steps."""
    axes.set(xscale="log", yscale="log")
    dots = [
        (x, point.error.value, number)
        for number, (curve, xs) in enumerate(zip(curves, places, strict=True))
        for x, point in zip(xs, curve.points, strict=True)
    ]
    best = front([(x, error) for x, error, _ in dots])
    steps = [dots[place] for place in best]
    axes.step(*zip(*[dot[:2] for dot in steps], strict=True), where="post", color=BLACK, lw=1.5)
    for number, (curve, xs) in enumerate(zip(curves, places, strict=True)):
        errors = [point.error.value for point in curve.points]
        low, high = ([getattr(p.error, end) for p in curve.points] for end in ("low", "high"))
        has_end = [end > 0 for end in low]  # no band where its logarithm is undefined
        axes.fill_between(xs, low, high, where=has_end, color=PALE, lw=0, zorder=0)
        axes.plot(xs, errors, MARKERS[number % len(MARKERS)] + "-", color=GREY, ms=6, lw=1)
    for x, error, number in steps:
        axes.plot(x, error, MARKERS[number % len(MARKERS)], color=BLACK, ms=7, zorder=5)
    errors = [error for _, error, _ in dots]
    axes.set_ylim(min(errors) / 1.5, max(errors) * 1.5)


def _mark_levels(axes: Any, curves: Sequence[Curve]) -> None:
    """Draw a line at each of LEVELS, with the speed-up of the fastest variant over naive."""
    bottom, top = axes.get_ylim()
    left, right = axes.get_xlim()
    axes.set_xlim(left, right)
    for level in LEVELS:
        if not bottom < level < top:
            continue
        axes.axhline(level, color=GREY, ls=":", lw=1.2, zorder=0)
        gain = speed_up(curves, level)
        if curves:
            text = f"{percent(level)}: {gain.text}" if gain else percent(level)
            at_right = gain is not None and gain.fast / left < right / gain.slow
            place = {"x": right, "ha": "right"} if at_right else {"x": left * 1.05, "ha": "left"}
            paper = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5}
            look = {"size": FONT - 3, "va": "bottom", "zorder": 6, "bbox": paper}
            axes.text(y=level, s=text, **place, **look)
        if gain and gain.fast < right:
            ends = {"xy": (min(gain.slow, right), level), "xytext": (gain.fast, level)}
            axes.annotate("", **ends, arrowprops={"arrowstyle": "<->", "color": BLACK})


def _name_curves(axes: Any, curves: Sequence[Curve]) -> None:
    """Write the names of the curves right of the axes, with lines to the ends of the curves."""
    bottom, top = (math.log(limit) for limit in axes.get_ylim())
    ends = sorted(
        ((math.log(curve.points[-1].error.value) - bottom) / (top - bottom), number)
        for number, curve in enumerate(curves)
    )
    for height, (_, number) in zip(_spread([end for end, _ in ends]), ends, strict=True):
        last = curves[number].points[-1]
        line = {"arrowstyle": "-", "color": GREY, "lw": 0.8, "shrinkB": 4, "relpos": (0, 0.5)}
        axes.annotate(
            ending(curves[number]),
            (last.milliseconds.value, last.error.value),
            (1.06, height),
            textcoords="axes fraction",
            va="center",
            size=FONT - 2,
            arrowprops=line,
        )
        marker = {"color": BLACK, "ms": 6, "transform": axes.transAxes, "clip_on": False}
        axes.plot(1.04, height, MARKERS[number % len(MARKERS)], **marker)


def _spread(heights: Sequence[float], gap: float = 0.055) -> list[float]:
    """Ascending heights, moved apart to at least `gap` with the least squared displacement.

    With place * gap subtracted, the result must be non-decreasing: isotonic regression by pooling
    adjacent violators, which take their mean.
    """
    pools: list[list[float]] = []
    for place, height in enumerate(heights):
        pools.append([height - place * gap])
        while len(pools) > 1 and fmean(pools[-2]) >= fmean(pools[-1]):
            pools[-2:] = [pools[-2] + pools[-1]]
    level = [fmean(pool) for pool in pools for _ in pool]
    return [value + place * gap for place, value in enumerate(level)]


def save_chart(experiment: Experiment, folder: Path) -> None:
    """Write NAME.svg, NAME.png, NAME.csv and NAME.json."""
    save_plots(experiment, folder / experiment.name)
    text = json.dumps(figures(experiment), indent=1) + "\n"
    files.write_text(folder / f"{experiment.name}.json", text)
    files.write_text(folder / f"{experiment.name}.csv", _csv(list(rows(experiment))))


def save_page(experiments: Sequence[Experiment], folder: Path) -> Path:
    """Write chart.md, the page with the results of all scenes, and return its path."""
    path = folder / "chart.md"
    files.write_text(path, page(experiments))
    return path


def rows(experiment: Experiment) -> Iterator[dict[str, Any]]:
    """A row for every point of every curve; times in milliseconds, errors as fractions."""
    dots = [
        (point.milliseconds.value, point.error.value, curve.name, point.samples)
        for curve in experiment.curves
        for point in curve.points
    ]
    best = {dots[place][2:] for place in front([dot[:2] for dot in dots])}
    ways = zip(experiment.variants, experiment.curves, experiment.rays, strict=True)
    for variant, curve, rays in ways:
        for point in curve.points:
            yield {
                "scene": experiment.name,
                "variant": curve.name,
                "method": variant.settings.method,
                "bounces": variant.settings.bounces,
                "roulette": variant.settings.roulette,
                "sampler": variant.settings.sampler,
                "samples": point.samples,
                "rays": rays.of(point.samples),
                **_with_limits("milliseconds", point.milliseconds),
                **_with_limits("error", point.error),
                "flip": point.flip,
                "on_front": (curve.name, point.samples) in best,
            }


def figures(experiment: Experiment) -> dict[str, Any]:
    """All results as a table for JSON: curves, points, and how they were measured."""
    reference = experiment.reference
    return {
        "scene": experiment.name,
        "title": experiment.title,
        "size": experiment.size,
        "rounds": experiment.rounds,
        "place": experiment.place,
        "reference": {
            "samples": reference.samples,
            "bounces": reference.bounces,
            "error": reference.error,
        },
        "curves": [_curve(curve) for curve in experiment.curves],
        "points": list(rows(experiment)),
    }


def _curve(curve: Curve) -> dict[str, Any]:
    times = {str(level): curve.milliseconds_to(level) for level in LEVELS}
    return {
        "variant": curve.name,
        "slope": curve.slope and _with_limits("slope", curve.slope),
        **_with_limits("bias", curve.bias),
        "milliseconds_to": {
            level: time and {"milliseconds": time[0], "measured": time[1]}
            for level, time in times.items()
        },
    }


def _with_limits(name: str, interval: tuple[float, float, float]) -> dict[str, float]:
    return dict(zip((name, f"{name}_low", f"{name}_high"), interval, strict=True))


def _csv(table: Sequence[dict[str, Any]]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, table[0].keys(), lineterminator="\n")
    writer.writeheader()
    writer.writerows(table)
    return text.getvalue()
