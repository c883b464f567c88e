"""How the parts of the window lie, and what stands in them is read."""

import ctypes
from typing import Any

import numpy as np
from imgui_bundle import hello_imgui, imgui
from numpy.typing import NDArray

import glfw  # isort: skip

from glrt.view.panels.layout import draw_on_ground
from glrt.view.window import PARTS
from tests.window.gestures import move, press
from tests.window.hand import Hand, check


def resized(hand: Hand, size: tuple[int, int]) -> None:
    hand.there(lambda: hello_imgui.change_window_size(size))
    hand.until(lambda: hand.there(lambda: tuple(imgui.get_io().display_size)) == size)
    hand.ctx.yield_(4)


def share_of(hand: Hand, name: str) -> tuple[float, float]:
    """The share of the window's width and height that a part of it has."""
    part = hand.there(lambda: imgui.internal.find_window_by_name(name).size)
    width, height = imgui.get_io().display_size
    return part.x / width, part.y / height


@check
def a_small_window_leaves_the_picture_most_of_its_room(hand: Hand) -> None:
    usual = tuple(map(int, hand.there(lambda: tuple(imgui.get_io().display_size))))
    before = share_of(hand, "Picture")
    resized(hand, (640, 400))
    across, down = share_of(hand, "Picture")
    move(hand, "exposure", 1.5)
    hand.until(lambda: hand.session.settings.exposure == 1.5)
    resized(hand, (usual[0], usual[1]))
    assert across * down > 0.5, (across, down)
    again = share_of(hand, "Picture")
    assert abs(again[0] - before[0]) < 0.02, "and back"
    assert abs(again[1] - before[1]) < 0.02, "and back"


@check
def tooltips_wrap(hand: Hand) -> None:
    """None is wider than a panel, however long its sentences are."""
    hand.ctx.set_ref("Controls")
    for reference in ("bounces live", "method", "view"):
        hand.ctx.mouse_move(reference)
        hand.until(lambda: hand.there(lambda: tooltip_width() > 0))
        hand.ctx.yield_(3)
        assert hand.there(tooltip_width) < hello_imgui.em_size(32), reference
        panel = hand.ctx.window_info("//Controls").window
        tooltip: Any = imgui.internal.find_window_by_name("##Tooltip_00")
        assert tooltip.pos.x >= panel.pos.x + panel.size.x, "next to the panel"
        hand.ctx.mouse_move("exposure")


def tooltip_width() -> float:
    """The width of the tooltip that is shown, 0 if there is none."""
    window = imgui.internal.find_window_by_name("##Tooltip_00")
    return window.size.x if window and window.active else 0.0


def layout(hand: Hand) -> dict[str, tuple[float, ...]]:
    """Corner, size and scroll of each part, and the size of the window, in pixels."""

    def found() -> dict[str, tuple[float, ...]]:
        parts = {name: imgui.internal.find_window_by_name(name) for name in PARTS}
        places = {n: (*it.pos, *it.size, it.scroll.y) for n, it in parts.items() if it}
        return {**places, "window": tuple(imgui.get_io().display_size)}

    return hand.there(found)


@check
def the_screen_is_filled_and_nothing_is_lost_on_the_way_back(hand: Hand) -> None:
    native, app = hand.window._native, hand.window.app
    hand.turn_to("Window")
    panel: Any = hand.ctx.window_info("//Controls").window
    hand.there(lambda: imgui.internal.set_scroll_y(panel, 100.0))
    app.selected = 1
    hand.ctx.yield_(6)
    before, camera = layout(hand), hand.session.scene.camera
    assert before["Controls"][4] > 0, "it is scrolled"
    restarts = hand.session.restarts
    press(hand, imgui.Key.f11)
    monitor = hand.there(lambda: tuple(glfw.get_video_mode(glfw.get_primary_monitor()).size))
    hand.until(lambda: layout(hand)["window"] == monitor)
    assert native.is_full_screen
    press(hand, imgui.Key.n)
    hand.until(lambda: layout(hand)["Picture"][2:4] == monitor, frames=20)
    press(hand, imgui.Key.n)
    press(hand, imgui.Key.f11)
    hand.until(lambda: layout(hand)["window"] == before["window"])
    hand.ctx.yield_(6)
    assert not native.is_full_screen
    assert layout(hand) == before
    assert (app.selected, hand.session.scene.camera) == (1, camera)
    assert hand.session.restarts == restarts
    app.selected = None


def held(buffer: Any, fields: int, kind: Any) -> NDArray[Any]:
    """Rows of a buffer of the frame that was drawn."""
    count = buffer.size() * fields
    size = count * np.dtype(kind).itemsize
    content = (ctypes.c_char * size).from_address(buffer.data_address()) if size else b""
    return np.frombuffer(content, kind).reshape(-1, fields)


def painted() -> float:
    """Pixels that the last frame painted, over those of the window: each layer counts."""
    data, pixels = imgui.get_draw_data(), 0.0
    for part in data.cmd_lists:
        vertices, numbers = part.vtx_buffer, part.idx_buffer
        kind = {2: np.uint16, 4: np.uint32}[imgui.INDEX_SIZE]
        places = held(vertices, 5, np.float32)[:, :2]  # of x, y, u, v, colour
        index = held(numbers, 1, kind)[:, 0].astype(int)
        for command in part.cmd_buffer:
            first = command.idx_offset
            found = places[index[first : first + command.elem_count] + command.vtx_offset]
            left, top, right, bottom = command.clip_rect
            corners = found.clip((left, top), (right, bottom)).reshape(-1, 3, 2)
            (ux, uy), (vx, vy) = ((corners[:, end] - corners[:, 0]).T for end in (1, 2))
            pixels += float(np.abs(ux * vy - uy * vx).sum()) / 2
    return pixels / (data.display_size.x * data.display_size.y)


@check
def the_ground_of_the_window_is_painted_by_no_part(hand: Hand) -> None:
    """Each layer that is blended over all pixels takes 50 ms of a frame at 3800 x 2100 pixels."""
    hand.settle()
    assert 0.2 < hand.there(painted) < 1.2


@check
def a_part_that_lies_over_others_has_a_ground(hand: Hand) -> None:
    corners = list[int]()
    plain = imgui.WindowFlags_.no_background | imgui.WindowFlags_.no_decoration

    def lying() -> None:
        imgui.set_next_window_size((100, 100))
        imgui.begin("lies over others", None, int(plain))
        draw_on_ground(lambda: None)
        corners.append(imgui.get_window_draw_list().vtx_buffer.size())
        imgui.end()

    ask = hand.window.params.callbacks.show_gui
    try:
        hand.window.params.callbacks.show_gui = lying
        hand.until(lambda: len(corners) > 3)
    finally:
        hand.window.params.callbacks.show_gui = ask
    assert corners[-1] == 4, "of a rectangle"
