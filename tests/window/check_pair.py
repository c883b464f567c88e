"""A and B: two pictures that both go on gathering."""

import numpy as np
import pytest

from glrt.core.errors import RenderError
from glrt.view.compared_picture import Pair, Slot
from glrt.view.state.session import Session
from tests.window.gestures import move
from tests.window.hand import Hand, check


def keep_and_go_on(hand: Hand) -> Pair:
    """Keep the picture, change B, and let A go on."""
    ctx, pair = hand.ctx, hand.window.app.pair
    hand.until(lambda: hand.session.samples > 0)
    ctx.item_click("//Controls/keep this picture")
    ctx.yield_(2)
    move(hand, "bounces", 1)
    hand.settle()
    ctx.item_click("//Controls/render A too")
    hand.until(lambda: bool(pair.slot and pair.slot.session.samples > 0))
    return pair


@check
def both_gather_at_equal_samples(hand: Hand) -> None:
    pair, session = keep_and_go_on(hand), hand.session
    assert pair.slot
    move(hand, "pairing/equal samples", None)
    assert pair.pairing == "equal samples"
    other = pair.slot.session

    def apart() -> int:
        return abs(session.samples - other.samples)

    hand.until(lambda: apart() <= 8 and other.samples > 0)  # who is behind has all frames
    before = other.samples
    while min(session.samples, other.samples) < before + 10:
        hand.ctx.yield_()
        assert apart() <= 8, "the samples of a frame or two"
    assert (session.settings.bounces, other.settings.bounces) == (1, 10)
    forget(hand)


@check
def both_gather_in_equal_time(hand: Hand) -> None:
    """The test has its own clock: A's frames take three times as long."""
    pair, session = keep_and_go_on(hand), hand.session
    assert pair.slot
    other, turns = pair.slot.session, dict[Session, int]()

    def advance(self: Session, seconds: float, count: int = 0) -> None:
        if self is session and session.waits:
            return
        turns[self] = turns.get(self, 0) + 1
        self.rendering += 3.0 if self is other else 1.0

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Session, "advance", advance)
        session.rendering = other.rendering = 0.0
        hand.until(lambda: turns.get(session, 0) >= 30)
    assert turns[session] / turns[other] == pytest.approx(3, rel=0.2)
    forget(hand)


@check
def the_pictures_are_those_of_renders_of_each_alone(hand: Hand) -> None:
    """A, at ten bounces, is as it was before it was kept; B is at one."""
    session = hand.session
    hand.until(lambda: session.samples >= 16)
    hand.there(lambda: session.edit(samples=16))
    hand.there(hand.window.app.restart)
    hand.until(lambda: session.is_done and session.samples == 16)
    hand.ctx.yield_(2)
    before = hand.pixels()
    pair = keep_and_go_on(hand)
    hand.until(lambda: session.is_done and pair.is_done)
    hand.ctx.yield_(3)
    assert pair.slot
    picture = pair.slot.picture

    def codes() -> np.ndarray:
        return picture.codes()[::-1]

    assert np.array_equal(hand.there(codes), before)
    assert not np.array_equal(hand.pixels(), before)
    forget(hand)


@check
def they_stand_side_by_side_or_behind_a_line(hand: Hand) -> None:
    app = hand.window.app
    pair = keep_and_go_on(hand)
    width = app.rectangle[2]
    hand.ctx.item_click("//Controls/side by side")
    hand.ctx.yield_(3)
    left, top, half, height = app.rectangle
    assert half <= width
    screen = hand.screen().astype(int)
    assert pair.slot
    step = imgui_room(hand) / 2
    a = screen[int(top + 0.6 * height), int(left - step + 0.3 * half)]
    b = screen[int(top + 0.6 * height), int(left + 0.3 * half)]
    assert a.sum() > b.sum() + 30, "ten bounces are brighter than one"
    hand.ctx.item_click("//Controls/side by side")
    hand.ctx.yield_(2)
    assert app.rectangle[2] == width
    forget(hand)


def imgui_room(hand: Hand) -> float:
    """The width of the part of the window that holds the picture, without its margins."""
    window = hand.ctx.window_info("//Picture").window
    assert window
    return float(window.work_rect.max.x - window.work_rect.min.x)


@check
def they_are_swapped_and_b_comes_back_by_undo(hand: Hand) -> None:
    pair, session = keep_and_go_on(hand), hand.session
    before = session.state
    hand.ctx.item_click("//Controls/swap A and B")
    hand.settle()
    assert session.settings.bounces == 10
    hand.until(lambda: bool(pair.slot and pair.slot.session.samples > 0))
    assert pair.slot
    assert pair.slot.session.settings.bounces == 1
    hand.ctx.item_click("//Picture/###undo")
    assert session.state == before
    forget(hand)


@check
def what_is_known_of_a_stands_next_to_what_is_known_of_b(hand: Hand) -> None:
    from glrt.view.panels.plots import figures

    pair = keep_and_go_on(hand)
    assert pair.slot
    slot = pair.slot
    hand.until(lambda: slot.progress.last is not None)
    assert any(line.startswith("A: ") and "error" in line for line in figures(hand.window.app))
    forget(hand)
    assert not any(line.startswith("A: ") for line in figures(hand.window.app))


@check
def a_picture_that_is_kept_again_ends_the_one_before(hand: Hand) -> None:
    pair = keep_and_go_on(hand)
    hand.ctx.item_click("//Controls/keep this picture")
    hand.ctx.yield_(2)
    assert pair.slot is None
    kept = hand.window.app.show.kept
    assert kept
    assert kept.state.settings.bounces == 1
    forget(hand)


@check
def without_room_for_a_b_goes_on_alone(hand: Hand) -> None:
    pair, session = keep_and_go_on(hand), hand.session

    def refused(*_: object) -> None:
        raise RenderError("no room for a second film")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Slot, "advance", refused)
        patch.setattr(Slot, "has_turn", lambda *_: True)
        hand.until(lambda: pair.slot is None)
    assert session.problem == "no room for a second film"
    session.problem = ""
    before = session.samples
    hand.until(lambda: session.samples > before)
    forget(hand)


def forget(hand: Hand) -> None:
    hand.ctx.item_click("//Controls/forget it")
    hand.ctx.yield_(3)
    assert hand.window.app.pair.slot is None
    assert not hand.session.problem
