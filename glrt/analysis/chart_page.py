"""A page of charts: one HTML file that needs no network, whose curves can be read and switched.

Axes are logarithmic, as in `plot`. Values that have no logarithm are drawn at the bottom, if they
are 0, or left out.
"""

import base64
import io
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from glrt.analysis.plot import Chart
from glrt.core.web_page import save_web_page
from glrt.image.image import Image
from glrt.image.tonemap import expose_and_encode

WHITE, TAIL = 0.8, 95.0  # the code of a pixel brighter than TAIL % of a small picture
LEAST_SIDE = 8  # pixels; smaller pictures show nothing


@dataclass(frozen=True)
class Dot:
    """A point of a curve, and the text that is shown next to it; None where it has no value."""

    x: float | None
    y: float | None
    tip: str
    low: float | None = None  # ends of the interval of y
    high: float | None = None


@dataclass(frozen=True)
class Line:
    """A curve, an upper bound without markers, or the steps of a Pareto front."""

    name: str
    dots: Sequence[Dot]
    kind: str = "curve"  # or "bound", "front"
    is_shown: bool = True  # before anything is switched


@dataclass(frozen=True)
class Level:
    """A horizontal line with a text."""

    y: float
    text: str


@dataclass(frozen=True)
class Axes:
    """One pair of logarithmic axes; labels include the unit."""

    title: str
    x_label: str
    y_label: str
    lines: Sequence[Line]
    levels: Sequence[Level] = ()
    limit: float | None = None  # a value of x, marked by a vertical line
    limit_label: str = ""
    is_percent: bool = False  # y is a share


@dataclass(frozen=True)
class Picture:
    """A small picture with its caption."""

    caption: str
    width: int  # pixels
    height: int
    data: str  # a PNG file as a data URI


@dataclass(frozen=True)
class Table:
    """Cells as text; the first row is the head."""

    title: str
    rows: Sequence[Sequence[str]]
    is_open: bool = True  # before anything is clicked


@dataclass(frozen=True)
class Section:
    """The part of a page about one scene or case. Its charts share one legend, by name."""

    name: str  # in the list of sections
    title: str
    lines: Sequence[str]  # paragraphs
    charts: Sequence[Axes]
    tables: Sequence[Table] = ()
    findings: Sequence[str] = ()  # sentences, folded at first
    verdict: str = ""
    holds: bool | None = None  # whether the verdict is good; None: there is none
    pictures: Sequence[Picture] = ()


def save_chart_page(sections: Sequence[Section], path: str | Path, title: str, about: str) -> None:
    """Write the page whole, or not at all; RenderError if it cannot be written."""
    data = {"title": title, "about": about, "sections": [asdict(part) for part in sections]}
    save_web_page(path, f"glrt: {title}", data, ("glrt.analysis", "chart_page.html"))


def axes_of(chart: Chart, title: str = "") -> Axes:
    """The axes of a chart, with its values as texts; its own title is that of the section."""
    lines = [
        Line(
            curve.label,
            [
                Dot(finite(x), finite(y), f"{chart.x_label} {x:.4g}: {y:.3g}")
                for x, y in zip(curve.x, curve.y, strict=True)
            ],
            "bound" if curve.is_bound else "curve",
        )
        for curve in chart.curves
    ]
    labels = (title, chart.x_label, chart.y_label)
    return Axes(*labels, lines, limit=chart.limit, limit_label=chart.limit_label)


def finite(value: float) -> float | None:
    """The value; None for NaN and infinity, which JSON has not."""
    return float(value) if math.isfinite(value) else None


def table_of(chart: Chart) -> Table:
    """Every value of a chart, folded at first: a row for each x, a column for each curve."""
    values = {curve.label: dict(zip(curve.x, curve.y, strict=True)) for curve in chart.curves}
    places = dict.fromkeys(x for curve in chart.curves for x in curve.x)
    rows = [[chart.x_label, *values]]
    for x in places:
        cells = [f"{column[x]:.3g}" if x in column else "" for column in values.values()]
        rows.append([f"{x:.4g}", *cells])
    return Table("values", rows, is_open=False)


def small_picture(image: Image, caption: str) -> Picture:
    """A picture exposed by itself: its brighter pixels, above TAIL %, show WHITE and more."""
    radiance = np.nan_to_num(image.shown, posinf=0.0, neginf=0.0)
    bright = float(np.percentile(radiance.max(axis=2), TAIL))
    codes = expose_and_encode(radiance, math.log2(WHITE / bright) if bright > 0 else 0.0, "neutral")
    return encoded_picture(codes, caption)


def encoded_picture(codes: NDArray[np.uint8], caption: str) -> Picture:
    """A picture of sRGB codes, (H, W, 3), row 0 on top."""
    from PIL import Image as Pillow

    file = io.BytesIO()
    Pillow.fromarray(codes).save(file, format="PNG", optimize=True)
    height, width, _ = codes.shape
    data = base64.b64encode(file.getvalue()).decode()
    return Picture(caption, width, height, f"data:image/png;base64,{data}")
