"""The gestures of a user in the window, in the words of the checks."""

import math
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from imgui_bundle import imgui

import glfw  # isort: skip

from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.view.app import App
from glrt.view.bars import framed
from glrt.view.bars.status import draw_status
from glrt.view.controls import replaced
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
    """Drag from the middle of the picture, by pixels; in several steps, as a mouse moves."""
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
    hand.ctx.mouse_move_to_pos(place_of(hand, point))
    hand.ctx.yield_()
    click_twice(hand)


def click_twice(hand: Hand) -> None:
    """A double click where the mouse is, however long the frames of a busy machine take."""
    io = imgui.get_io()
    before = io.mouse_double_click_time, io.mouse_single_click_delay
    io.mouse_double_click_time, io.mouse_single_click_delay = WAIT, WAIT + 1
    hand.ctx.mouse_double_click(0)
    hand.ctx.yield_(2)
    io.mouse_double_click_time, io.mouse_single_click_delay = before


def to_label(hand: Hand, reference: str) -> tuple[float, float]:
    """Move the mouse to the label of a control, which lies left of its widget; where it is."""
    hand.ctx.scroll_to_item_y(f"//Controls/{reference}")
    hand.ctx.yield_(3)
    rect = hand.ctx.item_info(f"//Controls/{reference}").rect_full
    edge = hand.there(lambda: imgui.internal.find_window_by_name("Controls").pos.x)
    place = edge + imgui.get_style().window_padding.x + 8, rect.get_center().y
    hand.ctx.mouse_move_to_pos(place)
    hand.ctx.yield_(2)
    return place


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


def add(hand: Hand, kind: str) -> None:
    """A new object, by its button and its menu."""
    hand.ctx.item_click("//Controls/add")
    hand.ctx.yield_(2)
    hand.ctx.item_click(f"//$FOCUSED/{kind}")
    hand.ctx.yield_(3)


def scroll_to(hand: Hand, item: str) -> None:
    """An item of a panel into view, once no rows come or go: the engine gives up on a panel that
    shrinks while it scrolls."""
    hand.settle()
    hand.ctx.scroll_to_item_y(item)
    hand.ctx.yield_(3)


def retype(hand: Hand, material: str, kind: str) -> None:
    """Another type of a material of the selected object."""
    hand.ctx.set_ref("Controls")
    hand.ctx.combo_click(f"type##material {material}/{kind}")
    hand.ctx.yield_(2)


def type_name(hand: Hand, box: str, name: str) -> None:
    """A name into a box of the panel."""
    hand.ctx.item_click(f"//Controls/{box}")
    hand.ctx.key_chars_replace_enter(name)
    hand.ctx.yield_(2)


def answer(hand: Hand, name: str) -> None:
    """Press a button of the box that asks."""
    hand.until(lambda: hand.window.app.messages.question is not None)
    hand.ctx.yield_(3)
    question = hand.window.app.messages.question
    assert question
    hand.ctx.item_click(f"//{question.title}##question/{name}")
    hand.ctx.yield_(3)


@contextmanager
def reported_lines() -> Iterator[list[str]]:
    """Lines of text that stand below the picture meanwhile."""
    lines: list[str] = []

    def written(app: App, messages: list[str]) -> None:
        lines.extend(messages)
        draw_status(app, messages)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(framed, "draw_status", written)
        yield lines


def drop(hand: Hand, path: Path) -> None:
    """Drop a file on the window, as GLFW does when the X server reports one."""

    def dropped() -> None:
        library: Any = glfw
        ((called, _),) = library._window_drop_callback_repository.values()
        called(None, 1, [os.fsencode(path)])

    hand.there(dropped)
    hand.ctx.yield_(2)
