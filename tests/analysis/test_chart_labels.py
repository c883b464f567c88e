"""Names of curves in a chart: next to their curves, in the axes, none over another."""

import math
from itertools import combinations
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from glrt.analysis import plot
from glrt.analysis.chart import drawing, labels
from glrt.analysis.chart.choice import shown
from glrt.analysis.chart.experiment import Experiment
from glrt.analysis.chart.page import speed_up
from glrt.analysis.chart.rays import Rays
from glrt.analysis.variants import Variant
from glrt.settings import Settings
from tests.support.charted_curves import made, measured

FRAME = (640.0, 480.0)


def some_curves(seed: int) -> list[Any]:
    """Seven curves that fall to the right, as crowded as errors over time."""
    draw = np.random.default_rng(seed)
    curves = []
    for _ in range(7):
        x = np.linspace(draw.uniform(10, 200), draw.uniform(350, 630), 10)
        curves.append(np.stack([x, 460 - draw.uniform(0.3, 0.8) * x + draw.uniform(-10, 10)], 1))
    return curves


def placed(curves: list[Any], width: float = 150.0) -> list[labels.Place]:
    levels = [labels.above(y, curves, (220.0, 14.0), FRAME) for y in (90.0, 250.0, 400.0)]
    names = [labels.around(n, curves, (width, 17.0), FRAME) for n in range(len(curves))]
    return labels.solve([*levels, *names], FRAME)


def overlap(a: Any, b: Any) -> bool:
    return bool(a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3])


def crosses(a: Any, b: Any) -> bool:
    ends = np.array([a, b])[None]
    return bool(labels._crossings(ends[:, 0], ends[:, 1])[0])


@pytest.mark.parametrize("seed", range(12))
def test_no_two_labels_overlap_and_all_lie_in_the_frame(seed: int) -> None:
    places = placed(some_curves(seed))
    for one, other in combinations(places, 2):
        assert not overlap(one.box, other.box)
    for left, bottom, right, top in (place.box for place in places):
        assert 0 < left < right < FRAME[0]
        assert 0 < bottom < top < FRAME[1]


@pytest.mark.parametrize("seed", range(12))
def test_leaders_cross_neither_each_other_nor_labels(seed: int) -> None:
    places = placed(some_curves(seed))
    led = [place for place in places if place.leader]
    for one, other in combinations(led, 2):
        assert not crosses(one.leader, other.leader)
    for one in led:
        for place in places:
            left, bottom, right, top = place.box
            if place is not one:
                assert not crosses(one.leader, ((left, bottom), (right, top)))
                assert not crosses(one.leader, ((left, top), (right, bottom)))


def test_names_of_equal_curves_do_not_overlap() -> None:
    path = np.stack([np.linspace(50, 600, 8), np.linspace(440, 60, 8)], axis=1)
    places = placed([path] * 7)
    assert not any(overlap(one.box, other.box) for one, other in combinations(places, 2))


def test_the_name_of_a_lone_curve_stands_at_its_end_and_covers_no_curve() -> None:
    path = np.array([[50.0, 400.0], [300.0, 100.0]])
    (place,) = labels.solve([labels.around(0, [path], (80.0, 17.0), FRAME)], FRAME)
    assert place.leader is None
    assert place.box[:2] == (309.0, 91.5)


def test_a_name_does_not_cover_another_curve() -> None:
    """At the end of the first curve, the second one is in the way."""
    first = np.array([[50.0, 400.0], [300.0, 100.0]])
    second = np.array([[320.0, 450.0], [320.0, 20.0]])
    both = [first, second]
    place, _ = labels.solve([labels.around(n, both, (80.0, 17.0), FRAME) for n in (0, 1)], FRAME)
    assert place.box[2] < 320 or place.box[0] > 320


def test_the_same_curves_give_the_same_places() -> None:
    assert placed(some_curves(3)) == placed(some_curves(3))


def test_lines_that_cross_are_seen_to() -> None:
    assert crosses(((0, 0), (2, 2)), ((0, 2), (2, 0)))
    assert not crosses(((0, 0), (2, 2)), ((0, 1), (1, 2)))
    assert not crosses(((0, 0), (1, 1)), ((0, 4), (4, 0)))


# --- the picture ---------------------------------------------------------------------------


def experiment(scene: str) -> Experiment:
    curves = tuple(measured(scene))
    whole: Any = SimpleNamespace(radiance=np.zeros((64, 64, 3)))
    variants = tuple(Variant(curve.name, Settings()) for curve in curves)
    return Experiment(
        scene, "A scene", 5, whole, variants, curves, (Rays(4.0),) * len(curves), "here"
    )


@pytest.mark.parametrize("scene", ["daylight", "lattice", "open", "small_lamp", "spots"])
def test_no_two_texts_of_a_measured_chart_overlap(scene: str) -> None:
    with plot.open_figure(drawing.SIZE, drawing.FONT) as figure:
        drawing._fill(figure, experiment(scene), 0.0)
        figure.draw_without_rendering()
        axes = figure.axes[0]
        texts = [text for text in axes.texts if text.get_text()]
        boxes = {text.get_text(): text.get_window_extent().extents for text in texts}
        inside = axes.bbox.extents
    curves = measured(scene)
    for place in shown(curves):
        assert any(text.startswith(curves[place].name) for text in boxes)
    for one, other in combinations(boxes, 2):
        assert not overlap(boxes[one], boxes[other]), (one, other)
    for left, bottom, right, top in boxes.values():
        assert inside[0] < left < right < inside[2]
        assert inside[1] < bottom < top < inside[3]


def arrows(*last_of_naive: float) -> list[str]:
    """The levels of a chart that has the line of `naive` down to these errors, and their arrows."""
    slow = made("naive", *((100.0 * 4**n, e) for n, e in enumerate(last_of_naive)))
    fast = made("mis", *((10.0 * 4**n, 0.4 / 2**n) for n in range(8)))
    with plot.open_figure((6, 4)) as figure:
        axes: Any = figure.subplots()
        times = [[p.milliseconds.value for p in curve.points] for curve in (slow, fast)]
        drawing._draw(axes, [slow, fast], times, [0, 1])
        texts = [text for _, text in drawing._mark_levels(axes, [slow, fast])]
        ends = [text.xy[0] for text in axes.texts if text.arrow_patch]
        right = axes.get_xlim()[1]
    assert all(end < right for end in ends)
    return [text.partition(":")[0] for text in texts[: len(ends)]]


def test_an_arrow_ends_at_a_time_that_was_measured() -> None:
    assert arrows(0.8, 0.2, 0.05) == ["10 %"]
    assert arrows(0.8, 0.2, 0.05, 0.02) == ["10 %", "3 %"]
    assert arrows(0.8, 0.2) == []


def test_a_speed_up_says_whether_both_times_are_measured() -> None:
    fast, slow = made("mis", (1.0, 0.4), (4.0, 0.05)), made("naive", (9.0, 0.4), (99.0, 0.2))
    found = speed_up([slow, fast], 0.1)
    assert found is not None
    assert not found.is_measured
    assert "about" in found.text
    late = made("naive", (9.0, 0.4), (99.0, 0.1))
    found = speed_up([late, fast], 0.1)
    assert found is not None
    assert found.is_measured
    assert math.isclose(found.slow, 99.0)
