"""A kept picture, and the one that came of it: the wipe, and the difference."""

from typing import Any

import numpy as np
import pytest

from glrt.view.viewport.picture import Picture
from tests.window.gestures import ball, move
from tests.window.hand import Hand, check


@check
def a_kept_picture_is_compared_by_a_wipe(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    ctx.set_ref("Controls")
    hand.session.paused = True
    ctx.yield_(2)
    before = hand.pixels()
    ctx.item_click("keep this picture")
    ctx.yield_(2)
    ctx.item_input_value("exposure", 3.0)
    ctx.item_input_value("wipe", 0.25)
    hand.settle()
    assert app.show.wipe == 0.25
    assert (hand.pixels() != before).any()
    assert (hand.there(lambda: read_kept(app.picture)) == before).all()
    ctx.item_click("forget it")
    ctx.yield_(2)
    assert app.picture.kept_name == 0


def read_kept(picture: Picture) -> Any:
    assert picture._kept
    width, height = picture._kept.size
    return np.frombuffer(picture._kept.read(), np.uint8).reshape(height, width, 4)[::-1].copy()


@check
def the_wipe_shows_one_picture_on_each_side_of_a_line_that_is_dragged(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    hand.session.paused = True
    ctx.item_click("//Controls/keep this picture")
    hand.there(lambda: hand.session.edit(exposure=-20.0))  # black
    left, top, width, height = app.rectangle
    ctx.mouse_move_to_pos((left + 0.5 * width, top + 0.5 * height))
    ctx.mouse_down(0)
    ctx.mouse_move_to_pos((left + 0.5 * width - 40, top + 0.5 * height))
    ctx.mouse_up(0)
    ctx.mouse_move_to_pos((left + 0.9 * width, top - 10))
    ctx.yield_(2)
    assert app.show.wipe == pytest.approx(0.5 - 40 / width, abs=4 / width)
    row = hand.screen()[int(top + 0.75 * height), int(left) : int(left + width)].astype(int)
    edge = round(app.show.wipe * width)
    near = row[edge - 4 : edge + 5].min(axis=1)
    assert near.max() > 200, "a white line"
    assert near.min() < 60, "with a dark rim"
    assert row[20 : edge - 20].mean() > 60 > 5 > row[edge + 20 : -20].mean()
    ctx.item_click("//Controls/forget it")
    ctx.yield_(2)
    row = hand.screen()[int(top + 0.75 * height), int(left) : int(left + width)]
    assert row[20:-20].max() < 5


@check
def the_difference_is_white_where_nothing_changed(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    ctx.set_ref("Controls")
    hand.there(lambda: hand.session.edit(samples=6))
    hand.until(lambda: hand.session.is_done)
    ctx.item_click("keep this picture")
    ctx.item_click("show the difference")
    hand.until(lambda: app.show.drawn == "difference")
    assert np.ptp(hand.pixels()[..., :3].reshape(-1, 3), axis=0).max() == 0, "nothing changed"
    assert app.show.difference.last
    assert app.show.difference.last[:2] == (0.0, 0.0)
    restarts = hand.session.restarts
    move(hand, "intensity##lamp", 3.0)
    hand.settle()
    assert hand.session.restarts == restarts
    assert abs(app.show.difference.last.brighter - 2) < 1e-5
    assert "B is 200 % brighter, in the mean, than A" in app.show.notice(hand.session)
    red = hand.pixels().astype(int)
    assert (red[..., 0] > red[..., 2]).mean() > 0.95, "all is lighter than it was"
    move(hand, "intensity##lamp", 1.0)
    number, shape = ball(hand)
    app.selected = number
    ctx.yield_(3)
    ctx.item_input_value(f"color##material {shape.material}/##X", 0.1)
    hand.settle()
    hand.until(lambda: hand.session.is_done and app.show.is_done(hand.session))
    ctx.yield_(2)
    assert app.show.drawn == "difference"
    mixed = hand.pixels()[..., :3].astype(int)
    white = (np.abs(mixed - 247) <= 1).all(axis=2)
    assert 0.02 < white.mean() < 0.9
    assert (mixed[..., 2] > mixed[..., 0] + 30).mean() > 0.05, "blue: darker than it was"
    ctx.item_input_value("strongest", 5.0)
    ctx.yield_(2)
    assert np.abs(hand.pixels()[..., :3].astype(int) - 247).mean() < np.abs(mixed - 247).mean()
    ctx.item_click("show the difference")
    ctx.item_click("forget it")
    hand.until(lambda: app.show.drawn == "picture")
    app.selected = None
