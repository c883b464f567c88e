"""Findings as a Markdown table, as CSV, as charts and as a page."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from glrt.analysis.chart_page import (
    LEAST_SIDE,
    Picture,
    Section,
    axes_of,
    save_chart_page,
    small_picture,
    table_of,
)
from glrt.analysis.plot import save_chart, save_sheet
from glrt.core import files
from glrt.core.version import VERSION
from glrt.image.image import Image
from glrt.lab.sweep import Finding

TABLE, FIGURES, OVERVIEW = "stress.md", "stress.csv", "overview.png"
MOST_PICTURES = 8  # of a case on a page


def table(findings: Sequence[Finding], renderer: str) -> str:
    """A row for each case, as Markdown. `renderer` is the name of the OpenGL driver."""
    rows = [
        ["case", "title", "guarantee", "verdict", "worst, glrt", "worst, naive", "seconds"],
        ["---"] * 7,
        *(_row(finding) for finding in findings),
    ]
    lines = [f"| {' | '.join(row)} |" for row in rows]
    return "\n".join([f"glrt {VERSION} on {renderer}.", "", *lines]) + "\n"


def _row(finding: Finding) -> list[str]:
    """The cells of a row; the worst value of glrt is the largest under the guarantee."""
    sweep, case = finding.sweep, finding.case
    name, values = next(iter(sweep.others.items()))
    naive = f"{max(values):.2g} ({name})"
    inside = [y for y, is_in in zip(sweep.chosen[1], sweep.covered(), strict=True) if is_in]
    ours = f"{max(inside or sweep.chosen[1]):.2g}"
    seconds = f"{finding.seconds:.1f}"
    return [case.name, case.title, sweep.promise, finding.verdict, ours, naive, seconds]


def figures(findings: Sequence[Finding]) -> str:
    """A row for each value of each curve, as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["case", "parameter", "x", "curve", "y", "bound", "guaranteed"])
    for finding in findings:
        sweep = finding.sweep
        bounds: Sequence[Any] = sweep.bound or [""] * len(sweep.x)
        for name, values in (sweep.chosen, *sweep.others.items()):
            for x, y, bound, inside in zip(sweep.x, values, bounds, sweep.covered(), strict=True):
                judged: list[Any] = [bound, int(inside)] if name == sweep.chosen[0] else ["", ""]
                writer.writerow([finding.case.name, sweep.parameter, x, name, y, *judged])
    return text.getvalue()


def save(findings: Sequence[Finding], folder: Path, renderer: str) -> None:
    """Write the table, the CSV file, a chart of each case and the overview into a folder."""
    files.write_text(folder / TABLE, table(findings, renderer))
    files.write_text(folder / FIGURES, figures(findings))
    for finding in findings:
        save_chart(finding.chart(), folder / f"{finding.case.name}.svg")
    save_sheet([finding.small_chart() for finding in findings], folder / OVERVIEW, title(findings))


def save_page(findings: Sequence[Finding], path: Path, renderer: str) -> None:
    """Write a page that needs no network: chart, values and pictures of each case."""
    about = f"glrt {VERSION} on {renderer}. Each picture is exposed by itself."
    sections = [_section(finding) for finding in findings]
    save_chart_page(sections, path, title(findings), about)


def _section(finding: Finding) -> Section:
    chart, case = finding.chart(), finding.case
    return Section(
        name=case.name,
        title=f"{case.name}: {case.title}",
        lines=[f"Guarantee: {finding.sweep.promise}. It took {finding.seconds:.1f} s."],
        charts=[axes_of(chart)],
        tables=[table_of(chart)],
        verdict=finding.verdict,
        holds=finding.holds,
        pictures=_pictures(finding.rendered),
    )


def _pictures(rendered: Sequence[Image]) -> list[Picture]:
    """At most MOST_PICTURES of the pictures of a case, evenly over its run."""
    seen = [it for it in rendered if min(it.radiance.shape[:2]) >= LEAST_SIDE]
    step = -(-len(seen) // MOST_PICTURES) or 1
    places = range(0, len(seen), step)
    return [small_picture(seen[n], _caption(seen[n], n + 1, len(seen))) for n in places]


def _caption(image: Image, number: int, count: int) -> str:
    method = f", {image.recipe.settings.method}" if image.recipe else ""
    return f"picture {number} of {count}{method}, {image.samples} samples"


def title(findings: Sequence[Finding]) -> str:
    """Return one line for a chart: the cases whose guarantee is broken, if any."""
    broken = [finding.case.name for finding in findings if not finding.holds]
    found = f"broken: {', '.join(broken)}" if broken else "no guarantee is broken"
    return f"glrt stress: {found}"


def summary(findings: Sequence[Finding]) -> dict[str, Any]:
    """The verdict of each case with the figures behind it, for JSON."""
    return {
        finding.case.name: {
            "holds": finding.holds,
            "verdict": finding.verdict,
            "guarantee": finding.sweep.promise,
            "broken": finding.sweep.broken(),
            "seconds": round(finding.seconds, 3),
        }
        for finding in findings
    }
