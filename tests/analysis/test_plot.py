"""Charts: readable in black and white, whole or absent, and the same each time."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from glrt.analysis import plot
from glrt.analysis.plot import Chart, Curve, save_chart, save_sheet
from glrt.core.errors import RenderError, UsageError

X = [1.0, 10.0, 100.0]
CHART = Chart(
    title="Errors",
    x_label="distance in radii",
    y_label="relative error",
    curves=[
        Curve("ours", X, [1e-7, 0.0, 1e-6]),
        Curve("naive", X, [1e-6, 1e-3, 1.0]),
        Curve("bound", X, [1e-5] * 3, is_bound=True),
    ],
    limit=10.0,
    limit_label="ends here",
    note="holds",
)


@pytest.mark.slow
def test_a_chart_is_written_in_the_format_of_its_suffix(tmp_path: Path) -> None:
    for suffix, magic in ((".svg", b"<?xml"), (".png", b"\x89PNG")):
        save_chart(CHART, tmp_path / f"a{suffix}")
        assert (tmp_path / f"a{suffix}").read_bytes().startswith(magic)
    with pytest.raises(UsageError, match=r"ends in \.svg or \.png"):
        save_chart(CHART, tmp_path / "a.jpg")
    assert not (tmp_path / "a.jpg").exists()


@pytest.mark.slow
def test_the_same_chart_gives_the_same_file(tmp_path: Path) -> None:
    for suffix in plot.FORMATS:
        files = [tmp_path / f"{name}{suffix}" for name in "ab"]
        for file in files:
            save_chart(CHART, file)
        assert files[0].read_bytes() == files[1].read_bytes(), suffix


def test_curves_differ_without_colour() -> None:
    assert len({marker for _, marker, _ in plot._STYLES}) == len(plot._STYLES)
    assert len({str(dashes) for _, _, dashes in plot._STYLES}) == len(plot._STYLES)
    assert len({color for color, _, _ in plot._STYLES}) == len(plot._STYLES)


def test_everything_is_drawn_even_zeros(tmp_path: Path) -> None:
    """Matplotlib names what it draws in the comments of an SVG file: its texts among them."""
    save_chart(CHART, tmp_path / "a.svg")
    shown = re.findall(r"<!-- (.*?) -->", (tmp_path / "a.svg").read_text())
    for text in ("Errors", "holds", "distance in radii", "relative error", "ours", "ends here"):
        assert text in shown
    assert plot._bottom(CHART.curves) == 1e-8
    assert plot._bottom([Curve("nothing", [1.0], [0.0])]) == 1.0


@pytest.mark.slow
def test_a_sheet_holds_all_charts(tmp_path: Path) -> None:
    for count, columns in ((1, 4), (3, 2)):
        charts = [replace(CHART, title=f"Case {i}") for i in range(count)]
        file = tmp_path / "a.png"
        save_sheet(charts, file, "All", columns)
        with Image.open(file) as picture:
            ink = np.asarray(picture.convert("L")) < 250
        shown = min(columns, count)
        thirds = np.array_split(ink, shown, axis=1)
        assert all(third.mean() > 0.01 for third in thirds)


def test_a_chart_that_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(RenderError, match="Cannot write"):
        save_chart(CHART, tmp_path / "nowhere" / "a.svg")
    assert list(tmp_path.iterdir()) == []


def test_without_matplotlib_it_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(plot, "find_spec", lambda _name: None)
    with pytest.raises(UsageError, match="pip install"):
        save_chart(CHART, tmp_path / "a.svg")
