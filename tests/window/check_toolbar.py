"""The bars above and below the picture."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from imgui_bundle import imgui

from glrt.view.app import App
from glrt.view.bars import framed, toolbar
from glrt.view.bars.status import draw_status
from glrt.view.bars.toolbar import BUTTONS
from glrt.view.state.zoom import FIT
from tests.window.check_layout import resized
from tests.window.gestures import press
from tests.window.hand import Hand, check

NARROW, WIDE = (640, 400), (1240, 800)


@contextmanager
def sized(hand: Hand, size: tuple[int, int]) -> Iterator[None]:
    """A window of this size for a while."""
    usual: Any = tuple(map(int, hand.there(lambda: tuple(imgui.get_io().display_size))))
    resized(hand, size)
    try:
        yield
    finally:
        resized(hand, usual)


@check
def the_bar_above_the_picture_edits_what_the_panel_shows(hand: Hand) -> None:
    app, session, ctx = hand.window.app, hand.session, hand.ctx
    ctx.set_ref("Picture")
    with sized(hand, WIDE):
        ctx.combo_click("##method/nee")
        hand.settle()
        assert session.settings.method == "nee"
        ctx.item_input_value("##exposure", 1.5)
        hand.settle()
        assert session.settings.exposure == 1.5
        ctx.combo_click("##view/error")
        hand.until(lambda: app.show.drawn == "error")
    hand.there(app.undo)
    assert (session.settings.exposure, session.settings.method) == (0.0, "nee")


@check
def its_buttons_do_what_their_keys_do(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    hand.there(lambda: app.zoom_to(2.0))
    ctx.item_click("//Picture/fit")
    ctx.yield_(2)
    assert app.zoom == FIT
    ctx.item_click("//Picture/keys")
    ctx.yield_(2)
    assert app.shows_keys
    press(hand, imgui.Key.escape)
    ctx.item_click("//Picture/find")
    ctx.yield_(2)
    assert app.shows_palette
    press(hand, imgui.Key.escape)


@check
def undo_redo_and_pause_stand_in_the_bar_and_say_why_they_do_nothing(hand: Hand) -> None:
    app, session, ctx = hand.window.app, hand.session, hand.ctx
    disabled = imgui.ItemFlags_.disabled.value

    def told(name: str) -> tuple[str, bool]:
        """The tooltip of a button, and whether it is grey."""
        tips: list[str] = []
        info = ctx.item_info(f"//Picture/###{name}")
        ctx.mouse_move_to_pos(info.rect_full.get_center())
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("glrt.view.bars.toolbar.explain", tips.append)
            hand.until(lambda: any(name in tip.lower() for tip in tips))
        tip = next(tip for tip in tips if name in tip.lower())
        return tip, bool(ctx.item_info(f"//Picture/###{name}").item_flags & disabled)

    with sized(hand, WIDE):
        hand.there(session.history.forget)
        assert told("undo") == (f"{toolbar._NO_UNDO} (Ctrl+Z)", True)
        assert told("redo")[1]
        samples = session.settings.samples
        hand.there(lambda: session.edit(samples=samples + 1))
        assert told("undo") == ("Undo: samples (Ctrl+Z)", False)
        ctx.item_click("//Picture/###undo")
        assert session.settings.samples == samples
        assert told("redo") == ("Redo: samples (Ctrl+Y or Ctrl+Shift+Z)", False)
        ctx.item_click("//Picture/###redo")
        assert session.settings.samples == samples + 1
        place = ctx.item_info("//Picture/###pause").rect_full
        ctx.item_click("//Picture/###pause")
        assert session.paused
        ctx.yield_(2)
        assert ctx.item_info("//Picture/###pause").rect_full.max.x == place.max.x, "nothing moves"
        ctx.item_click("//Picture/###pause")
        assert not session.paused
    assert app.session.undoes


@check
def a_narrow_bar_ends_before_a_widget_that_would_be_cut(hand: Hand) -> None:
    def there() -> set[str]:
        hand.ctx.yield_(3)
        names = (
            "###pause",
            *(it for it in BUTTONS if it != "pause"),
            "##view",
            "##method",
            "##exposure",
        )
        flags = int(imgui.test_engine.TestOpFlags_.no_error)
        return {it for it in names if hand.ctx.item_info(f"//Picture/{it}", flags).id_}

    with sized(hand, WIDE):
        assert len(there()) == len(BUTTONS) + 3
    with sized(hand, NARROW):
        shown = there()
        right = hand.there(lambda: imgui.internal.find_window_by_name("Picture").inner_rect.max.x)
        assert {"open", "save"} <= shown
        assert "##exposure" not in shown
        for name in shown:
            assert hand.ctx.item_info(f"//Picture/{name}").rect_full.max.x <= right, name


@check
def messages_stand_below_the_picture_whatever_its_size(hand: Hand) -> None:
    tops: list[float] = []

    def placed(app: App, lines: list[str]) -> None:
        tops.append(imgui.get_cursor_screen_pos().y)
        draw_status(app, lines)

    hand.session.paused = True
    for size in (NARROW, WIDE):
        with sized(hand, size):
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr(framed, "draw_status", placed)
                hand.ctx.yield_(3)
            _, top, _, height = hand.window.app.rectangle
            picture = hand.there(lambda: imgui.internal.find_window_by_name("Picture"))
            end = tops[-1] + imgui.get_text_line_height()
            assert top + height <= tops[-1], size
            assert end <= picture.inner_rect.max.y + 1, size
            assert not picture.scrollbar_y, size
