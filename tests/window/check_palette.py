"""Ctrl-K: words find controls and commands, Enter runs or shows them."""

from typing import Any

from imgui_bundle import imgui

from glrt.view.palette.box import NAME
from glrt.view.tabs.sections import SECTIONS
from glrt.view.widgets.finder import FINDER
from tests.window.gestures import ball, press
from tests.window.hand import Hand, check

CTRL = imgui.Key.mod_ctrl.value


def find(hand: Hand, words: str) -> list[str]:
    """Open the box and type words; the names that are found."""
    press(hand, imgui.Key.k, CTRL)
    assert hand.window.app.shows_palette
    if words:
        hand.ctx.key_chars(words)
    hand.ctx.yield_(3)
    return [entry.name for entry in hand.window._palette.found]


@check
def a_command_is_found_by_words_and_run(hand: Hand) -> None:
    app = hand.window.app
    assert find(hand, "show keys")[0] == "show these keys"
    assert hand.window._palette.found[0].shown == "F1"
    press(hand, imgui.Key.enter)
    assert (app.shows_palette, app.shows_keys) == (False, True)
    press(hand, imgui.Key.escape)
    assert not app.shows_keys


@check
def a_control_of_a_folded_part_is_shown_with_its_value(hand: Hand) -> None:
    """Also if the panels are hidden."""
    app, ctx = hand.window.app, hand.ctx
    ctx.item_close("//Controls/Frame")
    ctx.scroll_to_top("//Controls")
    press(hand, imgui.Key.n)
    assert app.is_picture_alone
    assert find(hand, "heig")[0] == "height"
    assert hand.window._palette.found[0].shown == "40"
    press(hand, imgui.Key.enter)
    assert not app.is_picture_alone
    ctx.yield_(6)
    panel: Any = ctx.window_info("//Controls").window
    row = ctx.item_info("//Controls/height").rect_full
    assert panel.pos.y < row.min.y < row.max.y < panel.pos.y + panel.size.y
    assert FINDER.is_marking
    ctx.item_close("//Controls/Frame")


@check
def all_parts_are_listed_and_none_of_them_changes(hand: Hand) -> None:
    app, before, (number, _) = hand.window.app, hand.session.state, ball(hand)
    app.select(number)
    find(hand, "")
    found = hand.window._palette.found
    places = {entry.place for entry in found}
    assert {"command", *(part.title for part in SECTIONS)} == places
    names = {entry.name for entry in found}
    assert {"add sphere", "open scene lamps", "keep this picture", "theme"} <= names
    assert f"radius of shape {number}" in names
    press(hand, imgui.Key.escape)
    assert not app.shows_palette
    assert hand.session.state == before
    app.select(None)


@check
def arrow_keys_choose_a_row_and_a_click_elsewhere_closes_the_box(hand: Hand) -> None:
    app, camera = hand.window.app, hand.session.scene.camera
    find(hand, "save")
    press(hand, imgui.Key.down_arrow)
    assert hand.window._palette.row == 1
    press(hand, imgui.Key.up_arrow)
    assert hand.window._palette.row == 0
    assert hand.session.scene.camera == camera
    box: Any = hand.ctx.window_info(f"//{NAME}").window
    picture: Any = hand.ctx.window_info("//Picture").window
    assert picture.pos.x < box.pos.x, "it covers no control"
    assert box.pos.x + box.size.x < picture.pos.x + picture.size.x
    hand.ctx.mouse_move_to_pos((box.pos.x + 5, box.pos.y + box.size.y + 30))
    hand.ctx.mouse_click(0)
    hand.ctx.yield_(2)
    assert not app.shows_palette
