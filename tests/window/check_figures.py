"""Figures and marks belong to the picture next to them."""

import pytest
from imgui_bundle import imgui

from glrt.rendering.history.temporal import Way
from glrt.rendering.renderer import Renderer
from glrt.view.controls import replaced
from glrt.view.panels.plots import figures
from tests.window.gestures import replaced_fov, reported_lines
from tests.window.hand import Hand, check

ENOUGH = 32  # samples: two observations


@check
def figures_belong_to_the_picture_next_to_them(hand: Hand) -> None:
    """After a restart the window reports nothing of the picture before."""
    app, session = hand.window.app, hand.session
    hand.until(lambda: len(app.progress.looks) > 1)
    session.paused = True
    hand.ctx.yield_(2)
    assert "%" in figures(app)[2]
    hand.ctx.item_click("//Controls/restart")
    hand.until(lambda: session.samples == 1)
    hand.ctx.yield_()
    assert figures(app)[2] == f"error unknown, known from {ENOUGH} samples on"
    assert app.progress.drawn == []
    hand.there(lambda: session.edit(samples=9, seed=5))
    session.paused = False
    hand.until(lambda: session.samples == 9 and session.is_done)
    hand.ctx.yield_()
    more = f"raise samples to {ENOUGH}"
    assert figures(app)[2] == f"error unknown, known from {ENOUGH} samples on: {more}"
    hand.there(lambda: session.edit(samples=7))
    hand.ctx.yield_(2)
    assert figures(app)[0] == "9 samples, 7 are wanted"


@check
def history_of_earlier_views_is_marked_in_the_picture(hand: Hand) -> None:
    """The window then reports no error."""
    app, session = hand.window.app, hand.session

    def move() -> None:
        app.preferences = replaced(app.preferences, temporal="reproject")
        session.moving.use(Way("reproject"))
        app.turn(0.01, 0.0, about_camera=False)

    hand.there(move)
    hand.settle()
    session.paused = True
    with reported_lines() as told:
        hand.ctx.yield_(2)
        assert any(text.startswith("with light of earlier views, until there are") for text in told)
    assert figures(app)[2] == "error unknown while history of earlier views is shown"


@check
def an_old_picture_and_a_pause_are_marked_in_the_picture(hand: Hand) -> None:
    session = hand.session
    hand.until(lambda: session.samples > 3)
    hand.ctx.yield_()
    with reported_lines() as told:
        hand.ctx.yield_(2)
        assert told == []
        session.paused = True
        hand.ctx.yield_(2)
        assert told[-1].startswith("paused")
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(Renderer, "advance", lambda *_: False)
            hand.there(lambda: session.edit(seed=8))
            hand.until(lambda: session.samples == 0)
            told.clear()
            hand.ctx.yield_(2)
            assert any(text.startswith("old picture") for text in told)
        hand.until(lambda: session.samples == 1)
        hand.ctx.yield_(2)
        told.clear()
        hand.ctx.yield_(2)
        assert not any(text.startswith("old picture") for text in told)
        hand.there(lambda: session.edit(method="naive"))
        hand.until(lambda: bool(session.busy), frames=3)
        assert any(text.startswith("old picture") for text in told)


@check
def cautions_of_the_scene_stand_in_the_panel(hand: Hand) -> None:
    told: list[str] = []
    inner = imgui.text_wrapped

    def seen(text: str) -> None:
        told.append(text)
        inner(text)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(imgui, "text_wrapped", seen)
        hand.ctx.yield_(2)
        assert not any("Caution" in text for text in told)
        hand.there(lambda: hand.session.edit(replaced_fov(hand, 1e-5)))
        hand.settle()
        told.clear()
        hand.ctx.yield_(2)
    assert any(text.startswith("Caution: camera.fov 1e-05") for text in told), told
