"""The picture that is rendered: what is shown meanwhile, how far it got, and when it ends."""

import re
from functools import partial
from typing import Any

from glrt.settings import Cost
from glrt.view.panels.plots import figures
from tests.window.gestures import move
from tests.window.hand import Hand, check


@check
def the_picture_never_goes_black(hand: Hand) -> None:
    usual = hand.pixels()[..., :3].mean()
    edits: list[dict[str, Any]] = [{"method": "nee"}, {"width": 64}, {"bounces": 5}, {"seed": 3}]
    for edit in edits:
        hand.there(partial(hand.session.edit, **edit))
        for _ in range(6):
            assert hand.pixels()[..., :3].mean() > 0.25 * usual, edit


@check
def a_compilation_is_announced_while_the_old_picture_stays(hand: Hand) -> None:
    hand.session.paused = True
    hand.ctx.yield_()
    before = hand.pixels()
    hand.there(lambda: hand.session.edit(method="naive"))
    hand.until(lambda: bool(hand.session.busy), frames=3)
    assert (hand.pixels() == before).all()
    hand.until(lambda: not hand.session.busy)
    assert hand.session.last_cost is Cost.RECOMPILE


@check
def pause_keeps_the_samples_and_restart_drops_them(hand: Hand) -> None:
    hand.ctx.item_click("//Picture/###pause")
    samples = hand.session.samples
    hand.ctx.yield_(5)
    assert hand.session.samples == samples > 0
    hand.ctx.item_click("//Controls/restart")
    hand.until(lambda: hand.session.samples == 1)
    hand.ctx.yield_(3)
    assert hand.session.samples == 1, "a paused picture shows its first sample"
    hand.ctx.item_click("//Picture/###pause")
    hand.until(lambda: hand.session.samples > 1)


@check
def samples_end_at_the_target(hand: Hand) -> None:
    hand.there(lambda: hand.session.edit(samples=7, seed=1))
    hand.until(lambda: hand.session.is_done)
    hand.ctx.yield_(3)
    assert hand.session.samples == 7
    hand.there(lambda: hand.session.edit(samples=9))
    hand.until(lambda: hand.session.samples == 9)


@check
def the_figures_report_error_and_forecast(hand: Hand) -> None:
    app = hand.window.app
    hand.until(lambda: len(app.progress.looks) > 2 and app.load.last is not None)
    told = "\n".join(figures(app))
    assert "million samples/s" in told
    assert "ms a frame" in told
    assert re.search(r"^[\d.]+ frames/s, \d+ % of \d+ processors?$", told, re.M), told
    assert re.search(r"error [\d.]+ % \([\d.]+ to [\d.]+\)", told), told
    assert " more" in told or "is reached" in told
    assert app.progress.looks[0].error > app.progress.looks[-1].error > 0


@check
def a_checkbox_switches_each_effect_of_hybrid(hand: Hand) -> None:
    """Shadows and indirect light: what is lost with them comes back with them."""
    session = hand.session
    hand.ctx.set_ref("Controls")
    move(hand, "method/hybrid", None)
    hand.until(lambda: not session.is_behind and session.samples >= 4)
    assert session.settings.method == "hybrid"
    whole = hand.pixels()[..., :3].mean()
    hand.there(lambda: session.edit(effects=("shadows",)))
    hand.until(lambda: not session.is_behind and session.samples >= 4)
    direct = hand.pixels()[..., :3].mean()
    assert direct < 0.9 * whole
    for effects, clicked in ((), "shadows"), (("shadows",), "shadows"), (("shadows", "gi"), "gi"):
        move(hand, clicked, None)
        hand.until(lambda: not session.is_behind and session.samples >= 4)
        assert session.settings.effects == effects
        assert session.last_cost is Cost.RECOMPILE
        assert not session.problem
    assert hand.pixels()[..., :3].mean() > direct
