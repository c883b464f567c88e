"""Controls of the panel: what an edit costs, and what comes of it."""

from typing import Any

import pytest
from imgui_bundle import imgui

from glrt.settings import Cost, Settings
from glrt.view.controls import Control
from glrt.view.panels import background, lights, sun
from glrt.view.state import costs
from glrt.view.tabs import camera, kept, paths
from glrt.view.tabs.sections import TABS
from glrt.view.widgets import fields
from tests.window.check_preferences import CHOICES
from tests.window.gestures import click_twice, move, to_label
from tests.window.hand import Hand, check

# Each control by its label in the panel: the control, and what to do to it.
MOVES: dict[str, tuple[Control, Any]] = {
    "intensity##lamp": (costs.INTENSITY, 3.0),
    "emission##lamp/##emission/$$0": (lights.EMISSION.costing(Cost.RELIGHT), 2.0),
    "bounces": (kept.SETTINGS["bounces"], 1),
    "bounces live": (paths.LIVE, None),
    "method/nee": (kept.SETTINGS["method"], None),
    "sampler/independent": (kept.SETTINGS["sampler"], None),
    "seed": (kept.SETTINGS["seed"], 7),
    "caustics/on": (kept.SETTINGS["caustics"], None),
    "roulette": (kept.SETTINGS["roulette"], None),
    "samples": (kept.SETTINGS["samples"], 5000),
    "exposure": (kept.SETTINGS["exposure"], 2.0),
    "tonemap/agx": (kept.SETTINGS["tonemap"], None),
    "fov": (camera.CAMERA["fov"], 20.0),
    "focus distance": (camera.CAMERA["focus_distance"], 2.0),
    "defocus angle": (camera.CAMERA["defocus_angle"], 3.0),
    "position/$$2": (camera.CAMERA["position"], 3.0),
    "look at/$$0": (camera.CAMERA["look_at"], 0.3),
    "color##background/##color/$$2": (background.BACKGROUND["color"], 0.5),
    "gradient": (background.GRADIENT, None),
    "clear sky": (background.CLEAR, None),
    "sun": (sun.SHINES, None),
    "width": (kept.SETTINGS["width"], 30),
    "height": (kept.SETTINGS["height"], 30),
}
UNSEEN = (
    "samples",
    "focus distance",
    "bounces live",
    "gradient",
)  # no other picture is shown; of the second, without a lens


@check
def every_control_costs_what_it_says(hand: Hand) -> None:
    order = list(Cost)
    hand.ctx.set_ref("Controls")
    for reference, (control, value) in MOVES.items():
        hand.begin()
        session = hand.session
        before, samples = hand.pixels(), session.samples
        restarts, session.last_cost = session.restarts, None
        move(hand, reference, value)
        hand.settle()
        cost = session.last_cost or Cost.FREE
        assert order.index(cost) <= order.index(control.cost), (reference, cost)
        restarted = session.restarts - restarts
        assert bool(restarted) == (control.cost in (Cost.RESTART, Cost.RECOMPILE)), reference
        assert restarted <= 2, reference  # twice where a slow machine shows a preview first
        assert restarted or session.samples >= samples, reference
        assert not session.problem, (reference, session.problem)
        after = hand.pixels()
        if reference not in UNSEEN:
            changed = after.shape != before.shape or (after != before).mean() > 0.05
            assert changed, reference


@check
def every_control_of_the_panel_is_moved_here(hand: Hand) -> None:
    """A control that is added must therefore be added to the checks, too."""
    drawn: set[str] = set()
    inner = fields.edited

    def seen(control: Control, value: Any, name: str = "") -> Any:
        drawn.add(f"{control.label}##{name}" if name else control.label)
        return inner(control, value, name)

    drawing: list[Any] = [fields, paths, lights, background, sun]
    for module in drawing:
        module.edited = seen
    for tab in TABS:
        hand.turn_to(tab)
    for module in drawing:
        module.edited = inner
    moved = {reference.partition("/")[0] for reference in MOVES}
    moved |= {f"{label}##preference" for label in CHOICES}
    assert drawn == moved


@check
def a_hue_is_picked_without_a_change_of_brightness(hand: Hand) -> None:
    ctx, before = hand.ctx, lamp_of(hand)
    ctx.set_ref("Controls")
    ctx.item_click("emission##lamp/hue")
    ctx.yield_(2)
    ctx.set_ref("//$FOCUSED")
    ctx.item_input_value("##picker/##rgb/##Y", 0.25)
    hand.settle()
    after = lamp_of(hand)
    assert max(after) == pytest.approx(max(before), rel=1e-5)
    assert after[1] == pytest.approx(0.25 * max(before), rel=1e-3)
    assert after[2] == pytest.approx(before[2], rel=1e-3)
    ctx.popup_close_all()
    ctx.yield_(2)


def lamp_of(hand: Hand) -> Any:
    return hand.session.scene.materials["lamp"].emission  # type: ignore[union-attr]


@check
def buttons_and_boxes_of_the_scene_restart_it(hand: Hand) -> None:
    ctx, session, start = hand.ctx, hand.session, hand.session.scene
    ctx.set_ref("Controls")
    ctx.item_input_value("focus distance", 2.0)
    hand.settle()
    ctx.item_click("focus on look at")
    hand.settle()
    assert session.scene.camera.focus_distance is None
    ctx.item_open("Background")
    restarts = session.restarts
    ctx.item_click("gradient")
    hand.settle()
    assert session.scene.background.top is not None
    move(hand, "top##background/##top/$$2", 0.5)
    hand.settle()
    assert session.scene.background.top == (0.0, 0.0, 0.5)
    assert session.restarts > restarts
    move(hand, "bottom##background/##bottom/$$0", 0.25)
    ctx.item_click("gradient")
    hand.settle()
    assert session.scene.background.color == (0.0, 0.0, 0.5)
    ctx.item_close("Background")
    hand.there(lambda: hand.window.app.turn(0.1, 0.1, about_camera=False))
    ctx.item_click("home")
    hand.settle()
    assert session.scene.camera == start.camera


@check
def a_double_click_sets_the_default(hand: Hand) -> None:
    """On a slider, and on the label of a control; one step of undo brings the value back."""
    ctx = hand.ctx
    ctx.set_ref("Controls")
    for reference, name, value in (("bounces", "bounces", 3), ("exposure", "exposure", 1.5)):
        ctx.item_input_value(reference, value)
        hand.settle()
        assert getattr(hand.session.settings, name) == value
        ctx.mouse_move(reference)
        click_twice(hand)
        hand.settle()
        assert getattr(hand.session.settings, name) == Settings.model_fields[name].default
    ctx.key_press(imgui.Key.mod_ctrl.value | imgui.Key.z.value)
    hand.settle()
    assert hand.session.settings.exposure == 1.5
    move(hand, "method/naive", None)
    to_label(hand, "method")
    click_twice(hand)
    hand.settle()
    assert hand.session.settings.method == "mis"
