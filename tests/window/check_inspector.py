"""Tools that look at pixels: zoom, values under the mouse, histogram."""

from functools import partial

import numpy as np
from imgui_bundle import imgui

from glrt.image.tonemap import expose_and_encode
from glrt.view.panels.inspector import pixel_text
from tests.window.check_layout import resized
from tests.window.check_newcomer import SMALLEST
from tests.window.gestures import press
from tests.window.hand import SMALL, Hand, check

WIDTH, HEIGHT = SMALL["width"], SMALL["height"]


@check
def the_values_of_a_pixel_are_those_of_the_saved_picture(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    hand.until(lambda: session.samples >= session.known_from)
    session.paused = True
    hand.ctx.yield_(2)
    image, codes = hand.there(session.image), hand.pixels()
    for x, y in ((0, 0), (13, 5), (20, 31), (WIDTH - 1, HEIGHT - 1)):
        told = hand.there(partial(pixel_text, app, (x + 0.5) / WIDTH, (y + 0.5) / HEIGHT))
        assert told[0].startswith(f"pixel {x}, {y}")
        assert told[0].endswith(f": {image.samples} samples")
        assert told[1] == "radiance " + "  ".join(f"{v:.4g}" for v in image.radiance[y, x])
        assert told[2] == "standard error " + "  ".join(f"{v:.4g}" for v in image.stderr[y, x])
        shown = expose_and_encode(image.radiance[y, x], 0.0, session.settings.tonemap)
        assert told[3] == "on the screen " + " ".join(f"{c:3d}" for c in shown)
        assert np.abs(codes[y, x, :3].astype(int) - shown).max() <= 1
    assert hand.there(lambda: pixel_text(app, 1.0, 0.5)) == []
    assert "left wall" in hand.there(partial(pixel_text, app, 0.02, 0.5))[0]


@check
def a_relit_picture_reports_the_values_that_are_shown(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    hand.until(lambda: session.samples >= session.known_from)
    hand.ctx.item_open("//Controls/Lamps")
    hand.ctx.item_input_value("//Controls/intensity##lamp", 3.0)
    session.paused = True
    hand.ctx.yield_(3)
    image = hand.there(session.image)
    told = hand.there(lambda: pixel_text(app, 0.5, 0.5))
    row = image.radiance[HEIGHT // 2, WIDTH // 2]
    assert told[1] == "radiance " + "  ".join(f"{v:.4g}" for v in row)


@check
def keys_zoom_to_pixels_and_back(hand: Hand) -> None:
    app = hand.window.app
    fitted = app.rectangle
    press(hand, imgui.Key._1)
    assert app.rectangle[2:] == (WIDTH, HEIGHT)
    press(hand, imgui.Key._0)
    assert app.rectangle == fitted


@check
def the_wheel_zooms_about_the_mouse_and_moves_no_camera(hand: Hand) -> None:
    app, ctx, camera = hand.window.app, hand.ctx, hand.session.scene.camera
    ctx.mouse_move("//Picture/picture")
    x, y = imgui.get_io().mouse_pos
    left, top, width, height = app.rectangle
    before = (x - left) / width, (y - top) / height
    ctx.key_down(imgui.Key.mod_ctrl.value)
    ctx.mouse_wheel_y(4)
    ctx.yield_(2)
    left, top, width, height = app.rectangle
    assert width > 1.9 * WIDTH
    assert np.allclose(((x - left) / width, (y - top) / height), before, atol=0.01)
    ctx.mouse_down(0)
    ctx.mouse_move_to_pos((x + 30, y + 10))
    ctx.mouse_up(0)
    ctx.key_up(imgui.Key.mod_ctrl.value)
    ctx.yield_(2)
    assert np.allclose((app.rectangle[0] - left, app.rectangle[1] - top), (30, 10), atol=1)
    assert hand.session.scene.camera == camera
    press(hand, imgui.Key._0)


@check
def a_zoomed_pixel_is_one_square_of_one_colour(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    hand.until(lambda: session.samples >= session.known_from)
    session.paused = True
    hand.there(lambda: app.zoom_to(16.0))
    hand.ctx.yield_(2)
    left, top, _, _ = app.rectangle
    codes, screen = hand.pixels(), hand.screen()
    x, y = 20, 20
    corner = round(top) + 16 * y, round(left) + 16 * x
    square = screen[corner[0] + 1 : corner[0] + 15, corner[1] + 1 : corner[1] + 15]
    assert np.abs(square.astype(int) - codes[y, x, :3]).max() <= 1
    press(hand, imgui.Key._0)


@check
def the_panel_inspects(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    hand.until(lambda: hand.session.samples >= hand.session.known_from)
    ctx.set_ref("Controls")
    ctx.item_open("Pixels")
    ctx.item_click("4:1")
    assert app.zoom.scale == 4.0
    ctx.item_click("fit")
    ctx.item_click("pixel values")
    assert app.inspects
    hand.until(lambda: app.progress.last is not None)
    assert app.progress.last
    assert 0.9 < app.progress.last.histogram.shares.sum() <= 1
    ctx.mouse_move("//Picture/picture")
    ctx.yield_(2)
    press(hand, imgui.Key.i)
    assert not app.inspects
    ctx.item_close("Pixels")


@check
def what_lies_below_the_histogram_stays_while_there_is_none(hand: Hand) -> None:
    """A click there would meet another row where the first look at a picture came between."""
    app, ctx = hand.window.app, hand.ctx
    ctx.item_open("//Controls/Pixels")
    hand.until(lambda: app.progress.last is not None)
    ctx.yield_(2)
    below = ctx.item_info("//Controls/Paths of a pixel").rect_full.min.y
    hand.there(app.restart)
    ctx.yield_(2)
    assert app.progress.last is None
    assert ctx.item_info("//Controls/Paths of a pixel").rect_full.min.y == below
    ctx.item_close("//Controls/Pixels")


@check
def rows_below_the_histogram_stay_while_it_is_scrolled_out(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    usual = tuple(map(int, hand.there(lambda: tuple(imgui.get_io().display_size))))
    resized(hand, SMALLEST)
    ctx.item_open("//Controls/Pixels")
    hand.until(lambda: app.progress.last is not None)
    seen = set()
    for y in range(0, 1000, 200):
        hand.there(partial(scroll, float(y)))
        ctx.yield_(3)
        seen.add(hand.there(height_of_rows))
    ctx.item_close("//Controls/Pixels")
    resized(hand, (usual[0], usual[1]))
    assert len(seen) == 1, seen


def scroll(y: float) -> None:
    imgui.internal.set_scroll_y(imgui.internal.find_window_by_name("Controls"), y)


def height_of_rows() -> float:
    return float(imgui.internal.find_window_by_name("Controls").content_size.y)
