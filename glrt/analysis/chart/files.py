"""The files of a chart: pictures and a Markdown page, and the figures as CSV and JSON."""

import csv
import io
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from glrt.analysis.chart.curves import LEVELS, Curve, front
from glrt.analysis.chart.drawing import save_plots
from glrt.analysis.chart.experiment import Experiment
from glrt.analysis.chart.page import page
from glrt.core import files


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
        if curve.is_rival
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
