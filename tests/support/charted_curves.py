"""Curves of charts without a measurement: made, and of the charts in docs/results/chart."""

import csv
from pathlib import Path

from glrt.analysis.chart.curves import Curve, Interval, Point

CHARTS = Path(__file__).parents[2] / "docs/results/chart"


def made(name: str, *dots: tuple[float, float], bias: float = 0.0) -> Curve:
    """A curve through (milliseconds, error), at 1, 2, 4, ... samples."""
    points = tuple(
        Point(2**n, Interval(ms, ms, ms), Interval(error, 0.9 * error, 1.1 * error))
        for n, (ms, error) in enumerate(dots)
    )
    return Curve(name, points, None, Interval(bias, 0.9 * bias, 1.1 * bias))


def measured(scene: str) -> list[Curve]:
    """The curves of a scene. A flat end is a bias, and is in the name."""
    dots: dict[str, list[tuple[float, float]]] = {}
    with (CHARTS / f"{scene}.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            dot = float(row["milliseconds"]), float(row["error"])
            dots.setdefault(row["variant"], []).append(dot)
    biases = {
        name: found[-1][1] if found[-1][1] > 0.95 * found[-2][1] else 0.0
        for name, found in dots.items()
    }
    return [made(name, *found, bias=biases[name]) for name, found in dots.items()]
