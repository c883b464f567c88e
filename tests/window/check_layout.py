"""How the parts of the window lie, and what stands in them is read."""

from imgui_bundle import hello_imgui, imgui

import glfw  # isort: skip

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
    hand.ctx.item_open("//Controls/Inspect")
    hand.ctx.scroll_to_item_y("//Controls/Camera")
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
    hand.ctx.item_close("//Controls/Inspect")
    app.selected = None
