"""The page of charts, driven in a headless Chromium."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from glrt.analysis import plot
from glrt.analysis.chart import sections
from glrt.analysis.chart.curves import Curve, Interval, Point
from glrt.analysis.chart.experiment import Experiment
from glrt.analysis.chart.rays import Rays
from glrt.analysis.chart_page import axes_of, save_chart_page, small_picture
from glrt.analysis.motion.report import section_of
from glrt.analysis.outputs import Outputs, prepare_outputs
from glrt.analysis.plot import Chart
from glrt.analysis.plot import Curve as Drawn
from glrt.analysis.variants import Variant
from glrt.cli.chart import written
from glrt.core.errors import UsageError
from glrt.image.image import Image
from glrt.lab import report
from glrt.lab.sweep import Case, Finding, Sweep
from glrt.settings import Settings
from tests.analysis.test_motion import TRACKS
from tests.support.browser import codes_of, found_in

SWEEP = Sweep(
    parameter="size",
    measure="error",
    x=[1.0, 10.0, 100.0],
    chosen=("ours", [1e-3, 0.0, 1e-3]),
    others={"naive": [1e-3, 1e-1, math.nan]},
    promise="below 1 in 100, up to 10",
    bound=[0.01] * 3,
    guaranteed=[True, True, False],
)
POINT = """
const chart = sections[0].charts[0], svg = chart.svg, box = svg.getBoundingClientRect();
const move = (x, y) => svg.dispatchEvent(new PointerEvent("pointermove", {
    clientX: box.left + chart.x(x), clientY: box.top + chart.y(y), bubbles: true }));
const press = key => svg.dispatchEvent(new KeyboardEvent("keydown", { key }));
const curves = () => [...svg.querySelectorAll("[data-curve]")].map(it => it.dataset.curve);
"""


def pictures(*levels: float) -> list[Image]:
    return [
        Image(np.full((8, 12, 3), level, np.float32), np.zeros((8, 12, 3), np.float32), 4)
        for level in levels
    ]


def finding(sweep: Sweep = SWEEP, rendered: Any = ()) -> Finding:
    return Finding(Case("</script><b>size", "Sizes", lambda _: sweep), sweep, 1.25, rendered)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of two cases: one holds, one is broken and has pictures."""
    file = tmp_path_factory.mktemp("page") / "page.html"
    broken = replace(SWEEP, wrong=[10.0])
    rendered = pictures(*np.geomspace(1e-3, 1e3, 20))
    report.save_page([finding(), finding(broken, rendered)], file, "a driver")
    return file


def experiment() -> Experiment:
    """One method on the front, the baseline, and another one."""
    exact = Interval(0.0, 0.0, 0.01)

    def curve(name: str, *dots: tuple[float, float]) -> Curve:
        points = tuple(
            Point(2**n, Interval(ms, ms, ms), Interval(error, 0.9 * error, 1.1 * error))
            for n, (ms, error) in enumerate(dots)
        )
        return Curve(name, points, None, exact)

    curves = (
        curve("naive", (3.0, 2.0), (100.0, 1.0)),
        curve("mis", (2.0, 0.5), (20.0, 0.05)),
        curve("slow", (4.0, 0.9), (40.0, 0.5)),
    )
    whole: Any = SimpleNamespace(samples=64, bounces=10, error=0.001, is_doubtful=False)
    whole.radiance = np.zeros((2, 3, 3))
    variants = tuple(Variant(it.name, Settings()) for it in curves)
    rays = tuple(Rays(4.0) for _ in curves)
    return Experiment("room", "A room", 2, whole, variants, curves, rays, "here")


def test_the_page_needs_no_network_and_holds_every_value(page: Path) -> None:
    text = page.read_text()
    assert not re.search(r"https?:|@import|src=|url\(", text)
    assert text.count("</script>") == 3, "a name does not end the data"
    (written,) = re.findall(r'application/json">(.*?)</script>', text, re.DOTALL)
    data = json.loads(written)
    first, second = data["sections"]
    assert (first["verdict"], first["holds"]) == ("holds", True)
    assert (second["verdict"], second["holds"]) == ("BROKEN at 10", False)
    assert first["tables"][0]["rows"][1:] == [
        ["1", "0.001", "0.001", "0.01"],
        ["10", "0", "0.1", "0.01"],
        ["100", "0.001", "nan", ""],
    ]
    assert [dot["y"] for dot in first["charts"][0]["lines"][1]["dots"]] == [0.001, 0.1, None]


def test_a_point_is_read_by_mouse_and_by_keys(page: Path) -> None:
    script = f"""{POINT}
    move(10, 0.1);
    const tip = chart.tip.getBoundingClientRect();
    found = {{ near: chart.tip.textContent, shown: !chart.tip.hidden }};
    found.inside = tip.top > box.top && tip.bottom < box.bottom && tip.left >= box.left;
    move(3, 0.03);
    found.far = chart.tip.hidden;
    press("ArrowRight"); found.first = chart.tip.textContent;
    press("ArrowRight"); found.second = chart.tip.textContent;
    press("ArrowDown"); found.other = chart.tip.textContent;
    press("Escape"); found.left = chart.tip.hidden;
    """
    found = found_in(page, script)
    assert found == {
        "near": "naivesize 10: 0.1",
        "shown": True,
        "inside": True,
        "far": True,
        "first": "ourssize 1: 0.001",
        "second": "ourssize 10: 0",
        "other": "naivesize 10: 0.1",
        "left": True,
    }


def test_the_legend_switches_curves_without_moving_the_others(page: Path) -> None:
    script = f"""{POINT}
    const place = () => svg.querySelector("[data-curve=ours] path").getAttribute("d");
    const before = place(), buttons = sections[0].buttons;
    found = {{ all: curves(), dots: svg.querySelectorAll("[data-curve=naive] .dot").length }};
    buttons[1].click();
    found.less = curves();
    found.pressed = buttons.map(it => it.getAttribute("aria-pressed"));
    found.same = place() === before;
    move(10, 0.1);
    found.unread = chart.tip.hidden;
    buttons[1].click();
    found.again = curves();
    """
    found = found_in(page, script)
    everything = ["ours", "naive", "guaranteed upper bound"]
    assert found["all"] == found["again"] == everything
    assert found["dots"] == 2, "a value that is not a number is no point"
    assert found["less"] == ["ours", "guaranteed upper bound"]
    assert found["pressed"] == ["true", "false", "true"]
    assert found["same"]
    assert found["unread"]


def test_zeros_are_hollow_at_the_bottom(page: Path) -> None:
    script = f"""{POINT}
    const dots = [...svg.querySelectorAll("[data-curve=ours] .dot")];
    found = {{ fills: dots.map(it => it.getAttribute("fill")) }};
    Object.assign(found, {{ bottom: chart.y(0), least: chart.y(1e-3) }});
    """
    found = found_in(page, script)
    assert found["fills"] == ["var(--c0)", "Canvas", "var(--c0)"]
    assert found["bottom"] > found["least"]


@pytest.mark.parametrize(("width", "dark"), [(390, False), (1000, True)])
def test_the_page_fits_and_draws(page: Path, width: int, dark: bool, tmp_path: Path) -> None:
    codes = codes_of(page, tmp_path, width, dark)
    orange = (codes[..., 0] > codes[..., 2] + 150).mean()
    assert orange > 2e-4, "the curve of the naive method"


def test_pictures_are_few_and_exposed_by_themselves(page: Path) -> None:
    script = """
    const shown = [...sections[1].node.querySelectorAll("img")];
    await Promise.all(shown.map(it => it.decode()));
    found = { sizes: shown.map(it => [it.naturalWidth, it.naturalHeight]),
              captions: shown.map(it => it.alt),
              others: sections[0].node.querySelectorAll("img").length };
    """
    found = found_in(page, script)
    assert found["sizes"] == [[12, 8]] * 7
    assert found["captions"][:2] == ["picture 1 of 20, 4 samples", "picture 4 of 20, 4 samples"]
    assert found["others"] == 0
    dark, bright = (small_picture(image, "").data for image in pictures(1e-3, 1e3))
    assert dark == bright


def test_a_chart_shows_the_front_the_default_and_the_baseline_at_first(tmp_path: Path) -> None:
    section = sections.section_of(experiment())
    times, rays = section.charts
    shown = {line.name: line.is_shown for line in times.lines}
    assert shown == {"naive": True, "mis": True, "slow": False, "Pareto front": True}
    front = times.lines[-1]
    assert [(dot.x, dot.y) for dot in front.dots] == [(2.0, 0.5), (20.0, 0.05)]
    assert times.lines[1].dots[1].tip == "2 samples, 20 ms: error 5 % (4.5 % to 5.5 %)"
    assert [dot.x for dot in rays.lines[0].dots] == [4.0, 8.0]
    assert section.tables[0].rows[2][0] == "mis"
    file = tmp_path / "page.html"
    save_chart_page([section], file, "Speed against accuracy", "")
    script = """
    const section = sections[0], all = section.node.querySelectorAll("button");
    const slow = it => it.svg.querySelectorAll("[data-curve=slow]").length;
    const shown = () => section.charts.map(slow);
    const named = name => [...all].find(it => it.textContent === name);
    found = [shown()];
    named("slow").click(); found.push(shown());
    named("as at first").click(); found.push(shown());
    named("all").click(); found.push(shown());
    """
    assert found_in(file, script) == [[0, 0], [1, 1], [0, 0], [1, 1]]


def test_modes_of_a_moving_picture_share_a_legend(tmp_path: Path) -> None:
    section = section_of("room", "A room", TRACKS)
    assert len(section.charts) == 2
    assert [row[0] for row in section.tables[0].rows[1:3]] == [
        "orbit, 1 degree a frame, reset",
        "orbit, 1 degree a frame, reproject",
    ]
    save_chart_page([section], tmp_path / "page.html", "Error while something moves", "")
    script = "found = sections[0].buttons.map(it => it.textContent);"
    assert found_in(tmp_path / "page.html", script) == ["reset", "reproject"]


def test_what_has_no_number_is_no_point() -> None:
    chart = Chart("", "x", "y", [Drawn("a", [1.0, math.inf], [math.nan, 2.0])])
    (line,) = axes_of(chart).lines
    assert [(dot.x, dot.y) for dot in line.dots] == [(1.0, None), (None, 2.0)]


def test_a_page_alone_needs_no_matplotlib(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plot, "find_spec", lambda _name: None)
    made, file = tmp_path / "made", tmp_path / "page.html"
    assert prepare_outputs(None, str(file), ["a.svg"]) == (None, file)
    with pytest.raises(UsageError, match="pip install"):
        prepare_outputs(made, str(file), ["a.svg"])
    assert list(tmp_path.iterdir()) == []


def refusal(folder: Path, file: Path) -> str:
    try:
        prepare_outputs(folder, str(file), [])
    except UsageError as error:
        return str(error)
    return ""


def test_a_page_may_lie_in_the_folder_that_is_made(tmp_path: Path) -> None:
    made = tmp_path / "made"
    assert prepare_outputs(made, str(made / "page.html"), ["a.svg"]).folder == made
    (made / "taken.html").mkdir()
    for file in (made / "taken.html", tmp_path / "no" / "page.html", made / "page.svg"):
        assert f"Cannot write {file}" in refusal(tmp_path / "other", file)
    assert not (tmp_path / "other").exists()


@pytest.mark.parametrize(
    ("folder", "page", "said"),
    [
        (None, "a.html", "Wrote a.html."),
        ("out", None, "Wrote out/chart.md and the charts of sky, lens."),
        ("out", "a.html", "Wrote out/chart.md, a.html and the charts of sky, lens."),
    ],
)
def test_only_what_was_written_is_named(folder: str | None, page: str | None, said: str) -> None:
    outputs = Outputs(Path(folder) if folder else None, Path(page) if page else None)
    assert written(outputs, "chart.md", ["sky", "lens"]) == said
