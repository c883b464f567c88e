"""The start screen: scenes to open, in place of the picture."""

from functools import partial
from pathlib import Path

import numpy as np
from imgui_bundle import imgui

from glrt.scene.scenefile.catalog import scene_names
from glrt.view.state.recent import with_opened
from tests.window.check_toolbar import sized
from tests.window.gestures import press, reopen, reported_lines
from tests.window.hand import Hand, check


def inside(hand: Hand, part: str, item: str) -> str:
    """How the engine calls an item in a part of the screen."""
    hand.ctx.yield_(3)
    info = hand.ctx.window_info(f"//Picture/{part}")
    assert info.window
    name = info.window.name.replace("/", "\\/")
    return f"//{name}/{item}"


@check
def scenes_to_open_stand_in_place_of_the_picture_and_go(hand: Hand) -> None:
    app = hand.window.app
    press(hand, imgui.Key.f2)
    hand.until(lambda: app.shows_start)
    samples = hand.session.samples
    camera = hand.session.scene.camera
    hand.ctx.yield_(3)
    hand.ctx.key_hold(imgui.Key.w.value, 0.1)
    assert hand.session.scene.camera == camera, "nobody sees what keys would move"
    assert hand.session.samples == samples
    with reported_lines() as lines:
        hand.ctx.yield_(3)
        assert lines == []
        press(hand, imgui.Key.escape)
        hand.until(lambda: not app.shows_start)
        hand.until(lambda: hand.session.samples > samples)


@check
def a_click_on_a_picture_opens_its_scene(hand: Hand) -> None:
    app = hand.window.app
    for size in ((1240, 800), (640, 400)):
        with sized(hand, size):
            press(hand, imgui.Key.f2)
            hand.ctx.yield_(3)
            hand.ctx.item_click(inside(hand, "scenes", "lamps"))
            hand.until(lambda: app.files.source == "lamps")
            assert not app.shows_start
            reopen(hand)
            hand.settle()


@check
def each_scene_has_a_picture_of_its_own(hand: Hand) -> None:
    press(hand, imgui.Key.f2)
    names = scene_names()[:6]
    hand.ctx.scroll_to_item_y(inside(hand, "scenes", names[0]))
    hand.ctx.yield_(4)
    screen, parts = hand.screen(), []
    for name in names:
        place = hand.ctx.item_info(inside(hand, "scenes", name)).rect_full.get_center()
        x, y = int(place.x), int(place.y)
        parts.append(screen[y - 50 : y + 50, x - 70 : x + 70].astype(int))
    assert all(part.std() > 5 for part in parts)
    assert min(np.abs(a - b).mean() for n, a in enumerate(parts) for b in parts[:n]) > 5
    press(hand, imgui.Key.escape)


@check
def a_file_that_was_opened_lately_is_opened_again(hand: Hand) -> None:
    app, file = hand.window.app, Path.cwd() / "lately.toml"
    hand.there(partial(app.files.save_scene, str(file)))
    reopen(hand)
    hand.there(lambda: setattr(app.files, "recent", with_opened(app.files.recent, str(file))))
    press(hand, imgui.Key.f2)
    hand.ctx.yield_(3)
    hand.ctx.item_click(inside(hand, "files", "lately.toml##0"))
    hand.until(lambda: app.files.source == str(file))
    reopen(hand)
    hand.settle()
    file.unlink()
    press(hand, imgui.Key.f2)
    hand.ctx.yield_(3)
    hand.ctx.item_click(inside(hand, "files", "lately.toml##1"))
    hand.until(lambda: "lately.toml" in hand.session.problem)
    assert app.shows_start, "the problem stands there"
    press(hand, imgui.Key.escape)
