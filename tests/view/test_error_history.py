"""The error over time: when it is looked at, and when it will be small enough."""

import math
from threading import Event
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bench.fooling_scenes import fooling_scene
from glrt.error.estimate import Band
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.plan.plan import ONE, Weight
from glrt.view.figure_texts import error_text, forecast
from glrt.view.state import error_history
from glrt.view.state.error_history import EMPTY, GROWTH, PAUSE, Look, Progress, read
from tests.support.mixed_scene import everything
from tests.support.renders import rendering

HALF: Weight = (0.5, 0.5, 0.5)


def seen(samples: int, seconds: float, error: float) -> Look:
    return Look(samples, seconds, Band(error, 0.9 * error, 1.1 * error))


def test_looks_come_with_growing_samples_and_pauses() -> None:
    progress = Progress()
    assert not progress.is_due(1, 10.0)
    assert progress.is_due(2, 10.0)
    progress.record(seen(100, 1.0, 0.5), 10.0)
    assert not progress.is_due(1000, 10.0 + PAUSE / 2)
    assert not progress.is_due(int(100 * GROWTH) - 1, 10.0 + PAUSE)
    assert progress.is_due(int(100 * GROWTH), 10.0 + PAUSE)


def test_a_picture_that_is_done_is_looked_at_once_more() -> None:
    progress = Progress()
    assert progress.is_due(100, 10.0)
    progress.record(seen(100, 1.0, 0.5), 10.0)
    assert not progress.is_due(101, 20.0)
    assert progress.is_due(101, 20.0, is_done=True)
    progress.record(seen(101, 1.0, 0.5), 20.0)
    assert not progress.is_due(101, 30.0, is_done=True)


def test_another_picture_forgets_the_one_before() -> None:
    progress = Progress()
    progress.begin("one", "light")
    progress.record(seen(100, 1.0, 0.5), 0.0)
    progress.begin("one", "light")
    assert progress.last
    progress.begin("another", "light")
    assert progress.is_due(2, 10.0)
    assert progress.last is None
    assert progress.remaining(0.1) is None


def test_the_history_stays_over_a_relight_and_the_figure_does_not() -> None:
    progress = Progress()
    progress.begin("picture", "dim")
    for look in (seen(40, 1.0, 0.2), seen(60, 2.0, 0.15)):
        progress.record(look, 0.0)
    progress.begin("picture", "bright")
    assert progress.last is None
    assert progress.remaining(0.1) is None
    assert progress.is_due(61, 10.0)
    progress.record(seen(80, 3.0, 0.1), 10.0)
    assert [look.samples for look in progress.relit] == [40, 60]
    assert [look.samples for look in progress.drawn] == [80]
    first, last, least, most = progress.limits()
    assert first < 1.0 < 3.0 < last
    assert least < 0.1 < 0.2 < most
    progress.begin("another", "bright")
    assert progress.relit == progress.drawn == []
    assert progress.limits() == EMPTY


class Watched:
    """A session with a picture of 100 samples, whose figures are ready once `ready` is set."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.ready, self.found = Event(), seen(100, 1.0, 0.5)
        moving = SimpleNamespace(is_shown=lambda *_: False)
        self.session: Any = SimpleNamespace(
            renderer=object(), restarts=1, weights="light", moving=moving, rendering=1.0
        )
        self.session.settings = SimpleNamespace(samples=1000)
        self.session.samples, self.session.known_from = 100, 2
        self.session.is_passing = self.session.is_done = False
        reading = SimpleNamespace(look=self._look)
        monkeypatch.setattr(error_history, "read", lambda *_: reading)

    def _look(self) -> Look:
        assert self.ready.wait(10)
        return self.found


def test_a_frame_does_not_wait_for_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    watched, progress = Watched(monkeypatch), Progress(in_thread=True)
    for frame in range(3):
        assert progress.follow(watched.session, 10.0 + frame) is None
        assert progress.is_looking
    watched.ready.set()
    assert progress._awaited
    progress._awaited.result(60)
    assert progress.follow(watched.session, 20.0) is watched.found
    assert progress.looks == [watched.found]
    assert not progress.is_looking


@pytest.mark.parametrize(("name", "value"), [("restarts", 2), ("weights", "dim")])
def test_figures_of_a_picture_that_is_gone_are_dropped(
    monkeypatch: pytest.MonkeyPatch, name: str, value: object
) -> None:
    watched, progress = Watched(monkeypatch), Progress(in_thread=True)
    progress.follow(watched.session, 10.0)
    late = progress._awaited
    assert late
    setattr(watched.session, name, value)
    watched.session.samples = 1  # too few for a look
    watched.ready.set()
    late.result(60)
    assert progress.follow(watched.session, 20.0) is None
    assert progress.looks == []
    assert not progress.is_looking


def test_the_forecast_is_that_of_noise() -> None:
    progress = Progress()
    progress.record(seen(64, 2.0, 0.2), 0.0)
    assert progress.remaining(0.1) == pytest.approx(6.0), "half the error takes four times as long"
    assert progress.remaining(0.3) == 0


@pytest.mark.parametrize(
    ("target", "samples", "told"),
    [
        (0.3, 64, "30 % is reached"),
        (0.1, 260, "10 % in about 6 s more"),
        (0.1, 259, "10 % in about 6 s more: raise samples to 260"),
        (0.019, 256, "1.9 % in about 4 minutes more: raise samples to 7,100"),
        (0.0001, 256, "0.01 % takes more samples than a picture holds"),
    ],
)
def test_the_forecast_reports_when_the_samples_end_before(
    target: float, samples: int, told: str
) -> None:
    progress = Progress()
    assert forecast(progress, target, samples).endswith("time not known yet")
    progress.record(seen(64, 2.0, 0.2), 0.0)
    assert forecast(progress, target, samples) == told


def test_the_line_has_slope_minus_one_half_and_ends_at_the_last_look() -> None:
    progress = Progress()
    for look in (seen(4, 1.0, 0.9), seen(64, 16.0, 0.2)):
        progress.record(look, 0.0)
    seconds, errors = progress.slope()
    assert seconds == [1.0, 16.0]
    assert errors == pytest.approx([0.8, 0.2])


def test_a_plot_holds_all_looks_and_a_tick_of_each_axis() -> None:
    progress = Progress()
    assert progress.limits() == EMPTY
    for look in (seen(40, 2.05, 0.1032), seen(41, 2.06, 0.1031)):
        progress.record(look, 0.0)
    first, last, least, most = progress.limits()
    assert first < 2.05 < 2.06 < last
    assert least < 0.1031 < 0.1032 < most
    for low, high in ((first, last), (least, most)):
        ticks = [share * 10.0**power for power in range(-4, 3) for share in (1, 2, 5)]
        assert any(low <= tick <= high for tick in ticks)


def test_a_plot_holds_the_way_to_a_target_that_is_not_too_far() -> None:
    progress = Progress()
    assert progress.way_to(0.02) == ([], []), "nothing is known yet"
    for look in (seen(40, 1.0, 0.2), seen(160, 4.0, 0.1)):
        progress.record(look, 0.0)
    assert progress.way_to(0.05) == ([4.0, pytest.approx(16.0)], [0.1, 0.05])
    _, last, least, _ = progress.limits(0.05)
    assert last > 16
    assert least < 0.05
    for reached_or_far in (0.1, 0.2, 0.1 / 10.1):
        assert progress.way_to(reached_or_far) == ([], [])
        assert progress.limits(reached_or_far) == progress.limits()


@pytest.mark.parametrize("error", [0.0, math.inf])
def test_a_look_that_no_logarithm_has_a_place_for_is_left_out_of_the_plot(error: float) -> None:
    progress = Progress()
    for look in (seen(40, 1.0, error), seen(41, 2.0, error)):
        progress.record(look, 0.0)
    assert progress.limits() == EMPTY
    for look in (seen(42, 3.0, 0.1), seen(43, 4.0, 0.05)):
        progress.record(look, 0.0)
    assert [look.samples for look in progress.drawn] == [42, 43]
    assert progress.limits()[2] > 0


def test_a_look_reports_what_the_picture_tells(context: Context) -> None:
    weights = ((2.0, 2.0, 2.0),)
    with rendering(everything(), context) as renderer:
        renderer.render(1)
        with context.gl:
            assert read(renderer, (ONE,), 0.1).look() is None
        image = renderer.render(8).image()
        with context.gl:
            look = read(renderer, weights, 0.5).look()
    assert look is not None
    assert (look.samples, look.seconds, look.nonfinite) == (8, 0.5, 0)
    assert look.error == pytest.approx(image.error), "light that is twice as much is as sure"
    assert look.mean == pytest.approx(2 * image.radiance.mean(dtype=np.float64))


def test_the_rim_of_a_small_sun_is_not_believed(context: Context) -> None:
    """One pixel carries the error: 2.6 % are estimated, 13 % are true."""
    scene, _ = fooling_scene("rims of small suns", 30014)
    size = {"width": 48, "height": 36, "bounces": 6, "sampler": "sobol", "seed": 4}
    with rendering(scene, context, **size) as renderer:
        renderer.render(64)
        with context.gl:
            look = read(renderer, (ONE,), 1.0).look()
    assert look
    assert look.error < 0.03
    assert "not to be believed" in error_text(look)


@pytest.mark.parametrize("is_rim", [True, False])
def test_an_error_that_is_not_to_be_believed_is_reported_so(context: Context, is_rim: bool) -> None:
    size = {"width": 48, "height": 36, "bounces": 6, "sampler": "sobol", "seed": 4}
    scene = fooling_scene("rims of small suns", 30014)[0] if is_rim else load("metals")
    with rendering(scene, context, **size) as renderer:
        renderer.render(64)
        with context.gl:
            known, relit = (read(renderer, (weight,), 1.0).look() for weight in (ONE, HALF))
    assert known
    assert known.is_doubtful is is_rim
    assert ("not to be believed" in error_text(known)) is is_rim
    assert relit
    assert relit.is_doubtful is None, "of other light"
