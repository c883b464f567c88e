"""Light that is weighed: lamps and bounces that cost no sample."""

from typing import Any

import pytest

from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.settings import Cost
from glrt.view.controls import Control
from glrt.view.panels import lights
from glrt.view.widgets import fields
from tests.window.gestures import move, reopen
from tests.window.hand import SMALL, Hand, check


@check
def the_driver_decides_on_the_pipeline(hand: Hand) -> None:
    """Without compute shaders there are no layers: another intensity restarts."""
    has_compute = hand.session.context.has_compute
    assert hand.session.pipeline == ("compute" if has_compute else "fragment")
    restarts = hand.session.restarts
    move(hand, "intensity##lamp", 2.0)
    hand.settle()
    assert hand.session.last_cost is (Cost.RELIGHT if has_compute else Cost.RESTART)
    assert hand.session.restarts == restarts + (not has_compute)


@check
def a_relit_picture_is_that_of_a_fresh_render(hand: Hand) -> None:
    hand.there(lambda: hand.session.edit(samples=8, seed=2))
    hand.until(lambda: hand.session.is_done)
    dim, restarts = hand.pixels(), hand.session.restarts
    move(hand, "intensity##lamp", 2.0)
    hand.until(lambda: hand.session.last_cost is Cost.RELIGHT, frames=3)
    hand.ctx.yield_()
    bright = hand.pixels()
    assert hand.session.restarts == restarts
    assert bright.mean() > 1.1 * dim.mean()

    def render() -> Any:
        session = hand.session
        fresh = Renderer(session.scene, session.settings, session.context)
        codes = fresh.render().display()
        fresh.release()
        return codes

    assert (hand.there(render) == bright[..., :3]).all()


@check
def particles_come_by_a_control_and_are_relit(hand: Hand) -> None:
    """Controls for how many there are appear too; a lamp is dimmed without a restart."""
    session = hand.session
    move(hand, "caustics/on", None)
    hand.until(lambda: session.settings.caustics == "on")
    assert hand.ctx.item_exists("aimed")
    hand.there(lambda: session.edit(samples=32, bounces=4))
    hand.until(lambda: session.is_done)
    restarts = session.restarts
    move(hand, "intensity##lamp", 2.0)
    hand.until(lambda: session.last_cost is Cost.RELIGHT, frames=3)
    hand.ctx.yield_()
    shown = hand.pixels()
    assert session.restarts == restarts

    def render() -> Any:
        fresh = Renderer(session.scene, session.settings, session.context)
        codes = fresh.render().display()
        fresh.release()
        return codes

    assert (hand.there(render) == shown[..., :3]).all()


@check
def bounces_are_tuned_live_and_shown_alone(hand: Hand) -> None:
    ctx = hand.ctx
    hand.there(lambda: hand.session.edit(bounces=5))
    ctx.set_ref("Controls")
    ctx.item_click("bounces live")
    hand.settle()
    restarts, samples, whole = hand.session.restarts, hand.session.samples, hand.pixels()
    ctx.item_input_value("bounces", 0)
    hand.settle()
    assert hand.session.restarts == restarts
    assert hand.session.samples > samples
    black = hand.pixels()[..., :3]
    assert (black.max(axis=2) > 0).mean() < 0.2 < (whole[..., :3].max(axis=2) > 0).mean(), "lamps"
    ctx.item_input_value("bounces", 5)
    hand.settle()
    ctx.combo_click("shown/bounce 2 alone")
    hand.settle()
    alone = hand.pixels()[..., :3]
    assert 0.05 * whole.mean() < alone.mean() < 0.9 * whole.mean()
    ctx.combo_click("shown/all light")
    ctx.item_click("bounces live")
    hand.settle()
    assert hand.session.restarts == restarts + 1


@check
def a_row_of_the_panel_reports_its_lamp(hand: Hand) -> None:
    labels: list[str] = []
    inner = fields.edited

    def seen(control: Control, value: Any, name: str = "") -> Any:
        labels.append(control.label)
        return inner(control, value, name)

    hand.there(lambda: hand.session.edit(load("lamps"), **SMALL))
    hand.settle()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lights, "edited", seen)
        hand.turn_to("Light")
    lamps = hand.there(lambda: [label for label in labels if "intensity" in label])
    assert {"amber intensity", "blue intensity", "rose intensity"} <= set(lamps)
    assert "emission" not in labels
    reopen(hand)
