"""The tour of a first start."""

from imgui_bundle import imgui

from glrt.view.panels.tour import STEPS
from glrt.view.state.controls import replaced
from tests.window.gestures import ball, click
from tests.window.hand import Hand, check


@check
def the_tour_has_five_steps_and_is_closed_for_ever(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    assert len(STEPS) == 5
    assert not shown(hand)
    hand.there(lambda: app.prefer(replaced(app.preferences, tour=True)))
    app.tour_step = 0
    ctx.yield_(3)
    for step in range(1, 5):
        ctx.item_click("//###tour/next")
        ctx.yield_(2)
        assert app.tour_step == step
    ctx.item_click("//###tour/back")
    ctx.yield_(2)
    assert app.tour_step == 3
    ctx.item_click("//###tour/close for ever")
    ctx.yield_(3)
    assert not app.preferences.tour
    assert not shown(hand)
    hand.until(lambda: '"tour": false' in app.preferences_file.read_text())


@check
def the_tour_keeps_nobody_from_the_picture(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    hand.there(lambda: app.prefer(replaced(app.preferences, tour=True)))
    app.tour_step = 1
    ctx.yield_(3)
    number, shape = ball(hand)
    click(hand, shape.center)
    assert app.selected == number
    ctx.window_close("//###tour")
    ctx.yield_(2)
    assert app.tour_step is None
    assert app.preferences.tour  # it comes again at the next start


def shown(hand: Hand) -> bool:
    """Whether the box of the tour is on the screen."""

    def is_active() -> bool:
        window = imgui.internal.find_window_by_name("###tour")
        return bool(window and window.was_active)

    return hand.there(is_active)
