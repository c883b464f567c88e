"""What a user does in the window, in the words of the checks."""

import math
from typing import Any

import numpy as np
from imgui_bundle import imgui

from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.view.state.controls import replaced
from glrt.view.viewport.orbit import axes
from tests.window.hand import SMALL, WAIT, Hand


def move(hand: Hand, reference: str, value: Any) -> None:
    """Do what a user does to a control."""
    hand.ctx.set_ref("Controls")
    if value is None and "/" in reference:
        hand.ctx.combo_click(reference)
    elif value is None:
        hand.ctx.item_click(reference)
    else:
        hand.ctx.item_input_value(reference, value)


def drag(hand: Hand, across: float, down: float, button: int = 0) -> None:
    """From the middle of the picture, by pixels; in several steps, as a mouse moves."""
    ctx = hand.ctx
    ctx.mouse_move("//Picture/picture")
    ctx.mouse_down(button)
    x, y = imgui.get_io().mouse_pos
    for share in (0.25, 0.5, 0.75, 1.0):
        ctx.mouse_move_to_pos((x + share * across, y + share * down))
    ctx.mouse_up(button)
    hand.settle()


def press(hand: Hand, key: imgui.Key, modifiers: int = 0) -> None:
    hand.ctx.key_press(key.value | modifiers)
    hand.ctx.yield_(3)


def click(hand: Hand, point: Any) -> None:
    hand.ctx.mouse_move_to_pos(place_of(hand, point))
    hand.ctx.yield_()
    hand.ctx.mouse_click(0)
    hand.ctx.yield_(2)


def double_click(hand: Hand, point: Any) -> None:
    """However long the frames of a busy machine take."""
    io = imgui.get_io()
    before = io.mouse_double_click_time, io.mouse_single_click_delay
    io.mouse_double_click_time, io.mouse_single_click_delay = WAIT, WAIT + 1
    hand.ctx.mouse_move_to_pos(place_of(hand, point))
    hand.ctx.yield_()
    hand.ctx.mouse_double_click(0)
    hand.ctx.yield_(2)
    io.mouse_double_click_time, io.mouse_single_click_delay = before


def place_of(hand: Hand, point: Any) -> tuple[float, float]:
    """Where a point of the scene is on the screen."""
    left, top, width, height = hand.window.app.rectangle
    camera = hand.session.scene.camera
    right, up, forward = (
        np.dot(axis, np.subtract(point, camera.position)) for axis in axes(camera)
    )
    scale = 1 / (forward * math.tan(math.radians(camera.fov) / 2))
    x, y = 0.5 + 0.5 * right * scale, 0.5 - 0.5 * up * scale  # the picture is square
    return left + x * width, top + y * height


def ball(hand: Hand) -> tuple[int, Any]:
    """The first ball of the scene, and its number."""
    objects = hand.session.scene.objects
    return next((n, shape) for n, shape in enumerate(objects) if shape.shape == "sphere")


def far_apart(a: Camera, b: Camera) -> float:
    return max(math.dist(a.position, b.position), math.dist(a.look_at, b.look_at))


def replaced_fov(hand: Hand, fov: float) -> Scene:
    scene = hand.session.scene
    return replaced(scene, camera=replaced(scene.camera, fov=fov))


def reopen(hand: Hand) -> None:
    """The scene that the window was opened with, small again."""

    def open_small() -> None:
        hand.window.app.files.open("cornell")
        hand.session.edit(**SMALL)
        hand.session.opened = hand.session.state

    hand.there(open_small)
