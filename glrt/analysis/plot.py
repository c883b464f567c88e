"""The common style of charts: log-log axes, readable without colour, files written atomically.

Colours are those of Okabe and Ito, which remain distinct with colour blindness; markers and dashes
distinguish curves in black and white. Matplotlib is imported when the first chart is drawn.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from glrt.core import files
from glrt.core.errors import UsageError
from glrt.core.install import install

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.ticker import Formatter

FORMATS = (".svg", ".png")
_STYLES = (  # colour, marker, dashes: one row for each curve of a chart
    ("#0072b2", "o", "-"),
    ("#d55e00", "s", "--"),
    ("#009e73", "^", "-."),
    ("#cc79a7", "D", ":"),
    ("#56b4e9", "v", (0, (5, 1, 1, 1, 1, 1))),
    ("#e69f00", "P", (0, (8, 2))),
    ("#777777", "X", (0, (2, 1))),
    ("#000000", "*", (0, (1, 2))),
    ("#882255", "p", (0, (3, 1, 1, 1))),
    ("#999933", "h", (0, (6, 1, 2, 1))),
)
IN_LEGEND, LINE = 5, 0.2  # lines that a chart of a sheet has room for; inches of one more
LEAST_WIDTH = 5.2  # inches of a sheet: its title has room
MOST_UPWARDS = 40  # letters of a line that is written upwards next to a chart of a sheet
SMALL = 8.5  # points of the labels of a chart of a sheet
MOST_ACROSS = 58  # letters of a line below it
MOST_CURVES = len(_STYLES)  # curves that a chart can distinguish
_HOLLOW = "hollow markers: 0"
_LOOK: dict[Any, Any] = {
    "font.family": ["DejaVu Sans"],  # comes with matplotlib: identical charts everywhere
    "font.size": 10.0,
    "axes.titlesize": 11.0,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "savefig.dpi": 110,
    "svg.hashsalt": "glrt",  # identical charts give identical files
}


@dataclass(frozen=True)
class Curve:
    """Values y over x. Zeros, which have no logarithm, are drawn at the bottom, hollow."""

    label: str
    x: Sequence[float]
    y: Sequence[float]
    is_bound: bool = False  # an upper bound: a thin line without markers


@dataclass(frozen=True)
class Chart:
    """The content of one pair of logarithmic axes; labels include the unit."""

    title: str
    x_label: str
    y_label: str
    curves: Sequence[Curve]
    limit: float | None = None  # a value of x, marked by a vertical line
    limit_label: str = ""
    note: str = ""  # a line below the title


def check_matplotlib() -> None:
    """Raise UsageError if matplotlib is not installed."""
    if find_spec("matplotlib") is None:
        raise UsageError(
            f"Charts are drawn by matplotlib, which is not installed: type `{install('chart')}`."
        )


def save_chart(chart: Chart, path: Path) -> None:
    """Write one chart; the suffix of `path` is its format, .svg or .png."""
    with open_figure((7.2, 5.0)) as figure:
        axes = figure.subplots()
        _draw(axes, chart)
        figure.legend(loc="outside lower left", ncols=1)
        save_figure(figure, path)


def save_sheet(charts: Sequence[Chart], path: Path, title: str, columns: int = 4) -> None:
    """Write all charts into one figure, in rows of `columns`, each with its own legend."""
    rows = -(-len(charts) // columns)
    columns = min(columns, len(charts))
    more = max(0, max(len(chart.curves) for chart in charts) - IN_LEGEND)
    width = max(4.1 * columns, LEAST_WIDTH)
    with open_figure((width, (3.7 + LINE * more) * rows + 0.4)) as figure:
        figure.suptitle(title, x=0.01, ha="left", fontsize=14)
        grid = np.atleast_1d(figure.subplots(rows, columns)).ravel()
        for axes, chart in zip(grid, charts, strict=False):
            _draw(axes, chart)
            axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.22), fontsize=8)
            axes.set_xlabel(fill(chart.x_label, MOST_ACROSS), size=SMALL)
            axes.set_ylabel(fill(chart.y_label, MOST_UPWARDS), size=SMALL)
        for axes in grid[len(charts) :]:
            axes.set_axis_off()
        save_figure(figure, path)


@contextmanager
def open_figure(size: tuple[float, float], font: float = 10.0) -> "Iterator[Figure]":
    """An empty figure in the common style; `size` in inches, `font` in points."""
    check_matplotlib()
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context({**_LOOK, "font.size": font}):
        yield Figure(size, layout="constrained")


def _draw(axes: "Axes", chart: Chart) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_minor_formatter(_short_labels())
    axes.yaxis.set_minor_formatter(_short_labels())
    axes.set_title(chart.title + (f"\n{chart.note}" if chart.note else ""))
    axes.set_xlabel(chart.x_label)
    axes.set_ylabel(chart.y_label)
    bottom = _bottom(chart.curves)
    styles = iter(_STYLES)
    width = 2.6  # of the first curve: wider, so that it shows below others that cover it
    for curve in chart.curves:
        if curve.is_bound:
            axes.plot(curve.x, curve.y, color="#555555", lw=1.0, ls=(0, (2, 2)), label=curve.label)
        else:
            _draw_curve(axes, curve, next(styles), bottom, width)
            width = 1.4
    if chart.limit is not None:
        axes.axvline(chart.limit, color="#555555", lw=1.0, label=chart.limit_label)


def _short_labels() -> "Formatter":
    """Labels between powers of ten, on axes that span about one: 20, not 2 x 10^1."""
    from matplotlib.ticker import LogFormatter

    class Short(LogFormatter):
        def __call__(self, x: float, pos: int | None = None) -> str:
            return f"{x:g}" if super().__call__(x, pos) else ""

    return Short(labelOnlyBase=False, minor_thresholds=(1, 0.4))


def _draw_curve(axes: "Axes", curve: Curve, style: Any, bottom: float, width: float) -> None:
    color, marker, dashes = style
    look = {"color": color, "marker": marker, "lw": width, "ms": 2.5 + 1.5 * width}
    y = np.array(curve.y, np.float64)
    shown = np.where(y > 0, y, bottom)
    axes.plot(curve.x, shown, **look, ls=dashes, label=curve.label)
    zero = y <= 0
    if zero.any():
        told = any(line.get_label() == _HOLLOW for line in axes.lines)
        hollow = {**look, "ls": "none", "mfc": "white", "zorder": 3}
        axes.plot(np.array(curve.x)[zero], shown[zero], **hollow, label="" if told else _HOLLOW)


def _bottom(curves: Sequence[Curve]) -> float:
    """The ordinate at which zeros are drawn: a power of ten below all positive values."""
    positive = [y for curve in curves for y in curve.y if y > 0]
    return float(10 ** (np.floor(np.log10(min(positive))) - 1)) if positive else 1.0


def save_figure(figure: "Figure", path: Path) -> None:
    """Write a figure atomically; the suffix of `path` is its format, .svg or .png.

    Raises UsageError for another suffix.
    """
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise UsageError(f"Cannot write {path}: the name of a chart ends in .svg or .png.")
    metadata = {"Date": None} if suffix == ".svg" else None
    files.write_whole(
        path, lambda target: figure.savefig(target, format=suffix[1:], metadata=metadata)
    )
