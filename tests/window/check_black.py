"""A picture in which nothing but black is seen says why."""

import math

from imgui_bundle import imgui

from glrt.view.edits.scene_edits import with_object
from glrt.view.viewport import orbit
from tests.window.gestures import ball, press, reported_lines
from tests.window.hand import Hand, check


def told(hand: Hand, words: str) -> bool:
    """Whether a line over the picture has these words, once there are samples enough."""
    hand.settle()
    hand.until(lambda: hand.session.samples >= 16)
    with reported_lines() as lines:
        hand.ctx.yield_(2)
    return any(words in line for line in lines)


@check
def a_walk_through_the_ceiling_is_reported_and_ended(hand: Hand) -> None:
    start = hand.session.scene.camera
    assert not told(hand, "Black")
    hand.ctx.mouse_move("//Picture/picture")
    hand.ctx.key_down(imgui.Key.e.value)
    hand.until(lambda: hand.session.scene.camera.position[1] > 4)
    hand.ctx.key_up(imgui.Key.e.value)
    assert told(hand, "may have gone through a wall. Home goes back to the first view")
    assert not hand.pixels()[..., :3].any()
    press(hand, imgui.Key.home)
    assert not told(hand, "Black")
    assert hand.session.scene.camera == start


@check
def a_walk_goes_past_the_pivot_at_its_speed(hand: Hand) -> None:
    app, start = hand.window.app, hand.session.scene.camera
    reach, forward = app.reach, orbit.axes(start)[2]
    hand.ctx.mouse_move("//Picture/picture")
    hand.ctx.key_down(imgui.Key.w.value)
    hand.until(lambda: math.dist(hand.session.scene.camera.position, start.position) > 1.1 * reach)
    hand.ctx.key_up(imgui.Key.w.value)
    assert abs(app.reach / reach - 1) < 1e-3
    assert orbit.axes(hand.session.scene.camera)[2] @ forward > 0.999


@check
def a_camera_in_an_object_is_reported_of_it(hand: Hand) -> None:
    number, shape = ball(hand)
    around = shape.model_copy(update={"center": hand.session.scene.camera.position})
    hand.there(lambda: hand.session.edit(with_object(hand.session.scene, number, around)))
    assert told(hand, f"the camera is inside {shape.name}")
    hand.there(hand.session.undo)
    assert not told(hand, "Black")


@check
def light_that_is_off_is_reported(hand: Hand) -> None:
    hand.ctx.set_ref("Controls")
    hand.ctx.item_input_value("intensity##lamp", 0.0)
    assert told(hand, "every light is off")
    hand.there(hand.session.undo)
    assert not told(hand, "Black")


@check
def a_picture_that_is_too_dim_for_the_screen_is_reported(hand: Hand) -> None:
    hand.there(lambda: hand.session.edit(exposure=-20.0))
    assert told(hand, "Black at this exposure")
    hand.there(lambda: hand.session.edit(exposure=0.0))
    assert not told(hand, "Black")
