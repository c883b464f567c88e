"""A live picture without a notebook: it refines, obeys the mouse and sliders, and rests."""

import math
from typing import Any

import pytest

from glrt.core.errors import UsageError
from glrt.notebook.live import MOST_WAITS, Live
from glrt.notebook.live import STILL as AT_ONCE
from glrt.notebook.shared_context import HOLD
from glrt.rendering.renderer import Renderer
from glrt.view.state.error_history import PAUSE
from glrt.view.state.idle_kernel import PAUSES
from glrt.view.state.preview_size import STILL
from tests.notebook.answers import Opening, asked, begun, codes, costs, row, samples
from tests.support.sessions import Clock, Stage


def distance(live: Live) -> float:
    return math.dist(live.state.scene.camera.position, (0, 0, 0))


def test_a_kernel_is_announced_and_then_the_picture_refines(live: Live) -> None:
    first = live.answer({})
    assert "Compiling" in first.content["notice"]
    assert first.picture is None
    assert first.content["wait"] == 0
    shown = begun(live)
    assert codes(shown).shape == (16, 16, 3)
    assert shown.content["notice"] == ""
    assert samples(asked(live, 3)) > samples(shown)


def test_a_drag_turns_about_the_target_and_the_wheel_moves_towards_it(live: Live) -> None:
    begun(live)
    before, first = distance(live), live.state.scene.camera
    asked(live, turn=[0.25, 0.1])
    assert live.state.scene.camera.position[0] < first.position[0] - 1, "the scene follows the hand"
    assert distance(live) == pytest.approx(before)
    asked(live, wheel=2)
    assert distance(live) == pytest.approx(0.81 * before)
    asked(live, home=True)
    assert live.state.scene.camera == first


def test_pictures_of_a_moving_camera_are_coarse_if_they_take_long(live: Live, clock: Clock) -> None:
    begun(live)
    clock.step = 0.05
    asked(live, 3)
    coarse = [asked(live, turn=[0.1, 0]) for _ in range(6)][-1]
    assert codes(coarse).shape[0] < 16
    assert coarse.content["figures"][0].endswith("coarse while it moves")
    clock.now += STILL
    clock.step = 0.001
    assert codes(asked(live, 3)).shape == (16, 16, 3)


def test_a_still_picture_has_full_size_and_is_the_first_that_a_page_gets(
    live: Live, clock: Clock
) -> None:
    start = clock.now
    still = live.still()
    assert still
    assert codes(still).shape == (16, 16, 3)
    assert samples(still) > 4
    assert clock.now - start < 3 * AT_ONCE
    first = live.answer({})
    assert samples(first) >= samples(still)
    assert first.picture, "a page that comes later has seen nothing yet"


def test_a_light_gets_brighter_without_losing_a_sample(live: Live) -> None:
    before = begun(live)
    assert costs(before, "light lamp") == ["relight"]
    after = asked(live, lights={"lamp": 3.0})
    assert samples(after) >= samples(before)
    assert codes(after).mean() > 1.1 * codes(before).mean()
    assert row(after, "light lamp")["value"] == 3


def test_other_bounces_restart_and_another_number_of_samples_does_not(live: Live) -> None:
    begun(live)
    before = asked(live, 4)
    assert (costs(before, "bounces"), costs(before, "samples")) == (["restart"], ["free"])
    more = asked(live, settings={"samples": 2000})
    assert samples(more) >= samples(before)
    fewer = asked(live, settings={"bounces": 1})
    assert samples(fewer) < samples(more)
    assert (row(fewer, "bounces")["value"], row(fewer, "samples")["value"]) == (1, 2000)


def test_a_picture_that_is_done_is_exact_and_asks_for_no_more(opened: Opening) -> None:
    live = opened(samples=4)
    begun(live)
    last = asked(live, 4)
    while last.picture is None or last.content["wait"] is not None:
        last = asked(live)
        assert samples(last) <= 4
        if last.content["wait"] is None:
            break
    image = live.image()
    assert image.samples == 4
    again = asked(live)
    assert again.picture is None
    assert again.content["wait"] is None


def test_error_and_forecast_are_those_of_the_picture(opened: Opening, clock: Clock) -> None:
    live = opened(samples=64)
    begun(live)
    reply = asked(live)
    assert "known from 32 samples on" in reply.content["figures"][1]
    for _ in range(200):
        clock.now += PAUSE if reply.content["wait"] != 0 else 0
        reply = asked(live)
        if reply.content["wait"] is None:
            break
    error = live.image().error
    assert error
    told = float(reply.content["figures"][1].split()[1])
    assert told == pytest.approx(100 * error, rel=0.06)
    assert "2 %" in reply.content["figures"][2]
    assert "raise samples to" in reply.content["figures"][2]


def test_a_done_picture_without_an_error_waits_a_few_times_alone(
    opened: Opening, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("glrt.view.state.error_history.Reading.look", lambda _: None)
    live = opened(samples=32)
    begun(live)
    waits: list[float | None] = []
    while None not in waits:
        waits.append(asked(live).content["wait"])
        assert len(waits) < 200
    assert waits.count(PAUSE) == MOST_WAITS


@pytest.mark.parametrize(
    ("message", "text"),
    [
        ({"turn": [math.nan, 0]}, "finite"),
        ({"lights": {"moon": 1}}, "moon"),
        ({"settings": {"bounces": -1}}, "bounces"),
        ({"settings": {"method": 1}}, "method"),
        ("stop", "message"),
    ],
)
def test_input_that_makes_no_sense_is_reported_and_the_picture_goes_on(
    live: Live, message: Any, text: str
) -> None:
    before, state = begun(live), live.state
    reply = live.answer(message)
    assert text in reply.content["notice"]
    assert reply.content["is_problem"]
    assert live.state == state
    later = asked(live, 4)
    assert text in later.content["notice"]
    assert samples(later) > samples(before)
    assert asked(live, settings={"samples": 900}).content["notice"] == ""


def test_it_rests_and_begins_again_from_the_same_view(live: Live) -> None:
    begun(live)
    asked(live, 4, turn=[0.2, 0], settings={"samples": 900})
    before = live.state
    live.rest()
    assert live.state == before
    with pytest.raises(UsageError, match="no sample yet"):
        live.image()
    first = live.answer({})
    assert first.picture is None
    assert samples(first) == 0
    assert codes(begun(live)).shape == (16, 16, 3)
    assert live.state == before


def test_a_scene_that_the_driver_refuses_is_reported(
    live: Live, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise UsageError("too many shapes")

    monkeypatch.setattr(Renderer, "__init__", refuse)
    reply = begun(live)
    assert reply.content["notice"] == "too many shapes"
    assert reply.content["wait"] is None


def test_pictures_of_one_context_do_not_disturb_each_other(opened: Opening, clock: Clock) -> None:
    one, other = opened(), opened(seed=7)
    begun(one)
    begun(other)
    for _ in range(3):
        asked(one)
        asked(other)
    before = other.image().samples
    asked(one, turn=[0.3, 0])
    one.rest()
    clock.now += HOLD
    assert samples(asked(other, 4)) > before


def test_a_picture_rests_while_another_follows_the_mouse(opened: Opening, clock: Clock) -> None:
    one, other = opened(), opened(seed=7)
    begun(one)
    before = samples(begun(other))
    asked(one, turn=[0.3, 0])
    waiting = other.answer({})
    assert waiting.content == {"wait": HOLD}
    assert waiting.picture is None
    assert other.image().samples == before
    assert asked(one, 3).content["wait"] == 0, "the one that moves goes on"
    clock.now += HOLD
    assert samples(asked(other, 4)) > before
    asked(one, turn=[0.3, 0])
    assert other.answer({"turn": [0.1, 0]}).content["wait"] == 0, "input is never left waiting"


@pytest.mark.slow
def test_a_picture_at_rest_takes_a_faster_kernel_and_keeps_its_samples(
    opened: Opening, clock: Clock
) -> None:
    live = opened(Stage(), seed=3)
    begun(live)
    before = samples(asked(live, 3))
    clock.now += STILL
    for pause in PAUSES.values():
        clock.now += pause
        after = asked(live, 4)
    assert live._session
    assert live._session.renderer
    assert live._session.renderer.is_baked
    assert samples(after) >= before
