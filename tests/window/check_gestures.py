"""Gestures on the label of a control: a drag changes its value, a double click sets it back."""

from collections.abc import Callable
from typing import Any

import pytest
from imgui_bundle import imgui

from glrt.scene.materials.light import Light
from glrt.scene.shapes.sphere import Sphere
from glrt.view.panels import viewport
from glrt.view.panels.viewport import is_dragging as dragging
from tests.window.gestures import ball, click_twice, press, to_label
from tests.window.hand import Hand, check

CTRL = imgui.Key.mod_ctrl.value


def scrub(hand: Hand, reference: str, pixels: float) -> None:
    """Drag the label of a control to the right, in steps as a mouse moves."""
    x, y = to_label(hand, reference)
    hand.ctx.mouse_down(0)
    for share in (0.25, 0.5, 0.75, 1.0):
        hand.ctx.mouse_move_to_pos((x + share * pixels, y))
    hand.ctx.yield_(2)
    hand.ctx.mouse_up(0)
    hand.settle()


def radius(hand: Hand, number: int) -> float:
    shape = hand.session.scene.objects[number]
    assert isinstance(shape, Sphere)
    return shape.radius


def emission(hand: Hand) -> tuple[float, ...]:
    lamp = hand.session.scene.materials["lamp"]
    assert isinstance(lamp, Light)
    return lamp.emission


@check
def a_drag_on_a_label_changes_a_value_in_one_step(hand: Hand) -> None:
    session, number = hand.session, ball(hand)[0]
    hand.window.app.selected = number
    hand.ctx.yield_(4)
    values: dict[str, tuple[Callable[[], float], float]] = {
        "fov": (lambda: session.scene.camera.fov, 60),
        "bounces": (lambda: session.settings.bounces, -60),
        "exposure": (lambda: session.settings.exposure, 60),
        f"radius##shape {number}": (lambda: radius(hand, number), 20),
    }
    for reference, (value, pixels) in values.items():
        before, steps = value(), session.history.steps
        scrub(hand, reference, pixels)
        assert (value() - before) * pixels > 0, reference
        assert session.history.steps == steps + 1, reference
        changed = value()
        hand.ctx.mouse_move_to_pos((500, 500))
        hand.ctx.yield_(2)
        assert value() == changed, "the mouse lets go"
        press(hand, imgui.Key.z, CTRL)
        assert value() == before, reference
    hand.window.app.selected = None


@check
def the_outline_fades_while_a_value_is_dragged_not_while_words_are_typed(hand: Hand) -> None:
    seen: list[bool] = []
    hand.window.app.selected = ball(hand)[0]

    def observed() -> bool:
        seen.append(dragging())
        return seen[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(viewport, "is_dragging", observed)
        press(hand, imgui.Key.f, CTRL)
        hand.ctx.yield_(6)
        assert imgui.get_io().want_text_input
        seen.clear()
        hand.ctx.yield_(3)
        assert seen
        assert not any(seen)
        press(hand, imgui.Key.escape)
        x, y = to_label(hand, "fov")
        seen.clear()
        hand.ctx.mouse_down(0)
        hand.ctx.mouse_move_to_pos((x + 30, y))
        hand.ctx.yield_(2)
        assert seen[-1], "of a label"
        hand.ctx.mouse_up(0)
        hand.ctx.yield_(2)
        assert not seen[-1]
    hand.window.app.selected = None


@check
def a_drag_on_the_label_of_a_colour_keeps_its_hue(hand: Hand) -> None:
    before = emission(hand)
    x, y = to_label(hand, "intensity##lamp")  # the row above: a colour is a group of items
    y += imgui.get_frame_height_with_spacing()
    hand.ctx.mouse_move_to_pos((x, y))
    hand.ctx.yield_(2)
    hand.ctx.mouse_down(0)
    hand.ctx.mouse_move_to_pos((x + 50, y))
    hand.ctx.mouse_move_to_pos((x + 100, y))
    hand.ctx.yield_(2)
    hand.ctx.mouse_up(0)
    hand.settle()
    assert emission(hand) == pytest.approx([2 * part for part in before], rel=0.05)


@check
def a_double_click_goes_back_to_the_value_of_the_scene(hand: Hand) -> None:
    session, opened = hand.session, hand.session.opened
    number, shape = ball(hand)
    hand.window.app.selected = number
    hand.ctx.yield_(4)
    values: dict[str, tuple[Callable[[], Any], Any, Any]] = {
        "fov": (lambda: session.scene.camera.fov, 20.0, opened.scene.camera.fov),
        f"radius##shape {number}": (
            lambda: radius(hand, number),
            0.2,
            shape.radius,
        ),
        "samples": (lambda: session.settings.samples, 5000, opened.settings.samples),
    }
    for reference, (value, other, start) in values.items():
        hand.ctx.item_input_value(f"//Controls/{reference}", other)
        hand.settle()
        assert value() == other, reference
        to_label(hand, reference)
        click_twice(hand)
        hand.settle()
        assert value() == start, reference
    hand.window.app.selected = None
