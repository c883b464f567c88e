"""The camera: moved by mouse, wheel and keys, and back by undo."""

import math

import numpy as np
from imgui_bundle import imgui

from glrt.view.viewport import orbit
from tests.window.gestures import drag, far_apart
from tests.window.hand import Hand, check


@check
def a_drag_turns_by_its_share_of_the_window(hand: Hand) -> None:
    before, (width, height) = hand.session.scene.camera, imgui.get_io().display_size
    drag(hand, 90, 40)
    yaw, pitch = -180 * 90 / width, -180 * 40 / height
    expected = orbit.orbited(before, before.look_at, yaw, pitch)
    assert far_apart(hand.session.scene.camera, expected) < 0.02
    assert math.dist(hand.session.scene.camera.look_at, before.look_at) < 1e-6


@check
def the_right_button_looks_around_and_the_middle_one_shifts(hand: Hand) -> None:
    before = hand.session.scene.camera
    drag(hand, 60, 0, button=1)
    looked = hand.session.scene.camera
    assert looked.position == before.position
    assert looked.look_at != before.look_at
    drag(hand, 60, 0, button=2)
    shifted = hand.session.scene.camera
    assert np.allclose(np.subtract(shifted.view, looked.view), 0, atol=1e-6)
    assert shifted.position != looked.position


@check
def a_drag_is_one_step_to_undo(hand: Hand) -> None:
    before = hand.session.scene.camera
    drag(hand, 50, 30)
    after = hand.session.scene.camera
    hand.ctx.item_click("//Picture/###undo")
    hand.settle()
    assert hand.session.scene.camera == before
    hand.ctx.item_click("//Picture/###redo")
    hand.settle()
    assert hand.session.scene.camera == after


@check
def wheel_and_keys_move_the_camera(hand: Hand) -> None:
    start = hand.session.scene.camera
    hand.ctx.mouse_move("//Picture/picture")
    hand.ctx.mouse_wheel_y(2)
    hand.settle()
    nearer = hand.session.scene.camera
    assert far_apart(nearer, orbit.dollied(start, start.look_at, 2)) < 1e-6
    for key, axis, sign in (
        *((imgui.Key.w, 2, 1), (imgui.Key.down_arrow, 2, -1), (imgui.Key.a, 0, -1)),
        *((imgui.Key.right_arrow, 0, 1), (imgui.Key.e, 1, 1), (imgui.Key.q, 1, -1)),
    ):
        before = hand.session.scene.camera
        hand.ctx.key_down(key.value)
        hand.ctx.yield_(3)
        hand.ctx.key_up(key.value)
        hand.settle()
        step = np.subtract(hand.session.scene.camera.position, before.position)
        along = np.array(orbit.axes(before)) @ step
        assert sign * along[axis] > 0.99 * np.linalg.norm(step) > 0, key
    hand.ctx.key_press(imgui.Key.home.value)
    hand.settle()
    assert hand.session.scene.camera == start


@check
def a_drag_may_begin_next_to_the_picture(hand: Hand) -> None:
    """A click there selects nothing."""
    app, ctx = hand.window.app, hand.ctx
    hand.session.edit(width=20, height=60)
    hand.settle()
    app.select(1)
    ctx.yield_(2)
    left, top, _, height = app.rectangle
    place = (left - 20, top + height / 2)
    start = hand.session.scene.camera
    ctx.mouse_move_to_pos(place)
    ctx.mouse_down(0)
    ctx.mouse_move_to_pos((place[0] + 60, place[1] + 20))
    ctx.mouse_up(0)
    hand.settle()
    assert hand.session.scene.camera != start
    assert app.selected == 1
    ctx.mouse_move_to_pos(place)
    ctx.mouse_click(0)
    ctx.yield_(2)
    assert app.selected is None
