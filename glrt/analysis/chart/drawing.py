"""The picture of a chart: a few curves with their names next to them, and pictures below.

The names are placed by `labels`, after the axes have their size.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.analysis.chart import labels
from glrt.analysis.chart.choice import shown
from glrt.analysis.chart.curves import LEVELS, Curve, front
from glrt.analysis.chart.experiment import Experiment
from glrt.analysis.chart.page import ending, percent, speed_up
from glrt.analysis.chart.sights import MOST_SIDE, captions, codes_of
from glrt.analysis.plot import FORMATS, open_figure, save_figure

# As on pages: --c0, --c1, ... and SHAPES of chart_page.html.
COLORS = ("#0072b2", "#d55e00", "#00815d", "#b0488a", "#8a6d00", "#6350b8", "#882255")
MARKERS = "os^DvP<"
BLACK, GREY = "black", "0.62"
SIZE, STRIP = (12.0, 6.5), 2.6  # inches; the height of the pictures below
FONT = 13  # points

Places = Sequence[Sequence[float]]  # x of each point of each curve


def save_plots(experiment: Experiment, stem: Path) -> None:
    """Write STEM.svg and STEM.png."""
    strip = STRIP if experiment.sights else 0.0
    with open_figure((SIZE[0], SIZE[1] + strip), FONT) as figure:
        _fill(figure, experiment, strip)
        for suffix in FORMATS:
            save_figure(figure, stem.with_name(stem.name + suffix))


def _fill(figure: Any, experiment: Experiment, strip: float) -> None:
    parts = figure.subfigures(2, 1, height_ratios=[SIZE[1], strip]) if strip else [figure]
    few = shown(experiment.curves, experiment.named)
    times, rays = parts[0].subplots(1, 2, sharey=True, width_ratios=[3, 2])
    width, height = experiment.size
    parts[0].suptitle(f"{experiment.title}: {width} x {height} pixels", weight="bold")
    all_times, all_rays = _milliseconds(experiment), _rays(experiment)
    _draw(times, experiment.curves, all_times, few)
    _draw(rays, experiment.curves, all_rays, few)
    times.set(xlabel="milliseconds per picture", ylabel="relative RMS error")
    times.yaxis.set_major_formatter(lambda error, _place: percent(error))
    rays.set(xlabel="rays per pixel")
    parts[0].supxlabel(_note(experiment, len(few)), x=0.99, ha="right", size=FONT - 4)
    if strip:
        _show_sights(parts[1], experiment)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # the names depend on the size of the axes
    named = [experiment.curves[number] for number in few]
    xs = [all_times[number] for number in few]
    name_curves(times, named, xs, _mark_levels(times, experiment.curves))
    _mark_levels(rays, [])


def _note(experiment: Experiment, few: int) -> str:
    every = len(experiment.curves)
    rest = f"; {every - few} are only in the table" if every > few else ""
    return f"Grey steps: the best of all {every} variants{rest}. {experiment.place}"


def _milliseconds(experiment: Experiment) -> list[list[float]]:
    return [[point.milliseconds.value for point in curve.points] for curve in experiment.curves]


def _rays(experiment: Experiment) -> list[list[float]]:
    pairs = zip(experiment.curves, experiment.rays, strict=True)
    return [[rays.of(point.samples) for point in curve.points] for curve, rays in pairs]


def _draw(axes: Any, curves: Sequence[Curve], places: Places, few: Sequence[int]) -> None:
    """Draw `few` of the curves over their x coordinates, and the Pareto front of all as steps."""
    axes.set(xscale="log", yscale="log")
    axes.xaxis.set_major_formatter("{x:g}")
    pairs = list(zip(curves, places, strict=True))
    dots = [
        (x, p.error.value)
        for curve, xs in pairs
        if curve.is_rival
        for x, p in zip(xs, curve.points, strict=True)
    ]
    steps = [dots[place] for place in front(dots)]
    axes.step(*zip(*steps, strict=True), where="post", color=GREY, lw=5, alpha=0.5, zorder=1)
    for look, number in enumerate(few):
        curve, xs = pairs[number]
        color, marker = COLORS[look], MARKERS[look]
        errors = [point.error.value for point in curve.points]
        low, high = ([getattr(p.error, end) for p in curve.points] for end in ("low", "high"))
        has_end = [end > 0 for end in low]  # no band where its logarithm is undefined
        axes.fill_between(xs, low, high, where=has_end, color=color, alpha=0.15, lw=0, zorder=0)
        axes.plot(xs, errors, marker + "-", color=color, ms=5, lw=1.6, zorder=3)
    drawn = [p.error.value for number in few for p in curves[number].points]
    errors = [*drawn, *(error for _, error in steps)]
    axes.set_ylim(min(errors) / 1.5, max(errors) * 1.5)


def _mark_levels(axes: Any, curves: Sequence[Curve]) -> list[tuple[float, str]]:
    """Draw a line at each of LEVELS; return the levels and their texts.

    An arrow spans the times that the fastest curve and BASE take, if both are measured.
    """
    bottom, top = axes.get_ylim()
    left, right = axes.get_xlim()
    axes.set_xlim(left, right)
    texts = []
    for level in LEVELS:
        if not bottom < level < top:
            continue
        axes.axhline(level, color=GREY, ls=":", lw=1.2, zorder=0)
        gain = speed_up(curves, level)
        texts.append((level, f"{percent(level)}: {gain.text}" if gain else percent(level)))
        if gain and gain.is_measured and left < gain.fast and gain.slow < right:
            ends = {"xy": (gain.slow, level), "xytext": (gain.fast, level)}
            axes.annotate("", **ends, arrowprops={"arrowstyle": "<->", "color": BLACK})
    return texts


def name_curves(
    axes: Any, curves: Sequence[Curve], places: Places, levels: Sequence[tuple[float, str]]
) -> list[Any]:
    """Write the text of each level, and the name of each curve next to it; return the texts.

    The layout of the figure must be final.
    """
    frame = (axes.bbox.width, axes.bbox.height)
    paths = [
        _in_pixels(axes, list(zip(xs, [p.error.value for p in curve.points], strict=True)))
        for curve, xs in zip(curves, places, strict=True)
    ]
    heights = [float(_in_pixels(axes, [(1.0, level)])[0, 1]) for level, _ in levels]
    look = {"va": "bottom", "ha": "left", "zorder": 6, "transform": axes.transAxes}
    texts = [axes.text(0, 0, text, size=FONT - 3, color="0.25", **look) for _, text in levels]
    texts += [
        axes.text(0, 0, ending(curve), size=FONT - 1, color=color, weight="bold", **look)
        for curve, color in zip(curves, COLORS, strict=False)
    ]
    boxes = [text.get_window_extent() for text in texts]
    sizes = [(box.width, box.height) for box in boxes]
    options = [
        labels.above(height, paths, size, frame)
        for height, size in zip(heights, sizes, strict=False)
    ]
    options += [
        labels.around(number, paths, size, frame)
        for number, size in enumerate(sizes[len(levels) :])
    ]
    for text, place in zip(texts, labels.solve(options, frame), strict=True):
        text.set_position(np.array(place.box[:2]) / frame)
        if place.leader:
            x, y = (np.array(place.leader) / frame).T
            axes.plot(x, y, color=text.get_color(), lw=0.8, transform=axes.transAxes)
    return texts


def _in_pixels(axes: Any, dots: Sequence[tuple[float, float]]) -> NDArray[np.float64]:
    """Points of the data in pixels from the lower left corner of the axes, (N, 2)."""
    return np.asarray(axes.transData.transform(dots) - axes.bbox.p0)


def _show_sights(part: Any, experiment: Experiment) -> None:
    """Show pictures with the errors of LEVELS, and the reference, in a row."""
    shown_with = experiment.sights, experiment.reference
    pairs = list(zip(codes_of(*shown_with), captions(*shown_with), strict=True))
    row = part.subplots(1, 1 + len(LEVELS))
    for axes in row:
        axes.set_axis_off()
    for axes, (codes, caption) in zip(row, pairs, strict=False):
        axes.imshow(codes, interpolation="none")
        axes.set_title(caption.replace(": ", "\n", 1), size=FONT - 3, loc="center")
    side = min(MOST_SIDE, *experiment.size)
    part.suptitle(f"How errors look here ({side} x {side} pixels)", size=FONT - 1)
