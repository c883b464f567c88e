"""Which curves of a chart its picture shows."""

import pytest

from glrt.analysis.chart import page
from glrt.analysis.chart.choice import MOST_NAMED, MOST_SHOWN, called, shown, times_to
from glrt.analysis.chart.curves import LEVELS, Curve
from glrt.analysis.chart.drawing import COLORS, MARKERS
from glrt.analysis.variants import LIVE
from tests.support.charted_curves import CHARTS, made, measured

SCENES = sorted(file.stem for file in CHARTS.glob("*.csv"))


def names(curves: list[Curve], *named: str) -> list[str]:
    return [curves[place].name for place in shown(curves, named)]


@pytest.mark.parametrize("scene", SCENES)
def test_five_to_seven_curves_are_shown_with_the_fastest_at_each_level(scene: str) -> None:
    curves = measured(scene)
    found = names(curves)
    assert 5 <= len(found) <= MOST_SHOWN
    assert len(set(found)) == len(found)
    for level in LEVELS:
        times = [(time[0], c.name) for c in curves if (time := c.milliseconds_to(level))]
        assert min(times)[1] in found


def test_baseline_and_default_come_first_and_named_curves_are_always_shown() -> None:
    curves = measured("diffuse")
    wanted = ["mis, no roulette", "phong", "gather", "resampled", "ddgi"]
    assert len(wanted) == MOST_NAMED
    found = names(curves, *wanted)
    assert found[:2] == ["naive", "mis"]
    assert {called(name, found) for name in wanted} == set(found[2:])
    assert names(curves)[:2] == ["naive", "mis"]


def test_a_curve_that_is_the_fastest_at_hardly_any_error_takes_no_place_beyond_five() -> None:
    ranges = {"a": (1.0, 1.0), "b": (2.0, 0.6), "c": (3.0, 0.4), "d": (4.0, 0.39), "e": (5.0, 0.2)}
    curves = [made("naive", (50.0, 3.0)), made("mis", (60.0, 0.1))]
    curves += [made(name, dot, bias=dot[1]) for name, dot in ranges.items()]
    assert names(curves) == ["naive", "mis", "b", "c", "e"]
    assert "d" in names(curves[:2] + [curve for curve in curves if curve.name == "d"])


def test_a_front_of_many_curves_shows_those_that_are_the_fastest_over_most_errors() -> None:
    errors = [1.0, 0.5, 0.4, 0.2, 0.16, 0.05, 0.01, 0.002]
    curves = [made("naive", (90.0, 3.0)), made("mis", (95.0, 2.0))]
    curves += [made(f"f{n}", (1.0 + n, e), bias=e) for n, e in enumerate(errors)]
    assert names(curves) == ["naive", "mis", "f1", "f3", "f5", "f6", "f7"]


def test_live_probes_are_shown_where_they_are_named_and_are_never_the_fastest() -> None:
    live = made(LIVE, (0.5, 0.05), bias=0.05)
    curves = [made("naive", (90.0, 0.02)), made("mis", (50.0, 0.04)), live]
    assert names(curves) == ["naive", "mis"]
    assert names(curves, LIVE) == ["naive", "mis", LIVE]
    assert [name for _, name, _ in times_to(curves, 0.1)] == ["mis", "naive"]
    assert LIVE not in page._winner(curves, 0.1) + page._front(curves)
    assert called("ddgi", ["ddgi, sobol", LIVE]) == "ddgi, sobol"


def test_a_user_may_call_a_curve_by_one_of_its_names() -> None:
    every = ["naive = nee = mis", "mis, sobol", "ddgi, sobol", "phong = blinn"]
    assert called("mis", every) == "naive = nee = mis"
    assert called("mis, sobol", every) == "mis, sobol"
    assert called("ddgi", every) == "ddgi, sobol"
    assert called("blinn", every) == "phong = blinn"
    assert called("dd", every) is None


def test_each_curve_has_a_colour_and_a_marker_as_on_the_page() -> None:
    text = (CHARTS.parents[2] / "glrt/analysis/chart_page.html").read_text()
    light = text.splitlines()[1]
    for number, color in enumerate(COLORS):
        assert f"--c{number}: {color};" in light
    assert len({*COLORS}) == len({*MARKERS}) == len(COLORS) == len(MARKERS) == MOST_SHOWN
